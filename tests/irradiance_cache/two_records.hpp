// Two records of an irradiance cache, and points of a picture that they light.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/cache.hpp>
#include <vector>

#include "device.hpp"
#include "math_modes.hpp"

namespace clgi {

// A tree of one leaf around the origin.
inline CacheTree one_leaf(std::uint32_t records, std::uint32_t stride) {
    CacheTree out{};
    out.centre = {0.0f, 0.0f, 0.0f, 4.0f};
    out.node_count = 1;
    out.record_count = records;
    out.stride = stride;
    return out;
}

inline GBuffer points_of(const std::vector<float>& planes, std::uint32_t stride) {
    GBuffer out;
    out.stride = stride;
    out.planes = test::upload(planes);
    return out;
}

inline EmitterBuffers no_emitters() {
    EmitterBuffers out;
    out.kind = Pixels::depth;
    for (cl::Buffer* buffer : {&out.emitters, &out.views, &out.visibility})
        *buffer = test::empty<float>(64);
    return out;
}

constexpr std::uint32_t plane = 32;        // stride of small planes
constexpr std::uint32_t next_packet = 16;  // whatever the width of packets, which are written whole

// Two records that face up, a metre to the left and to the right of the origin.
struct TwoRecords {
    TwoRecords() {
        std::vector<float> records(RECORD_PLANES * plane, 0.0f), light(3 * plane, 0.0f);
        std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
        for (std::uint32_t i = 0; i < 2; ++i) {
            records[RECORD_POSITION * plane + i] = i == 0 ? -1.0f : 1.0f;
            records[(RECORD_NORMAL + 1) * plane + i] = 1.0f;
            lists[2 * CACHE_LISTED + i] = i;  // +y
            for (std::uint32_t c = 0; c < 3; ++c) light[c * plane + i] = values[i][c];
        }
        b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
        b.lists = test::upload(lists);
        b.planes = test::upload(records);
        b.light = test::upload(light);
    }

    const float values[2][3] = {{1.0f, 2.0f, 3.0f}, {5.0f, 1.0f, 8.0f}};
    // Half of the difference of luminance.
    const float half = 0.5f * (0.2126f * 4.0f - 0.7152f * 1.0f + 0.0722f * 5.0f);
    CacheTree tree = one_leaf(2, plane);
    CacheBuffers b;
};

// Records at the origin that look up, their hemicubes, in which nothing is drawn, and what link
// writes.
inline void look_up(CacheBuffers& b, std::uint32_t size, std::uint32_t count = 2) {
    const cl::CommandQueue& queue = test::device().queue;
    b.views = test::empty<View>(5 * count);
    b.visibility =
        test::upload(std::vector<std::uint64_t>(3 * size * size * count, ~std::uint64_t{0}));
    b.sky = test::empty<float>(4);
    b.rows = test::empty<float>(3 * plane * count);
    b.base = test::empty<float>(3 * plane);
    b.light = test::upload(std::vector<float>(3 * plane, 0.0f));
    for (cl::Buffer* light : {&b.reflected, &b.bright, &b.next, &b.shown})
        *light = test::empty<float>(3 * plane);
    std::vector<float> records(RECORD_PLANES * plane, 0.0f);
    std::vector<std::uint32_t> all(count);
    for (std::uint32_t i = 0; i < count; ++i) {
        all[i] = i;
        for (const std::uint32_t normal : {RECORD_NORMAL, RECORD_GEOMETRIC})
            records[(normal + 1) * plane + i] = 1.0f;
    }
    b.planes = test::upload(records);
    CubeParams of{};
    of.point_count = count;
    of.faces = 5;
    of.size = size;
    of.stride = plane;
    of.near = 1e-4f;
    of.turned = 1;
    GBufferPasses(test::programs(), test::usual_build())
        .cubes(queue, of, b.planes, test::upload(all), b.views);
}

}  // namespace clgi
