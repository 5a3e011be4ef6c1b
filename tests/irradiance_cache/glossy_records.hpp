// Records whose surroundings a test fills by hand, and points whose lobes reflect them.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/passes/cache.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "device.hpp"
#include "microfacet.hpp"
#include "record_cubes.hpp"
#include "scenes.hpp"
#include "two_records.hpp"

namespace clgi {

constexpr std::uint32_t pixel_stride = 512;

// Words of what is around, by hand.
inline std::uint64_t packed(const glm::dvec3& colour) {
    const int exponent = std::ilogb(std::max({colour.x, colour.y, colour.z}));
    const auto step = [&](double value) {
        return std::min(static_cast<std::uint64_t>(std::lround(std::ldexp(value, 15 - exponent))),
                        std::uint64_t{65535});
    };
    return static_cast<std::uint64_t>(exponent + 127) << 48 | step(colour.z) << 32 |
           step(colour.y) << 16 | step(colour.x);
}

inline glm::dvec3 unpacked(std::uint64_t word) {
    if (word == 0) return glm::dvec3(0.0);
    const double step = std::ldexp(1.0, static_cast<int>(word >> 48) - 142);
    return step * glm::dvec3(word & 65535, word >> 16 & 65535, word >> 32 & 65535);
}

// A point of a surface, seen from a direction.
struct Point {
    glm::dvec3 place{0.0}, normal{0, 1, 0}, base{1.0};
    int material = 0, mapped = -1;
};

// Records and points, of which each material is of the scene.
struct Glossy {
    Glossy(const std::vector<Material>& materials, const std::vector<test::RecordPlace>& records,
           std::uint32_t size)
        : world(with(materials)),
          scene(test::on_device(world)),
          b(test::record_cubes(scene, records, size)),
          tree(one_leaf(static_cast<std::uint32_t>(records.size()), test::record_stride)),
          of{tree.record_count, 0, tree.record_count, size} {
        std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
        for (std::uint32_t way = 0; way < CACHE_WAYS; ++way)
            for (std::uint32_t r = 0; r < tree.record_count; ++r) lists[way * CACHE_LISTED + r] = r;
        tree.centre.w = 1e3f;
        b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
        b.lists = test::upload(lists);
        b.light = test::upload(std::vector<float>(3 * test::record_stride, 1.0f));
        params.stride = pixel_stride;
        params.directions = params.shared = 4096;
        params.exposure = 1.0f;
        params.eye = {0.0f, 1.0f, 0.0f, 1.0f};
    }

    static Scene with(const std::vector<Material>& materials) {
        Scene out = test::plain_scene();
        out.materials = materials;
        test::add_floor(out, 0.001, -50.0);
        return out;
    }

    // All pixels of a slot and level.
    void fill(std::uint32_t slot, std::uint32_t level, const glm::dvec3& colour) {
        const std::uint32_t pixels = 3 * of.size * of.size >> 2 * level;
        words.resize(around_bytes(of) / sizeof(std::uint64_t));
        std::fill_n(words.begin() + around_first(of.slots, of.size, level) + slot * pixels, pixels,
                    packed(colour));
    }
    void fill(std::uint32_t slot, const glm::dvec3& colour) {
        for (std::uint32_t level = 0; level < AROUND_LEVELS; ++level) fill(slot, level, colour);
    }

