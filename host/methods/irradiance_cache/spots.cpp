// Small lit places: where they are, and VPLs on them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/planes.hpp>
#include <cmath>

#include "methods/irradiance_cache/spot_tiles.hpp"
#include "methods/irradiance_cache/state.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr std::size_t most_views = 32;
constexpr std::uint32_t finest = 512;  // pixels, where there are several views
constexpr std::size_t finer_count = 96, finer_at_once = 32;
constexpr std::uint32_t finer_face = 128;  // pixels
constexpr int reflections = 5;

// Fewer views are finer.
std::uint32_t view_size(const EmitterOptions& emitters, std::size_t views) {
    const std::uint32_t side =
        std::clamp(static_cast<std::uint32_t>(emitters.shadow_size), 2u * SPOT_TILES, finest);
    const std::uint32_t size = views == 1    ? 4 * side
                               : views <= 4  ? 2 * side
                               : views <= 16 ? side
                                             : side / 2;
    return size / SPOT_TILES * SPOT_TILES;
}

// Views of lights that may light small places, of as many lights as there is room for: directional
// ones first, of which the view around the focus, then spots, then point lights.
std::vector<SpotView> spot_views(const std::vector<Emitter>& emitters, std::size_t count) {
    std::vector<SpotView> out;
    for (const std::uint32_t kind : {EMITTER_DIRECTIONAL, EMITTER_SPOT, EMITTER_POINT})
        for (std::size_t e = 0; e < count; ++e) {
            const Emitter& one = emitters[e];
            if ((one.kind & EMITTER_KIND) != kind) continue;
            const bool parallel = kind == EMITTER_DIRECTIONAL;
            const std::uint32_t views = parallel ? std::min(one.view_count, 1u) : one.view_count;
            if (out.size() + views > most_views) continue;
            for (std::uint32_t v = 0; v < views; ++v)
                out.push_back({static_cast<std::uint32_t>(e), one.first_view + v, 0, 0});
        }
    return out;
}

// Whether light that reaches a place over this distance is looked up at a record there.
bool has_record(const std::vector<CacheRecord>& records, const CacheRecord& place, float distance) {
    constexpr float near = 2.0f, alike = 0.5f;
    return std::any_of(records.begin(), records.end(), [&](const CacheRecord& one) {
        const glm::vec3 way = one.position - place.position;
        return glm::dot(way, way) < near * near * distance * distance &&
               glm::dot(one.normal, place.normal) > alike;
    });
}

}  // namespace

std::size_t most_vpls(const IrradianceCacheOptions& options) {
    return options.spots > 0 ? static_cast<std::size_t>(options.spots) + reflections * scattered
                             : 0;
}

std::size_t spot_pixels(const EmitterOptions& emitters) {
    std::size_t out = std::size_t{3} * finer_face * finer_face * finer_at_once;
    for (const std::size_t views : {std::size_t{1}, std::size_t{4}, std::size_t{16}, most_views}) {
        const std::size_t size = view_size(emitters, views);
        out = std::max(out, views * size * size);
    }
    return out;
}

bool IrradianceCache::State::casts_spots() const {
    return options.spots > 0 && !scene.lights().empty() &&
           !picture.emitters().capacity.together.empty();
}

void IrradianceCache::State::add_spots(BufferTable& table) {
    if (options.spots == 0) return;
    const char* lower = "spots or face";
    const std::size_t word = sizeof(std::uint32_t), tiles = most_views * spot_tiles;
    const auto first = static_cast<std::size_t>(options.spots);
    const std::size_t most = most_vpls(options);
    const std::size_t sides = 2 * std::size_t{scene.info().vertex_count};
    table.add(spot.seen, "what records see", lower, (sides + 31) / 32 * word);
    table.add(spot.some, "small lit places", lower, finer_at_once * word);
    table.add(spot.of, "small lit places", lower, most_views * sizeof(SpotView));
    table.add(spot.views, "small lit places", lower, most_views * sizeof(View));
    table.add(spot.visibility, "small lit places", "emitters.shadow_size",
              spot_pixels(options.picture.emitters) * sizeof(std::uint64_t));
    table.add(spot.count, "small lit places", lower, tiles * word);
    table.add(spot.area, "small lit places", lower, tiles * word);
    table.add(spot.samples, "small lit places", lower, first * sizeof(SpotSample));
    table.add(spot.spots, "small lit places", lower, most * sizeof(Vpl));
    const auto face = static_cast<std::size_t>(drawn);
    spot_stride = plane_stride(most);
    CacheBuffers& h = spot.hemicubes;
    table.add(h.planes, "VPLs", lower, RECORD_PLANES * word * spot_stride);
    table.add(h.views, "hemicubes of VPLs", lower, 5 * most * sizeof(View));
    table.add(h.visibility, "hemicubes of VPLs", lower,
              3 * face * face * most * sizeof(std::uint64_t));
}

