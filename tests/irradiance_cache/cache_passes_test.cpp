// The passes of an irradiance cache with buffers of the test's own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>

#include "device.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

// A tree of one leaf around the origin.
CacheTree one_leaf(std::uint32_t records, std::uint32_t stride) {
    CacheTree out{};
    out.centre = {0.0f, 0.0f, 0.0f, 4.0f};
    out.node_count = 1;
    out.record_count = records;
    out.stride = stride;
    return out;
}

GBuffer points_of(const std::vector<float>& planes, std::uint32_t stride) {
    GBuffer out;
    out.stride = stride;
    out.planes = test::upload(planes);
    return out;
}

// Between two records that are as near, light is their mean, and the doubt the square of half their
// difference of luminance; on one of them it is almost its own.
TEST(CachePasses, ShowsTheMeanOfRecordsAndHowFarTheyDiffer) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t stride = 16;
    std::vector<float> records(RECORD_PLANES * stride, 0.0f), light(3 * stride, 0.0f),
        planes(GBUFFER_PLANES * stride, 0.0f);
    for (std::uint32_t i = 0; i < 2; ++i) {
        records[RECORD_POSITION * stride + i] = i == 0 ? -1.0f : 1.0f;
        records[(RECORD_NORMAL + 1) * stride + i] = 1.0f;
    }
    const float values[2][3] = {{1.0f, 2.0f, 3.0f}, {5.0f, 1.0f, 8.0f}};
    for (std::uint32_t i = 0; i < 2; ++i)
        for (std::uint32_t c = 0; c < 3; ++c) light[c * stride + i] = values[i][c];
    // Points: in the middle, on the second record, one that faces away, background.
    for (std::uint32_t i = 0; i < 3; ++i) {
        planes[GBUFFER_POSITION * stride + i] = i == 1 ? 1.0f : 0.0f;
        planes[(GBUFFER_NORMAL + 1) * stride + i] = i == 2 ? -1.0f : 1.0f;
    }
    std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
    lists[2 * CACHE_LISTED] = 0;  // +y
    lists[2 * CACHE_LISTED + 1] = 1;
    const CacheTree tree = one_leaf(2, stride);
    CacheBuffers b;
    b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
    b.lists = test::upload(lists);
    b.planes = test::upload(records);
    b.light = test::upload(light);
    const GBuffer points = points_of(planes, stride);
    const cl::Buffer irradiance = test::upload(std::vector<float>(3 * stride, -1.0f)),
                     doubt = test::upload(std::vector<float>(stride, -1.0f));
    passes.show(queue, {4, stride, 0, 0}, tree, b, points, irradiance, doubt);
    std::vector<float> found(3 * stride), doubts(stride);
    queue.enqueueReadBuffer(irradiance, CL_TRUE, 0, found.size() * sizeof(float), found.data());
    queue.enqueueReadBuffer(doubt, CL_TRUE, 0, doubts.size() * sizeof(float), doubts.data());
    for (std::uint32_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[c * stride], 0.5f * (values[0][c] + values[1][c]), 1e-5f);
        EXPECT_NEAR(found[c * stride + 1], values[1][c], 0.01f * values[1][c]);
        EXPECT_EQ(found[c * stride + 2], 0.0f);
        EXPECT_EQ(found[c * stride + 3], 0.0f);
        EXPECT_EQ(found[c * stride + 4], -1.0f);
    }
    const float half = 0.5f * (0.2126f * 4.0f - 0.7152f * 1.0f + 0.0722f * 5.0f);
    EXPECT_NEAR(doubts[0], half * half, 1e-5f);
    EXPECT_LT(doubts[1], 0.02f * half * half);
    EXPECT_EQ(doubts[2], 0.0f);
    EXPECT_EQ(doubts[3], 0.0f);
    EXPECT_EQ(doubts[4], -1.0f);
}

