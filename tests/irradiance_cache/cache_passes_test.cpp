// The passes of an irradiance cache with buffers of the test's own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <limits>
#include <random>
#include <utility>

#include "device.hpp"
#include "math_modes.hpp"
#include "shares_by_hand.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

// Between two records that are as near, light is their mean, and the doubt the square of half their
// difference of luminance; on one of them it is almost its own.
TEST(CachePasses, ShowsTheMeanOfRecordsAndHowFarTheyDiffer) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    const TwoRecords two;
    constexpr std::uint32_t stride = plane;
    // Points: in the middle, on the second record, one that faces away, background.
    std::vector<float> planes(GBUFFER_PLANES * stride, 0.0f);
    for (std::uint32_t i = 0; i < 3; ++i) {
        planes[GBUFFER_POSITION * stride + i] = i == 1 ? 1.0f : 0.0f;
        planes[(GBUFFER_NORMAL + 1) * stride + i] = i == 2 ? -1.0f : 1.0f;
    }
    const GBuffer points = points_of(planes, stride);
    const cl::Buffer irradiance = test::upload(std::vector<float>(3 * stride, -1.0f)),
                     doubt = test::upload(std::vector<float>(stride, -1.0f));
    passes.show(queue, {4, stride, 0, 0}, two.tree, two.b, points, irradiance, doubt);
    std::vector<float> found(3 * stride), doubts(stride);
    queue.enqueueReadBuffer(irradiance, CL_TRUE, 0, found.size() * sizeof(float), found.data());
    queue.enqueueReadBuffer(doubt, CL_TRUE, 0, doubts.size() * sizeof(float), doubts.data());
    for (std::uint32_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(found[c * stride], 0.5f * (two.values[0][c] + two.values[1][c]), 1e-5f);
        EXPECT_NEAR(found[c * stride + 1], two.values[1][c], 0.01f * two.values[1][c]);
        EXPECT_EQ(found[c * stride + 2], 0.0f);
        EXPECT_EQ(found[c * stride + 3], 0.0f);
        EXPECT_EQ(found[c * stride + next_packet], -1.0f);
    }
    EXPECT_NEAR(doubts[0], two.half * two.half, 1e-5f);
    EXPECT_LT(doubts[1], 0.02f * two.half * two.half);
    EXPECT_EQ(doubts[2], 0.0f);
    EXPECT_EQ(doubts[3], 0.0f);
    EXPECT_EQ(doubts[next_packet], -1.0f);
}

// worth = rho sqrt(spread + (Y / 10)^2 + bare^2), by hand: in the middle, on the second record,
// beside the first, and of nothing. Of a surface that faces away no record says anything; it may
// have as much as the brightest.
TEST(CachePasses, WeighWhatPicksSend) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    const TwoRecords two;
    constexpr std::uint32_t stride = plane;
    std::vector<float> places(PICK_PLANES * stride, 0.0f);
    const float across[] = {0.0f, 1.0f, 0.0f, -0.9f};
    for (std::uint32_t i = 0; i < 4; ++i) {
        places[i] = across[i];
        places[(RECORD_NORMAL + 1) * stride + i] = i == 2 ? -1.0f : 1.0f;
        places[PICK_REFLECTANCE * stride + i] = 0.25f;
    }
    CacheParams params{};
    params.count = 1;
    params.picks = 5;
    params.pick_stride = stride;
    const cl::Buffer worth = test::upload(std::vector<float>(stride, -1.0f)),
                     nearest = test::upload(std::vector<std::uint32_t>(stride, 77));
    passes.weigh(queue, params, two.tree, two.b, test::upload(places), worth, nearest);
    std::vector<float> found(stride);
    std::vector<std::uint32_t> cells(stride);
    queue.enqueueReadBuffer(worth, CL_TRUE, 0, stride * sizeof(float), found.data());
    queue.enqueueReadBuffer(nearest, CL_TRUE, 0, stride * sizeof(float), cells.data());
    const float mean = 0.2126f * 3.0f + 0.7152f * 1.5f + 0.0722f * 5.5f;
    EXPECT_NEAR(found[0], 0.25f * std::sqrt(two.half * two.half + 0.01f * mean * mean), 1e-5f);
    const auto luminance_of = [&](int i) {
        return 0.2126f * two.values[i][0] + 0.7152f * two.values[i][1] + 0.0722f * two.values[i][2];
    };
    EXPECT_NEAR(found[1], 0.25f * 0.1f * luminance_of(1), 1e-4f);
    EXPECT_EQ(cells[1], 1u);
    EXPECT_EQ(cells[3], 0u);
    EXPECT_NEAR(found[2], 0.25f * luminance_of(1), 1e-5f);
    EXPECT_EQ(found[4], 0.0f);
    for (const std::uint32_t none : {2u, 4u}) EXPECT_EQ(cells[none], CACHE_NONE);
    EXPECT_EQ(found[next_packet], -1.0f);
    EXPECT_EQ(cells[next_packet], 77u);
}

