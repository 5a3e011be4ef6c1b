// A record over a tilted floor in the sun, a plate between, and the passes of small lit places.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/emitters.hpp>
#include <clgi/passes/cache.hpp>
#include <numeric>
#include <optional>

#include "device.hpp"
#include "methods/irradiance_cache/spot_tiles.hpp"
#include "scenes.hpp"
#include "two_records.hpp"

namespace clgi::test::lit_floor {

inline const glm::dvec3 floor_albedo(0.2, 0.5, 0.7);
inline constexpr double slope = 0.3;       // of the floor along x
inline constexpr double plate_end = 0.11;  // along x; tiles show it and the floor
inline constexpr std::uint32_t spot_view_size = 256, places = 16, face = 32;

// A tilted floor of 4 x 4 m and a plate over a part of it.
inline Scene floor_and_plate() {
    Scene scene = test::plain_scene(glm::vec3(floor_albedo));
    const auto at = [](double x, double z) { return glm::dvec3(x, slope * x, z); };
    test::add_quad(scene, {at(-2, 2), at(2, 2), at(2, -2), at(-2, -2)});
    Material dark;
    dark.base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
    test::add_box(scene, {-3, 2, -3}, {plate_end, 2.1, 3}, 1, test::add_material(scene, dark));
    return scene;
}

template <typename T>
std::vector<T> read(const cl::Buffer& from, std::size_t count) {
    std::vector<T> out(count);
    test::device().queue.enqueueReadBuffer(from, CL_TRUE, 0, count * sizeof(T), out.data());
    return out;
}

// One record over the floor that faces it, one light, and what lies between.
struct LitFloor {
    explicit LitFloor(const Light& light, bool above = true) : host(floor_and_plate()) {
        host.lights = {light};
        scene.emplace(test::on_device(host));
        set = make_emitters(*scene, {});
        emitters.emitters = test::upload(set.emitters);
        emitters.views = test::upload(set.views);
        emitters.visibility = test::empty<std::uint32_t>(set.pixels);
        emitters.view_count = set.views.size();
        emitters.pixels = set.pixels;
        emitters.kind = Pixels::depth;
        scale = scene->frame().scale;
        params.count = 1;
        params.stride = params.row_stride = places;
        params.size = face;
        const glm::dvec3 place =
            scale * (glm::dvec3(0.2, above ? 1.5 : -1.5, 0.1) - scene->frame().origin);
        std::vector<float> planes(RECORD_PLANES * places, 0.0f);
        for (int c = 0; c < 3; ++c)
            planes[static_cast<std::size_t>(c) * places] = static_cast<float>(place[c]);
        planes[(RECORD_NORMAL + 1) * places] = planes[(RECORD_GEOMETRIC + 1) * places] =
            above ? -1.0f : 1.0f;
        records.planes = test::upload(planes);
        records.views = test::empty<View>(5);
        records.visibility = test::empty<std::uint64_t>(3 * face * face);
        draw_cube(records, 1);
        spot.seen = test::upload(std::vector<std::uint32_t>(words(), 0u));
        spot.of = test::upload(std::vector<SpotView>{{0, 0, 0, 0}});
        view = set.views[0];
        view.width = view.height = spot_view_size;
        view.first_pixel = 0;
        spot.views = test::upload(std::vector<View>{view});
        spot.visibility = test::empty<std::uint64_t>(spot_view_size * spot_view_size);
        gbuffer.raster_views(
            queue, {0, 1, spot_view_size, spot_view_size, spot_view_size * spot_view_size},
            spot.views, *scene, spot.visibility, Pixels::visibility);
        wanted.assign(SPOT_TILES_A_VIEW * set.views.size(), 1u);
        spot.wanted = test::upload(wanted);
        spot.count = test::empty<std::uint32_t>(SPOT_TILES_A_VIEW);
        spot.area = test::empty<float>(SPOT_TILES_A_VIEW);
        passes.mark(queue, params, *scene, records, spot);
    }

    void draw_cube(const CacheBuffers& of, std::uint32_t count, std::uint32_t stride = places) {
        CubeParams cube{};
        cube.point_count = count;
        cube.faces = 5;
        cube.size = face;
        cube.stride = stride;
        cube.lift = 1e-5f;
        cube.near = 5e-6f;
        std::vector<std::uint32_t> order(stride);
        std::iota(order.begin(), order.end(), 0u);
        gbuffer.cubes(queue, cube, of.planes, test::upload(order), of.views);
        gbuffer.raster_views(queue, {0, 5 * count, face, face, 3 * face * face * count}, of.views,
                             *scene, of.visibility, Pixels::visibility);
    }

    std::size_t words() const { return (2 * scene->info().vertex_count + 31) / 32; }