void IrradianceCache::State::find_spots(bool finely) {
    spots = {};
    found.spots = 0;
    has_tiles = false;
    const EmitterSet& emitters = picture.emitters();
    std::vector<SpotView> of = spot_views(emitters.emitters, emitters.lamps);
    if (!casts_spots() || of.empty()) return;
    Recorder& record = picture.record();
    mark_sides(finely);
    std::vector<std::uint32_t> tiles(emitters.views.size() * spot_tiles, 1);
    grow(b.by_spots, tiles.size() * sizeof(std::uint32_t));
    spot.wanted = b.by_spots;
    std::vector<View> views;
    for (const SpotView& one : of) views.push_back(emitters.views[one.light_view]);
    SpotTally all = tally_spots(of, views, tiles);

    const auto texel_power = [&](const SpotView& one, const View& view) {
        return luminance(glm::dvec3(emitters.emitters[one.emitter].intensity)) * view.right.w *
               view.up.w;
    };
    const float side = 2.0f * scene.frame().detail / static_cast<float>(options.face);
    const std::uint32_t a_tile = spot_size / SPOT_TILES * (spot_size / SPOT_TILES);
    std::fill(tiles.begin(), tiles.end(), 0u);
    std::vector<SpotView> parts;
    std::vector<View> part_views;
    LitPower lit;
    for (std::size_t v = 0; v < of.size(); ++v) {
        std::uint32_t* chosen = tiles.data() + of[v].light_view * spot_tiles;
        std::uint32_t* count = all.count.data() + v * spot_tiles;
        choose_tiles(count, all.area.data() + v * spot_tiles, a_tile, side, chosen);
        lit.add(texel_power(of[v], views[v]), count, chosen);
        for (const View& part : zoomed(views[v], count, chosen)) {
            part_views.push_back(part);
            parts.push_back(of[v]);
        }
        leave_chosen(count, chosen);
    }
    has_tiles = true;
    const std::size_t places = parts.size();
    if (finely && places <= most_views) {
        of = std::move(parts);
        views = std::move(part_views);
        all = tally_spots(of, views, tiles);
    } else {
        write_tiles(tiles);
    }
    std::vector<double> power;
    for (std::size_t v = 0; v < of.size(); ++v) power.push_back(texel_power(of[v], views[v]));
    const std::vector<SpotSample> samples =
        spot_samples(power, all.count, lit.vpls(static_cast<std::size_t>(options.spots), places));
    if (samples.empty()) return;
    spots.sample_count = static_cast<std::uint32_t>(samples.size());
    record.write(spot.samples, samples.data(), samples.size() * sizeof(SpotSample));
    record("cache.spots", samples.size(), [&](const WaitList& wait) {
        return passes.spots(record.queue(), spots, spot_size, scene, picture.emitter_buffers(),
                            spot, wait);
    });
    scatter_spots(lit.vpls(scattered, places));
    found.spots = spots.sample_count;
}

// Of all records as they are, and of some more finely: what is small falls between pixels.
void IrradianceCache::State::mark_sides(bool finely) {
    Recorder& record = picture.record();
    record.fill(spot.seen, 0);
    const auto mark = [&](const CacheParams& of, const CacheBuffers& from) {
        record("cache.mark", std::size_t{5} * of.count, [&](const WaitList& wait) {
            return passes.mark(record.queue(), of, scene, from, spot, wait);
        });
    };
    mark(params(0, records.size()), b);
    if (!finely) return;
    const std::size_t count = std::min(records.size(), finer_count);
    std::vector<std::uint32_t> some(count);
    for (std::size_t k = 0; k < count; ++k)
        some[k] = static_cast<std::uint32_t>(k * records.size() / count);
    CacheBuffers from = b;
    from.views = spot.hemicubes.views;
    from.visibility = spot.visibility;
    for (std::size_t first = 0; first < count; first += finer_at_once) {
        const std::size_t now = std::min(finer_at_once, count - first);
        record.write(spot.some, some.data() + first, now * sizeof(std::uint32_t));
        draw_cubes({b.planes, spot.some, from.views, from.visibility, stride, finer_face, 0, now});
        CacheParams of = params(0, now);
        of.size = finer_face;
        mark(of, from);
    }
}

void IrradianceCache::State::write_tiles(const std::vector<std::uint32_t>& tiles) {
    picture.record().write(b.by_spots, tiles.data(), tiles.size() * sizeof(std::uint32_t));
}