// Three records in a row: weights by distance, and none for the farthest (lookup.clh).
TEST(CachePasses, WeighsRecordsByDistance) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t stride = 16;
    const double places[] = {-1.0, 1.0, 3.0}, at = 0.5;
    std::vector<float> records(RECORD_PLANES * stride, 0.0f), light(3 * stride, 0.0f),
        planes(GBUFFER_PLANES * stride, 0.0f);
    std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
    double mean = 0.0, last = 0.0;
    for (std::uint32_t i = 0; i < 3; ++i) {
        records[RECORD_POSITION * stride + i] = static_cast<float>(places[i]);
        records[(RECORD_NORMAL + 1) * stride + i] = 1.0f;
        light[i] = static_cast<float>(1u << (3 * i));
        lists[2 * CACHE_LISTED + i] = i;  // +y
        const double apart = (places[i] - at) * (places[i] - at);
        mean += 0.1 * apart / 3.0;
        last = std::max(last, apart);
    }
    double sum = 0.0, wanted = 0.0;
    for (std::uint32_t i = 0; i < 3; ++i) {
        const double apart = (places[i] - at) * (places[i] - at), left = 1.0 - 0.999 * apart / last;
        const double weight = left * left * mean / (apart + mean);
        sum += weight;
        wanted += weight * double{light[i]};
    }
    planes[GBUFFER_POSITION * stride] = static_cast<float>(at);
    planes[(GBUFFER_NORMAL + 1) * stride] = 1.0f;
    const CacheTree tree = one_leaf(3, stride);
    CacheBuffers b;
    b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
    b.lists = test::upload(lists);
    b.planes = test::upload(records);
    b.light = test::upload(light);
    const GBuffer points = points_of(planes, stride);
    const cl::Buffer irradiance = test::empty<float>(3 * stride),
                     doubt = test::empty<float>(stride);
    passes.show(queue, {1, stride, 0, 0}, tree, b, points, irradiance, doubt);
    float found = 0.0f;
    queue.enqueueReadBuffer(irradiance, CL_TRUE, 0, sizeof(float), &found);
    EXPECT_NEAR(found, wanted / sum, 1e-5 * wanted / sum);
}

// Each pass with buffers for its records, and then with one of them too small.
TEST(CachePasses, RefuseBuffersThatAreTooSmall) {
    const DeviceScene scene = test::on_device(furnace({.subdivisions = 1}));
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t records = 4, stride = 16, size = 8;
    CacheParams params{};
    params.count = records;
    params.stride = stride;
    params.size = size;
    params.picks = 2;
    params.pick_stride = 16;
    params.emitter_step = 1;
    CacheTree tree{};
    tree.record_count = records;
    tree.stride = stride;
    tree.node_count = 1;
    const std::vector<std::uint32_t> leaf = {CACHE_LEAF};
    const auto buffers = [&](cl::Buffer CacheBuffers::*small) {
        CacheBuffers b;
        b.planes = test::empty<float>(RECORD_PLANES * stride);
        b.views = test::empty<View>(5 * records);
        b.visibility = test::empty<std::uint64_t>(3 * size * size * records);
        b.nodes = test::upload(leaf);
        b.lists = test::empty<std::uint32_t>(CACHE_WAYS * CACHE_LISTED);
        b.sky = test::empty<float>(4);
        b.rows = test::empty<float>(3 * stride * records);
        for (cl::Buffer* light : {&b.base, &b.reflected, &b.light, &b.next})
            *light = test::empty<float>(3 * stride);
        if (small) b.*small = test::empty<float>(1);
        return b;
    };
    const cl::Buffer places = test::empty<float>(RECORD_PLANES * 16);
    EmitterBuffers emitters;
    emitters.kind = Pixels::depth;
    for (cl::Buffer* buffer : {&emitters.emitters, &emitters.views, &emitters.visibility})
        *buffer = test::empty<float>(64);
    GBuffer points;
    points.stride = stride;
    points.planes = test::empty<float>(GBUFFER_PLANES * stride);
    const cl::Buffer irradiance = test::empty<float>(3 * stride);
    cl::Buffer doubt = test::empty<float>(stride);
    const auto pick = [&](const CacheBuffers& b) { passes.pick(queue, params, scene, b, places); };
    const auto link = [&](const CacheBuffers& b) {
        passes.link(queue, params, tree, scene, emitters, b);
    };
    const auto bounce = [&](const CacheBuffers& b) {
        passes.bounce(queue, {records, stride, 0, 0}, b);
    };
    const auto show = [&](const CacheBuffers& b) {
        passes.show(queue, {4, stride, 0, 0}, tree, b, points, irradiance, doubt);
    };
    using B = CacheBuffers;
    for (const auto small : {&B::views, &B::visibility}) EXPECT_THROW(pick(buffers(small)), Error);
    for (const auto small :
         {&B::planes, &B::views, &B::visibility, &B::rows, &B::base, &B::reflected})
        EXPECT_THROW(link(buffers(small)), Error);
    for (const auto small : {&B::rows, &B::base, &B::reflected, &B::light, &B::next})
        EXPECT_THROW(bounce(buffers(small)), Error);
    for (const auto small : {&B::planes, &B::light}) EXPECT_THROW(show(buffers(small)), Error);
    EXPECT_NO_THROW(bounce(buffers(nullptr)));
    EXPECT_THROW(passes.bounce(queue, {records, stride, stride - records + 1, 0}, buffers(nullptr)),
                 Error);
    doubt = test::empty<float>(1);
    EXPECT_THROW(show(buffers(nullptr)), Error);
    params.emitter_step = 0;  // nothing would take a turn
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.emitter_step = 1;
    params.whole_emitters = 1;  // of none
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.whole_emitters = 0;
    params.size = 12;
    EXPECT_THROW(pick(buffers(nullptr)), Error);
    queue.finish();
}

}  // namespace
}  // namespace clgi
