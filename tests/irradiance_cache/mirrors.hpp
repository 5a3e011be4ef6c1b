// Points whose smooth lobes are followed by rays, among surfaces whose light a test sets.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <vector>

#include "device.hpp"
#include "glossy_records.hpp"
#include "scenes.hpp"

namespace clgi {

// A square that faces along u x v, from its middle to its sides.
inline void add_square(Scene& scene, const glm::dvec3& middle, const glm::dvec3& u,
                       const glm::dvec3& v, std::uint32_t material) {
    test::add_quad(scene, {middle - u - v, middle + u - v, middle + u + v, middle - u + v},
                   material);
}

// A scene and a record for each of the six ways to face, +x, -x, +y and so on, of light of its own.
struct Mirrors {
    explicit Mirrors(const Scene& of) : world(of), scene(test::on_device(world)) {
        std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
        std::vector<float> planes(RECORD_PLANES * test::record_stride, 0.0f);
        for (std::uint32_t way = 0; way < CACHE_WAYS; ++way) {
            lists[way * CACHE_LISTED] = way;
            planes[(RECORD_NORMAL + way / 2) * test::record_stride + way] = way % 2 ? -1.0f : 1.0f;
        }
        b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
        b.lists = test::upload(lists);
        b.planes = test::upload(planes);
        b.views = test::empty<View>(1);
        b.visibility = test::empty<std::uint64_t>(1);
        b.sky = sky = test::empty<float>(4);
        b.by_spots = test::empty<float>(1);
        light.assign(3 * test::record_stride, 0.0f);
        tree.centre.w = 1e3f;
        of_lobes.stride = pixel_stride;
        of_lobes.directions = of_lobes.shared = 4096;
        of_lobes.exposure = 1.0f;
        of_lobes.eye = {0.0f, 1.0f, 0.0f, 1.0f};
        of_lobes.smooth = 0.3f;
        params.count = 1;
        params.stride = test::record_stride;
        params.size = 8;
        params.emission = CACHE_EMISSION_ALL;
        params.lobes = params.emitter_step = params.thin = params.every = 1;
    }

    void set_light(std::uint32_t way, const glm::dvec3& irradiance) {
        for (std::uint32_t c = 0; c < 3; ++c)
            light[c * test::record_stride + way] =
                static_cast<float>(irradiance[static_cast<int>(c)]);
    }

    // side: geometric normals, or those of the points.
    std::vector<glm::dvec3> reflected(const std::vector<Point>& points,
                                      std::optional<glm::dvec3> side = {}) {
        std::vector<float> planes(GBUFFER_PLANES * pixel_stride, 0.0f);
        std::vector<std::int32_t> ids(GBUFFER_ID_PLANES * pixel_stride, -1);
        const auto count = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t p = 0; p <= count; ++p) {  // one more than are asked for
            const Point& point = points[std::min(p, count - 1)];
            const glm::dvec3 local = scene.frame().scale * (point.place - scene.frame().origin),
                             geometric = side.value_or(point.normal);
            const std::pair<int, glm::dvec3> rows[] = {{GBUFFER_POSITION, local},
                                                       {GBUFFER_NORMAL, point.normal},
                                                       {GBUFFER_GEOMETRIC, geometric},
                                                       {GBUFFER_BASE, point.base}};
            for (const auto& [row, value] : rows)
                for (int c = 0; c < 3; ++c)
                    planes[static_cast<std::size_t>(row + c) * pixel_stride + p] =
                        static_cast<float>(value[c]);
            ids[GBUFFER_MATERIAL * pixel_stride + p] = point.material;
            ids[GBUFFER_MAPPED_NORMAL * pixel_stride + p] = point.mapped;
        }
        of_lobes.pixel_count = count;
        GBuffer gbuffer = points_of(planes, pixel_stride);
        gbuffer.ids = test::upload(ids);
        b.light = test::upload(light);
        const cl::Buffer radiance =
            test::upload(std::vector<float>(RADIANCE_PLANES * pixel_stride, 0.5f));
        const cl::Buffer bad = test::upload(std::vector<std::uint32_t>{0});
        CachePasses(test::programs(), test::usual_build())
            .reflect(test::device().queue, of_lobes, params, tree, scene, emitters, b,
                     {gbuffer, sky, radiance, bad})
            .wait();
        non_finite = test::download<std::uint32_t>(bad, 1)[0];
        const auto values = test::download<float>(radiance, RADIANCE_PLANES * pixel_stride);
        std::vector<glm::dvec3> out(points.size());
        for (std::uint32_t p = 0; p < points.size(); ++p)
            for (std::uint32_t c = 0; c < 3; ++c)
                out[p][static_cast<int>(c)] = double{values[c * pixel_stride + p]} - 0.5;
        EXPECT_EQ(values[count], 0.5f);
        return out;
    }

    Scene world;
    DeviceScene scene;
    CacheBuffers b;
    CacheTree tree = one_leaf(CACHE_WAYS, test::record_stride);
    CacheGlossParams of_lobes{};
    CacheParams params{};
    std::vector<float> light;  // [3][record_stride] exposed lux
    cl::Buffer sky;
    EmitterBuffers emitters = no_emitters();
    std::uint32_t non_finite = 0;
};

}  // namespace clgi
