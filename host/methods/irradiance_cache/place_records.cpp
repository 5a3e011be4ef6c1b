// Where records lie: on what the picture shows, on what those see, and where their light changes.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>

#include "core/opencl/error_text.hpp"
#include "methods/irradiance_cache/state.hpp"

namespace clgi {
namespace {

constexpr int refinements = 2, weighings = 3;
constexpr std::uint32_t thin = 8;
constexpr int first_steps = 8;
constexpr float lift_share = 4e-6f;  // of the focus's radius
constexpr float off_edges = 1e-5f;   // of the way from a record to the eye

}  // namespace

std::vector<CacheRecord> IrradianceCache::State::read_records(const cl::Buffer& planes,
                                                              std::size_t plane_floats,
                                                              std::size_t count) {
    std::vector<float> values(RECORD_PLANES * plane_floats);
    const WaitList pending = picture.record().waits();
    picture.record().queue().enqueueReadBuffer(planes, CL_TRUE, 0, values.size() * sizeof(float),
                                               values.data(), &pending);
    std::vector<CacheRecord> out(count);
    for (std::size_t i = 0; i < count; ++i) {
        glm::vec3* parts[] = {&out[i].position, &out[i].normal, &out[i].geometric};
        for (int part = 0; part < 3; ++part)
            for (int c = 0; c < 3; ++c)
                (*parts[part])[c] =
                    values[static_cast<std::size_t>(3 * part + c) * plane_floats + i];
    }
    return out;
}

void IrradianceCache::State::write_records() {
    std::vector<float> values(RECORD_PLANES * std::size_t{stride}, 0.0f);
    for (std::size_t i = 0; i < records.size(); ++i) {
        const glm::vec3 parts[] = {records[i].position, records[i].normal, records[i].geometric};
        for (int part = 0; part < 3; ++part)
            for (int c = 0; c < 3; ++c)
                values[static_cast<std::size_t>(3 * part + c) * stride + i] = parts[part][c];
    }
    picture.record().write(b.planes, values.data(), values.size() * sizeof(float));
}

void IrradianceCache::State::draw(std::size_t first) {
    draw_cubes({b.planes, chosen, b.views, b.visibility, stride, static_cast<std::uint32_t>(drawn),
                first, records.size() - first});
}

void IrradianceCache::State::draw_cubes(const Hemicubes& of) {
    const auto from = static_cast<std::uint32_t>(of.first),
               points = static_cast<std::uint32_t>(of.count);
    const float lift = lift_share * scene.frame().detail;
    CubeParams params{};
    params.point_count = points;
    params.faces = 5;
    params.size = of.face;
    params.first_view = 5 * from;
    params.first_pixel = 3 * of.face * of.face * from;
    params.stride = of.stride;
    params.lift = lift;
    params.near = 0.5f * lift;
    params.first_chosen = from;
    params.turned = 1;
    Recorder& record = picture.record();
    record("gbuffer.cubes", points, [&](const WaitList& wait) {
        return cubes.cubes(record.queue(), params, of.planes, of.chosen, of.views, wait);
    });
    const ViewSpan span{5 * from, 5 * points, of.face, of.face,
                        std::size_t{3} * of.face * of.face * (of.first + of.count)};
    const bool trace = cubes.prefers_trace_views(span, scene);
    const auto drawing = trace ? &GBufferPasses::trace_views : &GBufferPasses::raster_views;
    record(trace ? "gbuffer.trace_views" : "gbuffer.raster_views", span.count,
           [&](const WaitList& wait) {
               return (cubes.*drawing)(record.queue(), span, of.views, scene, of.visibility,
                                       Pixels::visibility, wait);
           });
}

void IrradianceCache::State::meet(std::size_t first, std::size_t count) {
    const std::size_t viewers = records.size() - first;
    if (count == 0 || viewers == 0) return;
    Recorder& record = picture.record();
    record("cache.pick", viewers * picks_per_record, [&](const WaitList& wait) {
        return passes.pick(record.queue(), params(first, viewers), scene, b, places, wait);
    });
    const std::size_t picks = viewers * picks_per_record;
    const std::vector<CacheRecord> seen = read_records(places, pick_stride, picks);
    // One pick of each viewer after the other, so that none of them comes first.
    std::vector<CacheRecord> candidates;
    std::vector<std::size_t> by;
    for (std::size_t k = 0; k < picks_per_record; ++k)
        for (std::size_t v = 0; v < viewers; ++v) {
            candidates.push_back(seen[v * picks_per_record + k]);
            by.push_back(first + v);
        }
    const std::size_t before = records.size();
    add_records(records, candidates, by, count);
    if (records.size() == before) return;
    write_records();
    draw(before);
}

void IrradianceCache::State::weigh(std::size_t count) {
    if (count == 0) return;
    link(0, thin);
    light(options.bounces > 0 ? std::min(options.bounces, first_steps) : first_steps);
    Recorder& record = picture.record();
    CacheParams of = params(0, records.size());
    of.first_sample = static_cast<std::uint32_t>(records.size());  // others than were met
    const std::size_t picks = records.size() * picks_per_record;
    record("cache.pick", picks, [&](const WaitList& wait) {
        return passes.pick(record.queue(), of, scene, b, places, wait);
    });
    record("cache.weigh", picks, [&](const WaitList& wait) {
        return passes.weigh(record.queue(), of, tree, b, places, worth, nearest, wait);
    });
    WeighedPicks seen;
    seen.by_each = picks_per_record;
    seen.places = read_records(places, pick_stride, picks);
    seen.reflectance.resize(picks);
    seen.worth.resize(picks);
    seen.nearest.resize(picks);
    const auto read = [&](const cl::Buffer& from, std::size_t first, void* to) {
        record.queue().enqueueReadBuffer(from, CL_TRUE, first * sizeof(float),
                                         picks * sizeof(float), to);
    };
    read(places, PICK_REFLECTANCE * pick_stride, seen.reflectance.data());
    read(worth, 0, seen.worth.data());
    read(nearest, 0, seen.nearest.data());
    const std::size_t before = records.size();
    split_cells(records, found.seen, seen, count);
    if (records.size() == before) return;
    write_records();
    draw(before);
}

void IrradianceCache::State::choose(const View& view) {
    Recorder& record = picture.record();
    record.wait();
    shown = read_records(picture.gbuffer().planes, picture.stride(), picture.pixels());
    // Edges often run through the centres of pixels, and from the very edge of a ceiling half of
    // what is around is what lies behind the wall. Hemicubes of records are turned and seldom meet
    // one.
    const glm::vec3 eye(view.eye), forward(view.forward);
    for (CacheRecord& one : shown) {
        const glm::vec3 to = eye - one.position;
        one.position += off_edges * (view.eye.w == 0.0f ? to : glm::dot(to, forward) * forward);
    }
    records = seen_records(shown, static_cast<int>(view.width), static_cast<int>(view.height),
                           options.seen);
    const std::size_t most = capacity - static_cast<std::size_t>(options.met) -
                             static_cast<std::size_t>(options.refined);
    if (records.size() > most) records.resize(most);
    found.seen = records.size();
    found.met = found.refined = found.spots = 0;
    spots = {};
    has_tiles = false;
    if (!records.empty()) {
        write_records();
        draw(0);
    }
    aim_lights();
    if (records.empty()) return;
    const auto met = static_cast<std::size_t>(options.met);
    const std::size_t weighed = 2 * met / 3, spread = met - weighed;
    meet(0, spread - spread / 3);
    meet(found.seen, spread / 3);
    if (weighed / weighings > 0) find_spots(false);
    for (int round = 0; round < weighings; ++round) weigh(weighed / weighings);
    found.met = records.size() - found.seen;
}

void IrradianceCache::State::refine(const View& view) {
    if (options.refined == 0) return;
    const auto width = static_cast<int>(view.width), height = static_cast<int>(view.height);
    int side = block_side(width, height, options.seen);
    auto left = static_cast<std::size_t>(options.refined);
    for (int round = 0; round < refinements; ++round) {
        side = std::max(side / 2, 1);
        const std::vector<CacheRecord> more =
            doubtful_records(shown, read_doubt(), width, height, side,
                             left / static_cast<std::size_t>(refinements - round));
        if (more.empty()) return;
        const std::size_t first = records.size();
        records.insert(records.end(), more.begin(), more.end());
        left -= more.size();
        found.refined += more.size();
        write_records();
        draw(first);
        link(first);
        std::swap(b.light, b.next);
        bounce(first);
        plant(all_tree, all_nodes, all_lists);
        show();
    }
}

std::vector<float> IrradianceCache::State::read_planes(const cl::Buffer& from, std::size_t first,
                                                       std::size_t count) {
    std::vector<float> out(count);
    const WaitList pending = picture.record().waits();
    try {
        picture.record().queue().enqueueReadBuffer(from, CL_TRUE, first * sizeof(float),
                                                   count * sizeof(float), out.data(), &pending);
    } catch (const cl::Error& error) {
        throw DeviceError("irradiance-cache: planes cannot be read: " + error_text(error.err()));
    }
    return out;
}

std::vector<float> IrradianceCache::State::read_doubt() {
    const std::size_t row = picture.stride();
    std::vector<float> out = read_planes(doubt, 0, picture.pixels());
    keep_what_is_reflected(out, read_planes(picture.gbuffer().planes, GBUFFER_BASE * row, 3 * row),
                           row);
    return out;
}

double IrradianceCache::State::doubted() {
    if (records.empty()) return 0.0;
    const std::size_t row = picture.stride();
    return relative_doubt(read_doubt(), read_planes(picture.radiance(), 0, 3 * row), row,
                          scene.frame().exposure);
}

}  // namespace clgi