// Draws the views; `tiles` say what counts.
IrradianceCache::State::SpotTally IrradianceCache::State::tally_spots(
    const std::vector<SpotView>& of, std::vector<View>& views,
    const std::vector<std::uint32_t>& tiles) {
    Recorder& record = picture.record();
    write_tiles(tiles);
    spots.view_count = static_cast<std::uint32_t>(of.size());
    SpotTally out;
    out.count.resize(of.size() * spot_tiles);
    out.area.resize(of.size() * spot_tiles);
    if (of.empty()) return out;
    spot_size = view_size(options.picture.emitters, of.size());
    for (std::size_t v = 0; v < views.size(); ++v) {
        views[v].width = views[v].height = spot_size;
        views[v].first_pixel = static_cast<std::uint32_t>(v) * spot_size * spot_size;
    }
    record.write(spot.of, of.data(), of.size() * sizeof(SpotView));
    record.write(spot.views, views.data(), views.size() * sizeof(View));
    RasterBuffers lists = picture.lists();
    lists.pixels = spot.visibility;
    lists.kind = Pixels::visibility;
    clgi::draw(record, picture.passes(), scene, span_of(views, 0, views.size()), spot.views, lists);
    record("cache.tally", of.size() * spot_tiles, [&](const WaitList& wait) {
        return passes.tally(record.queue(), spots, spot_size, scene, picture.emitter_buffers(),
                            spot, wait);
    });
    const WaitList pending = record.waits();
    record.queue().enqueueReadBuffer(spot.count, CL_TRUE, 0, out.count.size() * sizeof(float),
                                     out.count.data(), &pending);
    record.queue().enqueueReadBuffer(spot.area, CL_TRUE, 0, out.area.size() * sizeof(float),
                                     out.area.data());
    return out;
}

// Hemicubes of VPLs from `first` on.
void IrradianceCache::State::draw_hemicubes(const std::vector<Vpl>& vpls, std::size_t first) {
    if (vpls.size() == first) return;
    std::vector<float> planes(RECORD_PLANES * std::size_t{spot_stride}, 0.0f);
    for (std::size_t i = first; i < vpls.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
            const auto axis = static_cast<int>(c);
            planes[(RECORD_POSITION + c) * spot_stride + i] = vpls[i].position[axis];
            planes[(RECORD_NORMAL + c) * spot_stride + i] = vpls[i].normal[axis];
            planes[(RECORD_GEOMETRIC + c) * spot_stride + i] = vpls[i].normal[axis];
        }
    picture.record().write(spot.hemicubes.planes, planes.data(), planes.size() * sizeof(float));
    draw_cubes({spot.hemicubes.planes, chosen, spot.hemicubes.views, spot.hemicubes.visibility,
                spot_stride, static_cast<std::uint32_t>(drawn), first, vpls.size() - first});
}

// What VPLs light close by, where no record stands, as inside the wall around a hole, are further
// VPLs, `most` of each reflection. What they light elsewhere has records.
void IrradianceCache::State::scatter_spots(std::size_t most) {
    Recorder& record = picture.record();
    std::vector<Vpl> all(spots.sample_count);
    const WaitList pending = record.waits();
    record.queue().enqueueReadBuffer(spot.spots, CL_TRUE, 0, all.size() * sizeof(Vpl), all.data(),
                                     &pending);
    draw_hemicubes(all, 0);
    std::size_t first = 0;
    for (int reflection = 0; reflection < reflections && first < all.size(); ++reflection) {
        CacheParams of = params(first, all.size() - first);
        of.stride = spot_stride;
        of.first_sample = static_cast<std::uint32_t>(reflection) * picks_per_record;
        const std::size_t picks = of.count * std::size_t{picks_per_record};
        record("cache.pick", picks, [&](const WaitList& wait) {
            return passes.pick(record.queue(), of, scene, spot.hemicubes, places, wait);
        });
        const std::vector<CacheRecord> met = read_records(places, pick_stride, picks);
        std::vector<float> albedo(3 * pick_stride);
        record.queue().enqueueReadBuffer(places, CL_TRUE, PICK_ALBEDO * pick_stride * sizeof(float),
                                         albedo.size() * sizeof(float), albedo.data());
        std::vector<Vpl> next;
        for (std::size_t i = 0; i < picks; ++i) {
            const Vpl& from = all[first + i / picks_per_record];
            const glm::vec3 way = met[i].position - glm::vec3(from.position);
            const float distance = glm::length(way), cosine = -glm::dot(way, met[i].normal);
            if (from.flux.w == 0.0f || met[i].normal == glm::vec3(0.0f) || !(cosine > 0.0f) ||
                has_record(records, met[i], distance))
                continue;
            // What a pick of a cosine lobe stands for: pi / (16 cos) steradians.
            const float leaving = glm::dot(way, glm::vec3(from.normal));
            const float slant = std::max(cosine * leaving, 0.0025f * distance * distance);
            const float radius2 =
                distance * distance * distance * distance / (slant * picks_per_record);
            Vpl out{float4(met[i].position, radius2), float4(met[i].normal, radius2 * radius2),
                    from.flux};
            for (std::size_t c = 0; c < 3; ++c)
                (&out.flux.x)[c] *= albedo[c * pick_stride + i] / picks_per_record;
            next.push_back(out);
        }
        first = all.size();
        next = thinned(next, most);
        all.insert(all.end(), next.begin(), next.end());
        draw_hemicubes(all, first);
    }
    spots.sample_count = static_cast<std::uint32_t>(all.size());
    record.write(spot.spots, all.data(), all.size() * sizeof(Vpl));
}

}  // namespace clgi
