// Light of the sky between records. Hemicubes know how much of it reaches a record, but not where
// between two records its shadows end. Directions of the sky with shadow maps know that of every
// pixel, but many are needed. So each later sample of a picture takes a few of them, drawn where
// the records see the sky, and finds what they bring to its pixels beyond what they would by way of
// the records: the mean of that over samples is what interpolation leaves out.
//                              [derived: control variates; Debevec05: parts of the sky]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <cmath>
#include <limits>

#include "methods/irradiance_cache/state.hpp"
#include "scene/environment.hpp"

namespace clgi {
namespace {

constexpr int most_map = 128;  // pixels a side: a direction is one of many
// Texels: light passes so far beneath walls that have no thickness, and brightens their corners.
// Texels past a receiver's edge count for nothing (DirectParams::edges), so that little is enough.
constexpr float bias = 0.06f;
constexpr int nearby = 1;  // texels by which what records see is spread, as they are few
// The directions of so many samples are taken in parts, each with a correction of its own: how far
// these agree is known before there are many samples.
constexpr std::uint32_t parted = 4, most_parts = 4;
// In scenes of so many triangles, where maps take longer than the rest of a sample and pixels have
// more to average, so many samples after `own` have the same directions.
constexpr std::uint32_t many_triangles = 10000, own = 16, together = 4;
constexpr float facing = 0.3f;   // as CACHE_FACING (kernels/cache/lookup.clh)
constexpr float beyond = 0.01f;  // of a picture's size, that its later samples may see past it
// Of the most that is seen of any direction, how much counts as seen of those that no record sees:
// between records more is seen, of about the same directions, and hardly of others.
constexpr double unseen = 0.002, hardly = 0.0002;
constexpr int about = 6;  // texels

}  // namespace

SkyPart soft_sky(const IrradianceCacheOptions& options) {
    const EmitterOptions& lights = options.picture.emitters;
    return lights.sky_part == SkyPart::bright ? SkyPart::soft : SkyPart::whole;
}

EmitterOptions sky_options(const IrradianceCacheOptions& options, std::uint32_t sample) {
    EmitterOptions out = options.picture.emitters;
    out.environment_alone = true;
    out.shadows = true;
    out.environment_lights = options.sky_lights;
    out.sky_part = soft_sky(options);
    out.environment_size = 0;
    out.shadow_size = std::min(out.shadow_size, most_map);
    out.vpls = 0;
    out.sample = sample;
    return out;
}

// Whether light of a direction reaches a pixel is yes or no, so the variance of a direction drawn
// with probability p is as how much of it is seen, over p: least where p is as the root.
std::shared_ptr<const SkyWeights> IrradianceCache::State::weigh_sky() {
    Recorder& record = picture.record();
    record.fill(sight, 0);
    const CacheParams of = params(0, found.seen);
    record("cache.sight", 5 * found.seen,
           [&](const WaitList& wait) { return passes.sight(record.queue(), of, b, sight, wait); });
    const int width = sky.width, height = sky.height;
    const auto at = [&](int row, int column) {
        return static_cast<std::size_t>(std::clamp(row, 0, height - 1)) *
                   static_cast<std::size_t>(width) +
               static_cast<std::size_t>((column % width + width) % width);
    };
    std::vector<std::uint32_t> seen(static_cast<std::size_t>(width) *
                                    static_cast<std::size_t>(height));
    const WaitList pending = record.waits();
    record.queue().enqueueReadBuffer(sight, CL_TRUE, 0, seen.size() * sizeof(std::uint32_t),
                                     seen.data(), &pending);
    const auto mean_nearby = [&](int row, int column) {
        double sum = 0.0, angle = 0.0;
        for (int down = -nearby; down <= nearby; ++down) {
            const int line = std::clamp(row + down, 0, height - 1);
            angle += (2 * nearby + 1) * texel_solid_angle(width, height, line);
            for (int across = -nearby; across <= nearby; ++across)
                sum += seen[at(line, column + across)];
        }
        return sum / angle;
    };
    const auto is_seen_about = [&](int row, int column) {
        for (int down = -about; down <= about; ++down)
            for (int across = -about; across <= about; ++across)
                if (seen[at(row + down, column + across)] > 0) return true;
        return false;
    };
    std::vector<double> shares, least;
    double most = 0.0;
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < width; ++column) {
            shares.push_back(mean_nearby(row, column));
            least.push_back(is_seen_about(row, column) ? unseen : hardly);
            most = std::max(most, shares.back());
        }
    if (!(most > 0.0)) return nullptr;
    auto out = std::make_shared<SkyWeights>();
    out->columns = width;
    out->rows = height;
    for (std::size_t i = 0; i < shares.size(); ++i)
        out->values.push_back(static_cast<float>(std::sqrt(shares[i] / most + least[i])));
    return out;
}