// Records on a tilted surface, by lookup.clh in double precision: weights by distance and facing,
// none for the farthest, then shares that carry on what changes evenly, here in the middle of the
// records and beside all of them. A field that is even there is nearly found, where weights alone
// are far off.
TEST(CachePasses, CarriesOnWhatChangesEvenlyBetweenRecords) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t stride = 16, count = 9;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 1.0, -0.2)),
                     across = glm::normalize(glm::cross(normal, glm::dvec3(0, 0, 1))),
                     along = glm::cross(normal, across);
    std::vector<glm::dvec3> places;
    const std::vector<glm::dvec3> normals(count, normal);
    std::vector<float> records(RECORD_PLANES * stride, 0.0f), light(3 * stride, 0.0f),
        planes(GBUFFER_PLANES * stride, 0.0f);
    std::vector<std::uint32_t> lists(CACHE_WAYS * CACHE_LISTED, CACHE_NONE);
    const auto field = [&](const glm::dvec3& at, std::uint32_t c) {
        return 2.0 + c + (1.0 - 0.7 * c) * glm::dot(at, across) + 0.5 * c * glm::dot(at, along);
    };
    for (std::uint32_t i = 0; i < count; ++i) {
        places.push_back((i % 3 + 0.1 * i) * across + (i / 3 - 0.07 * i) * along);
        for (int c = 0; c < 3; ++c) {
            const auto plane_of = static_cast<std::uint32_t>(c);
            records[(RECORD_POSITION + plane_of) * stride + i] = static_cast<float>(places[i][c]);
            records[(RECORD_NORMAL + plane_of) * stride + i] = static_cast<float>(normal[c]);
            light[plane_of * stride + i] = static_cast<float>(field(places[i], plane_of));
        }
        lists[2 * CACHE_LISTED + i] = i;  // +y
    }
    const std::vector<glm::dvec3> points = {1.3 * across + 0.8 * along, -0.4 * across + 0.5 * along,
                                            2.1 * across + 2.4 * along};
    for (std::uint32_t k = 0; k < points.size(); ++k)
        for (int c = 0; c < 3; ++c) {
            const auto plane_of = static_cast<std::uint32_t>(c);
            planes[(GBUFFER_POSITION + plane_of) * stride + k] = static_cast<float>(points[k][c]);
            planes[(GBUFFER_NORMAL + plane_of) * stride + k] = static_cast<float>(normal[c]);
        }
    const CacheTree tree = one_leaf(count, stride);
    CacheBuffers b;
    b.nodes = test::upload(std::vector<std::uint32_t>{CACHE_LEAF});
    b.lists = test::upload(lists);
    b.planes = test::upload(records);
    b.light = test::upload(light);
    const cl::Buffer irradiance = test::empty<float>(3 * stride),
                     doubt = test::empty<float>(stride);
    passes.show(queue, {3, stride, 0, 0}, tree, b, points_of(planes, stride), irradiance, doubt);
    std::vector<float> found(3 * stride);
    queue.enqueueReadBuffer(irradiance, CL_TRUE, 0, found.size() * sizeof(float), found.data());

    for (std::uint32_t k = 0; k < points.size(); ++k) {
        const std::vector<double> share = shares_by_hand(places, normals, points[k], normal);
        const std::vector<double> carried = carried_by_hand(share, places, points[k]);
        for (std::uint32_t c = 0; c < 3; ++c) {
            double weighted = 0.0, by_hand = 0.0;
            for (std::uint32_t i = 0; i < count; ++i) {
                weighted += share[i] * field(places[i], c);
                by_hand += carried[i] * field(places[i], c);
            }
            const double is = found[c * stride + k], even = field(points[k], c);
            EXPECT_NEAR(is, by_hand, 2e-5 * by_hand) << k << " " << c;
            const double before = std::abs(weighted - even);
            EXPECT_LT(std::abs(is - even), (k == 0 ? 0.3 : 0.9) * before)
                << k << " " << c << " " << before;
        }
    }
}