    double tallied() {
        spot.wanted = test::upload(wanted);
        passes.tally(queue, {1, 0, 0, 0}, spot_view_size, *scene, emitters, spot);
        const auto area = read<float>(spot.area, SPOT_TILES_A_VIEW);
        return std::accumulate(area.begin(), area.end(), 0.0) / (scale * scale);
    }

    std::vector<Vpl> placed(std::size_t most) {
        const auto count = read<std::uint32_t>(spot.count, SPOT_TILES_A_VIEW);
        const auto samples = spot_samples({1.0}, count, most);
        spot.samples = test::upload(samples);
        spot.spots = test::empty<Vpl>(samples.size());
        passes.spots(queue, {1, static_cast<std::uint32_t>(samples.size()), 0, 0}, spot_view_size,
                     *scene, emitters, spot);
        return read<Vpl>(spot.spots, samples.size());
    }

    // So many records stand in for what faces any way.
    CacheTree list(std::uint32_t count) {
        std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
        for (std::uint32_t k = 0; k < count; ++k)
            for (std::size_t way = 0; way < CACHE_WAYS; ++way) lists[way * CACHE_LISTED + k] = k;
        records.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
        records.lists = test::upload(lists);
        return one_leaf(1, places);
    }

    // by_spots: whether these tiles light by VPLs.
    void link_with(const std::vector<std::uint32_t>& tiles, bool by_spots) {
        params.spots = by_spots ? 1 : 0;
        params.thin = params.emitter_step = params.every = 1;
        params.emitter_count = params.whole_emitters =
            static_cast<std::uint32_t>(set.emitters.size());
        const View& shadows = set.views[0];
        gbuffer.raster_views(queue, {0, 1, shadows.width, shadows.height, set.pixels},
                             emitters.views, *scene, emitters.visibility, Pixels::depth);
        records.sky = test::empty<float>(4);
        for (cl::Buffer* light :
             {&records.rows, &records.base, &records.reflected, &records.bright})
            *light = test::empty<float>(3 * places);
        records.by_spots = test::upload(tiles);
        passes.link(queue, params, list(0), *scene, emitters, records);
    }

    // Of VPLs on surfaces.
    void hemicubes_of(const std::vector<Vpl>& vpls) {
        const auto count = static_cast<std::uint32_t>(vpls.size());
        const std::uint32_t stride = (count + 15) / 16 * 16;
        std::vector<float> planes(RECORD_PLANES * stride, 0.0f);
        for (std::uint32_t k = 0; k < count; ++k)
            for (std::uint32_t c = 0; c < 3; ++c) {
                const auto axis = static_cast<int>(c);
                planes[c * stride + k] = vpls[k].position[axis];
                for (const std::uint32_t first : {RECORD_NORMAL, RECORD_GEOMETRIC})
                    planes[(first + c) * stride + k] = vpls[k].normal[axis];
            }
        spot.spots = test::upload(vpls);
        spot.hemicubes.planes = test::upload(planes);
        spot.hemicubes.views = test::empty<View>(5 * count);
        spot.hemicubes.visibility = test::empty<std::uint64_t>(3 * face * face * count);
        draw_cube(spot.hemicubes, count, stride);
    }

    // lumen of all VPLs
    glm::dvec3 flux(const std::vector<Vpl>& vpls) const {
        glm::dvec3 out(0.0);
        for (const Vpl& one : vpls) out += glm::dvec3(one.flux);
        return out * scene->frame().exposure / (scale * scale);
    }

    Scene host;
    std::optional<DeviceScene> scene;
    EmitterSet set;
    EmitterBuffers emitters;
    CacheBuffers records;
    SpotBuffers spot;
    CacheParams params{};
    View view{};
    std::vector<std::uint32_t> wanted;
    double scale = 1.0;
    GBufferPasses gbuffer{test::programs(), test::usual_build()};
    CachePasses passes{test::programs(), test::usual_build()};
    const cl::CommandQueue& queue = test::device().queue;
};

inline Light sun() {
    Light out = test::directional_light({0.3f, -1.0f, 0.1f});
    out.intensity = {3.0f, 4.0f, 5.0f};
    return out;
}

// Of the floor, where the plate does not shade it: section across the sun's light, m^2.
inline double lit_section() {
    const glm::dvec3 way = glm::normalize(glm::dvec3(0.3, -1.0, 0.1)),
                     normal = glm::normalize(glm::dvec3(-slope, 1.0, 0.0));
    constexpr int steps = 2000;
    double area = 0.0;
    for (int i = 0; i < steps; ++i) {  // nothing depends on z: the plate is wider than the floor
        const double x = -2.0 + 4.0 * (i + 0.5) / steps, up = 2.1 - slope * x;
        if (x - up * 0.3 > plate_end) area += 4.0 / steps * 4.0 * std::hypot(1.0, slope);
    }
    return area * -glm::dot(way, normal);
}

}  // namespace clgi::test::lit_floor