LocalBox IrradianceCache::State::lit_by_sky() {
    LocalBox out{glm::vec3(std::numeric_limits<float>::max()),
                 glm::vec3(-std::numeric_limits<float>::max())};
    const auto add = [&](const glm::vec3& place) {
        out.low = glm::min(out.low, place);
        out.high = glm::max(out.high, place);
    };
    std::vector<std::uint32_t> lists(planted.leaves.size() * CACHE_WAYS * CACHE_LISTED);
    const WaitList pending = picture.record().waits();
    picture.record().queue().enqueueReadBuffer(shown_buffers().lists, CL_TRUE, 0,
                                               lists.size() * sizeof(std::uint32_t), lists.data(),
                                               &pending);
    std::vector<bool> stands_in(records.size());
    for (const CacheRecord& pixel : shown) {
        if (!(glm::dot(pixel.normal, pixel.normal) > 0.0f)) continue;
        add(pixel.position);
        const std::uint32_t* list = &lists[list_of(planted, pixel)];
        for (int k = 0; k < CACHE_LISTED && list[k] != CACHE_NONE; ++k)
            if (glm::dot(records[list[k]].normal, pixel.normal) > facing) stands_in[list[k]] = true;
    }
    for (std::size_t i = 0; i < records.size(); ++i)
        if (stands_in[i]) add(records[i].position);
    const float around = beyond * glm::length(out.high - out.low);
    return {out.low - around, out.high + around};
}

void IrradianceCache::State::forget_corrections() {
    sky_weights.reset();
    weighed = false;
    gauged = {};
    of_pixels = of_records = {};
}

void IrradianceCache::State::light_by_sky(const Part& part, const cl::Buffer& planes,
                                          std::size_t points, std::uint32_t of_stride,
                                          const cl::Buffer& irradiance, std::uint32_t add) {
    Recorder& record = picture.record();
    const DirectParams direct{
        of_stride, static_cast<std::uint32_t>(points), part.count, bias, 1, add, part.first, 1};
    record("lights.direct", points, [&](const WaitList& wait) {
        return lights.direct(record.queue(), direct, sky_lights.buffers(), planes, irradiance,
                             picture.counter(), wait);
    });
}

void IrradianceCache::State::weigh_sky_once() {
    if (weighed) return;
    weighed = true;
    sky_weights = weigh_sky();
    picture.weigh_sky(sky_weights);
}

void IrradianceCache::State::aim_lights() {
    if (!aims()) return;
    if (!records.empty()) weigh_sky_once();
    picture.lights_changed();
    picture.draw_lights();
}

bool IrradianceCache::State::draw_sky() {
    Recorder& record = picture.record();
    weigh_sky_once();
    if (!sky_weights) return false;
    const bool first = gauged.total == 0.0f;
    if (first) {
        receivers = lit_by_sky();
        record.fill(corrections, 0);
        record.fill(settled_sums, 0);
    }
    const bool shared = scene.info().triangle_count > many_triangles && sample > own;
    const std::uint32_t set = shared ? own + (sample - own) / together : sample;
    gauged.again = shared && !first && set == sky_set ? 1 : 0;
    if (gauged.again) return true;
    sky_set = set;
    EmitterOptions wanted = sky_options(options, set);
    wanted.sky_weights = sky_weights;
    wanted.receivers = receivers;
    grown += sky_lights.follow(wanted, record, picture.passes());
    sky_lights.draw(record, picture.passes(), picture.lists());
    return true;
}

void IrradianceCache::State::correct(const Part& part) {
    Recorder& record = picture.record();
    const auto directions = static_cast<float>(part.count);
    of_pixels.add(directions, gauged.again != 0);
    const glm::vec3 &low = receivers.low, &high = receivers.high;
    gauged.width = static_cast<std::uint32_t>(options.picture.width);
    gauged.height = static_cast<std::uint32_t>(options.picture.height);
    gauged.stride = picture.stride();
    gauged.scale = static_cast<float>(sky_lights.set().emitters.size());
    gauged.total = of_pixels.total;
    gauged.squares = of_pixels.squares;
    gauged.low = {low.x, low.y, low.z, 0.0f};
    gauged.high = {high.x, high.y, high.z, 0.0f};
    if (!gauged.again) {  // else it is in b.next, and records have been settled by it
        record.fill(b.next, 0);
        light_by_sky(part, b.planes, records.size(), stride, b.next, DIRECT_TAKE);
        of_records.add(directions, false);
        settle();
    }
    show(true);
    light_by_sky(part, picture.gbuffer().planes, picture.pixels(), picture.stride(), found_light,
                 DIRECT_ADD);
    record("cache.gauge", picture.pixels(), [&](const WaitList& wait) {
        return passes.gauge(record.queue(), gauged, picture.gbuffer(), found_light, corrections,
                            shares, wait);
    });
}

bool IrradianceCache::State::settles() const {
    return gauged.total > 0.0f && scene.emissive().empty();
}

void IrradianceCache::State::settle() {
    if (!settles()) return;
    Recorder& record = picture.record();
    const CacheSettleParams of{static_cast<std::uint32_t>(records.size()),
                               stride,
                               gauged.scale,
                               of_records.total,
                               of_records.squares,
                               0,
                               0,
                               0};
    record("cache.settle", records.size(), [&](const WaitList& wait) {
        return passes.settle(record.queue(), of, b, settled_sums, settled, wait);
    });
}

void IrradianceCache::State::show_by_sky() {
    if (!corrects() || !draw_sky()) {
        show();
        return;
    }
    const auto directions = static_cast<std::uint32_t>(sky_lights.set().emitters.size());
    const std::uint32_t parts = sample < parted ? std::min(most_parts, directions) : 1;
    for (std::uint32_t part = 0; part < parts; ++part) {
        const std::uint32_t first = directions * part / parts;
        correct({first, directions * (part + 1) / parts - first});
    }
    Recorder& record = picture.record();
    record("cache.correct", picture.pixels(), [&](const WaitList& wait) {
        return passes.correct(record.queue(), gauged, corrections, shares, picture.irradiance(),
                              wait);
    });
}

}  // namespace clgi