// Each pass with buffers for its records, and then with one of them too small.
// Rows are shorter than planes, as records that light no others have columns in none. What lies
// past them in a plane is not read, and records before the first are not written.
TEST(CachePasses, BounceSumsRowsOfTheirOwnLength) {
    constexpr std::uint32_t stride = 48, row = 32, columns = 20, first = 2, count = 35;
    std::mt19937 generator(5);
    std::uniform_real_distribution<float> random(0.1f, 1.0f);
    const auto drawn = [&](std::size_t size) {
        std::vector<float> out(size);
        for (float& value : out) value = random(generator);
        return out;
    };
    std::vector<float> rows(3 * std::size_t{row} * (first + count), 0.0f),
        light = drawn(3 * stride);
    for (std::size_t k = 0; k < rows.size(); ++k)
        if (k % row < columns) rows[k] = random(generator);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t k = row; k < stride; ++k)
            light[c * stride + k] = std::numeric_limits<float>::quiet_NaN();
    const auto base = drawn(3 * stride), reflected = drawn(3 * stride), bright = drawn(3 * stride);
    CacheBuffers b;
    b.rows = test::upload(rows);
    b.base = test::upload(base);
    b.reflected = test::upload(reflected);
    b.bright = test::upload(bright);
    b.light = test::upload(light);
    b.next = test::upload(std::vector<float>(3 * stride, -1.0f));
    b.shown = test::upload(std::vector<float>(3 * stride, -1.0f));
    CachePasses(test::programs(), test::usual_build())
        .bounce(test::device().queue, {count, stride, first, row}, b);
    const auto next = test::download<float>(b.next, 3 * stride),
               shown = test::download<float>(b.shown, 3 * stride);
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_EQ(next[c * stride + first - 1], -1.0f);
        for (std::size_t i = first; i < first + count; ++i) {
            const std::size_t at = c * stride + i;
            double sum = double{base[at]} + double{reflected[at]};
            for (std::size_t k = 0; k < columns; ++k)
                sum += double{rows[(3 * i + c) * row + k]} * double{light[c * stride + k]};
            EXPECT_NEAR(next[at], sum, 1e-5 * sum) << c << " " << i;
            EXPECT_NEAR(shown[at], sum - double{bright[at]}, 1e-5 * sum) << c << " " << i;
        }
    }
}