    std::vector<glm::dvec3> reflected(const std::vector<Point>& points, float irradiance = 1.0f) {
        std::vector<float> planes(GBUFFER_PLANES * pixel_stride, 0.0f);
        std::vector<std::int32_t> ids(GBUFFER_ID_PLANES * pixel_stride, -1);
        const auto count = static_cast<std::uint32_t>(points.size());
        for (std::uint32_t p = 0; p <= count; ++p) {  // one more than are asked for
            const Point& point = points[std::min(p, count - 1)];
            const glm::dvec3 local = scene.frame().scale * (point.place - scene.frame().origin);
            for (std::uint32_t c = 0; c < 3; ++c) {
                const int axis = static_cast<int>(c);
                planes[(GBUFFER_POSITION + c) * pixel_stride + p] = static_cast<float>(local[axis]);
                planes[(GBUFFER_NORMAL + c) * pixel_stride + p] =
                    static_cast<float>(point.normal[axis]);
                planes[(GBUFFER_BASE + c) * pixel_stride + p] =
                    static_cast<float>(point.base[axis]);
            }
            ids[GBUFFER_MATERIAL * pixel_stride + p] = point.material;
            ids[GBUFFER_MAPPED_NORMAL * pixel_stride + p] = point.mapped;
        }
        params.pixel_count = count;
        GBuffer gbuffer = points_of(planes, pixel_stride);
        gbuffer.ids = test::upload(ids);
        const cl::Buffer radiance =
            test::upload(std::vector<float>(RADIANCE_PLANES * pixel_stride, 0.5f));
        const cl::Buffer bad = test::upload(std::vector<std::uint32_t>{0});
        const cl::Buffer shown =
            test::upload(std::vector<float>(IRRADIANCE_PLANES * pixel_stride, irradiance));
        words.resize(std::max<std::size_t>(around_bytes(of) / sizeof(std::uint64_t), 1));
        if (!around()) around = test::upload(words);
        CachePasses(test::programs(), test::usual_build())
            .gloss(test::device().queue, params, of, tree, scene, b,
                   {around, gbuffer, shown, radiance, bad})
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
    CacheTree tree;
    CacheAround of;
    CacheGlossParams params{};
    std::vector<std::uint64_t> words;
    cl::Buffer around;  // words, unless it is set
    std::uint32_t non_finite = 0;
};

// What the lobe reflects of light from all directions with black base colour, and what white adds.
struct LobeLight {
    glm::dvec3 white{0.0}, tint{0.0};
};

template <typename Light>
LobeLight lobe_light(const Material& material, const glm::dvec3& normal, const glm::dvec3& viewer,
                     const Light& light) {
    constexpr int rings = 300, turns = 600;
    const glm::dvec3 x = glm::normalize(glm::cross(normal, glm::dvec3(0.3, 0.2, 0.9))),
                     y = glm::cross(normal, x);
    const double alpha = std::max(double{material.roughness * material.roughness}, 0.01);
    LobeLight out;
    for (int ring = 0; ring < rings; ++ring) {
        const double down = 0.5 * std::numbers::pi * (ring + 0.5) / rings;
        for (int turn = 0; turn < turns; ++turn) {
            const double angle = 2 * std::numbers::pi * (turn + 0.5) / turns;
            const glm::dvec3 d = std::sin(down) * (std::cos(angle) * x + std::sin(angle) * y) +
                                 std::cos(down) * normal;
            const double cosine = std::cos(down) * std::sin(down) *
                                  (0.5 * std::numbers::pi / rings) * (2 * std::numbers::pi / turns);
            const auto lobe = [&](double colour) {
                return test::gltf_reflected(material, glm::dvec3(colour), normal, viewer, d)
                    .gloss.x;
            };
            const double black = lobe(0.0);
            out.white += cosine * black * light(d);
            out.tint += cosine * (lobe(1.0) - black) * (1.0 - alpha * alpha) * light(d);
        }
    }
    return out;
}

struct LobeAlbedo {
    double white, tint;
};

inline LobeAlbedo lobe_albedo(const Material& material, const glm::dvec3& normal,
                              const glm::dvec3& viewer) {
    const LobeLight even =
        lobe_light(material, normal, viewer, [](const glm::dvec3&) { return glm::dvec3(1.0); });
    return {even.white.x, even.tint.x};
}

inline const std::vector<Material> finishes = {
    test::finished(0.0f, 0.4f, 1.0f), test::finished(0.0f, 0.8f, 1.0f),
    test::finished(1.0f, 0.45f, 1.0f), test::finished(0.4f, 0.7f, 0.5f)};

}  // namespace clgi