TEST(CachePasses, RefuseBuffersThatAreTooSmall) {
    const DeviceScene scene = test::on_device(furnace({.subdivisions = 1}));
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t records = 4, stride = 16, size = 8;
    CacheParams params{};
    params.count = records;
    params.stride = params.row_stride = stride;
    params.size = size;
    params.picks = 2;
    params.pick_stride = 16;
    params.emitter_step = params.thin = params.every = 1;
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
        for (cl::Buffer* light : {&b.base, &b.reflected, &b.bright, &b.light, &b.next, &b.shown})
            *light = test::empty<float>(3 * stride);
        if (small) b.*small = test::empty<float>(1);
        return b;
    };
    const cl::Buffer places = test::empty<float>(PICK_PLANES * 16);
    const cl::Buffer worth = test::empty<float>(16);
    const EmitterBuffers emitters = no_emitters();
    GBuffer points;
    points.stride = stride;
    points.planes = test::empty<float>(GBUFFER_PLANES * stride);
    const cl::Buffer irradiance = test::empty<float>(3 * stride);
    cl::Buffer doubt = test::empty<float>(stride);
    const auto pick = [&](const CacheBuffers& b) { passes.pick(queue, params, scene, b, places); };
    const auto weigh = [&](const CacheBuffers& b) {
        passes.weigh(queue, params, tree, b, places, worth, worth);
    };
    const auto link = [&](const CacheBuffers& b) {
        passes.link(queue, params, tree, scene, emitters, b);
    };
    const auto bounce = [&](const CacheBuffers& b) {
        passes.bounce(queue, {records, stride, 0, stride}, b);
    };
    const auto show = [&](const CacheBuffers& b) {
        passes.show(queue, {4, stride, 0, 0}, tree, b, points, irradiance, doubt);
    };
    const CachePasses::Sharpened sharp{test::empty<float>(3 * stride),
                                       test::empty<float>(3 * stride)},
        no_from{test::empty<float>(1), sharp.to}, no_to{sharp.from, test::empty<float>(1)};
    const auto sharpen = [&](const CacheBuffers& b, const CachePasses::Sharpened& light,
                             const CachePasses::Sharpened& more, std::uint32_t most = 1) {
        passes.sharpen(queue, {most, 0, 1, 0}, tree, b, light, more);
    };
    for (const auto& bad : {no_from, no_to}) {
        EXPECT_THROW(sharpen(buffers(nullptr), bad, sharp), Error);
        EXPECT_THROW(sharpen(buffers(nullptr), sharp, bad), Error);
    }
    for (const std::uint32_t most : {0u, CACHE_LISTED + 1u})
        EXPECT_THROW(sharpen(buffers(nullptr), sharp, sharp, most), Error);
    using B = CacheBuffers;
    EXPECT_THROW(sharpen(buffers(&B::planes), sharp, sharp), Error);
    for (const auto small : {&B::views, &B::visibility}) EXPECT_THROW(pick(buffers(small)), Error);
    for (const auto small :
         {&B::planes, &B::views, &B::visibility, &B::rows, &B::base, &B::reflected, &B::bright})
        EXPECT_THROW(link(buffers(small)), Error);
    for (const auto small :
         {&B::rows, &B::base, &B::reflected, &B::bright, &B::light, &B::next, &B::shown})
        EXPECT_THROW(bounce(buffers(small)), Error);
    for (const auto small : {&B::planes, &B::light}) EXPECT_THROW(show(buffers(small)), Error);
    for (const auto small : {&B::planes, &B::light}) EXPECT_THROW(weigh(buffers(small)), Error);
    EXPECT_NO_THROW(bounce(buffers(nullptr)));
    for (const auto& [first, row] :
         {std::pair(stride - records + 1, stride), {0u, 2 * stride}, {0u, 8u}})
        EXPECT_THROW(passes.bounce(queue, {records, stride, first, row}, buffers(nullptr)), Error)
            << first << " " << row;
    params.row_stride = 8;  // no whole packets
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.row_stride = stride;
    doubt = test::empty<float>(1);
    EXPECT_THROW(show(buffers(nullptr)), Error);
    params.thin = 0;  // no block would count
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.thin = 1;
    params.emitter_step = 0;  // nothing would take a turn
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.emitter_step = params.every = 1;
    params.whole_emitters = 1;  // of none
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.whole_emitters = 0;
    params.bright = 1;  // the sky has one part
    params.sky_width = params.sky_height = 1;
    EXPECT_THROW(link(buffers(nullptr)), Error);
    params.bright = 0;
    params.size = 12;
    EXPECT_THROW(pick(buffers(nullptr)), Error);
    queue.finish();
}

}  // namespace
}  // namespace clgi
