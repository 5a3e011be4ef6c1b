// Arg-max, sums and bounds: against sums in double precision and the standard library, for every
// work-group size; and what all tools refuse.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <cstring>
#include <limits>

#include "math_modes.hpp"
#include "opencl_calls.hpp"
#include "parallel_tools.hpp"

namespace clgi {
namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan_value = std::nanf("");

// Few different values: ties are the rule.
std::vector<float> tied_floats(std::uint32_t count) {
    std::vector<float> out;
    for (const std::uint32_t word : test::random_words(count, count))
        out.push_back(static_cast<float>(word % 64) - 70.0f);
    return out;
}

void expect_best(const ParallelPasses& passes, const std::vector<float>& items) {
    std::uint32_t index = ARG_MAX_NONE, nans = 0;
    for (std::uint32_t i = 0; i < items.size(); ++i) {
        nans += std::isnan(items[i]);
        if (std::isnan(items[i])) continue;
        if (index == ARG_MAX_NONE || items[i] > items[index]) index = i;
    }
    const ArgMax found = test::arg_max(passes, items);
    EXPECT_EQ(found.index, index) << items.size();
    EXPECT_EQ(found.nans, nans) << items.size();
    EXPECT_EQ(found.value, index == ARG_MAX_NONE ? -infinity : items[index]);
}

TEST(ParallelArgMax, IsTheFirstOfTheLargest) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : test::item_counts) {
            std::vector<float> items = tied_floats(n);
            expect_best(passes, items);
            for (std::size_t i = 0; i < items.size(); i += 3) items[i] = nan_value;
            expect_best(passes, items);
            for (float& item : items) item = -nan_value;
            expect_best(passes, items);
            for (float& item : items) item = -infinity;
            expect_best(passes, items);
        }
    expect_best(test::parallel_passes(), tied_floats(3000001));
}

TEST(ParallelArgMax, TakesZerosOfBothSignsAsEqual) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : {5u, 40u, 9000u}) {
            std::vector<float> items(n, -1.0f);
            items[n / 2] = -0.0f;
            items[n - 1] = 0.0f;
            const ArgMax found = test::arg_max(passes, items);
            EXPECT_EQ(found.index, n / 2);
            EXPECT_TRUE(std::signbit(found.value)) << "the item as it was";
        }
}

std::vector<glm::vec4> random_vectors(std::uint32_t count) {
    std::vector<glm::vec4> out(count);
    std::mt19937 random(count);
    std::uniform_real_distribution<float> any(-1.0f, 1.0f);
    for (glm::vec4& v : out)
        v = {any(random), 1e3f + any(random), any(random) * 1e6f, std::abs(any(random))};
    return out;
}

bool same_bits(const void* a, const void* b, std::size_t bytes) {
    return std::memcmp(a, b, bytes) == 0;
}

void expect_sum(const ParallelPasses& passes, const std::vector<glm::vec4>& items) {
    const glm::vec4 found = test::sum(passes, items);
    glm::dvec4 right(0.0), magnitude(0.0);
    for (const glm::vec4& item : items) {
        right += glm::dvec4(item);
        magnitude += glm::abs(glm::dvec4(item));
    }
    const double chunks = std::ceil(static_cast<double>(items.size()) * std::exp2(-24));
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(found[c], right[c], (24.0 + chunks) * std::exp2(-24) * magnitude[c] * 1.00001)
            << items.size() << " items, component " << c;
    const glm::vec4 usual = test::sum(test::parallel_passes(), items);
    EXPECT_TRUE(same_bits(&found, &usual, sizeof usual)) << items.size();
}

TEST(ParallelSum, IsWithinItsBoundAndTheSameForEveryWorkGroup) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : test::item_counts) expect_sum(passes, random_vectors(n));
    expect_sum(test::parallel_passes(), random_vectors(3000001));
}

TEST(ParallelSum, KeepsWhatIsNotFinite) {
    std::vector<glm::vec4> items(9000, glm::vec4(1.0f));
    items[4567] = {nan_value, infinity, -infinity, 1.0f};
    items[8999].z = infinity;
    const glm::vec4 found = test::sum(test::parallel_passes(), items);
    EXPECT_TRUE(std::isnan(found.x));
    EXPECT_EQ(found.y, infinity);
    EXPECT_TRUE(std::isnan(found.z));
    EXPECT_EQ(found.w, 9000.0f);
}

// More tiles than one work-group adds up at once.
CLGI_IN_BOTH_MATHS(LongSum);

TEST_P(LongSum, GoesThroughManyTilesOfTiles) {
    constexpr std::uint32_t n = PARALLEL_TILE * PARALLEL_TILE + 3;
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer items = test::empty<glm::vec4>(n), total = test::empty<glm::vec4>(1);
    queue.enqueueFillBuffer(items, cl_float{0.0f}, 0, std::size_t{n} * sizeof(glm::vec4));
    const glm::vec4 first(1.0f, 2.0f, 3.0f, 4.0f);
    for (const std::uint32_t at : {0u, PARALLEL_TILE * 5u, n - 1u})
        queue.enqueueWriteBuffer(items, CL_TRUE, std::size_t{at} * sizeof(glm::vec4),
                                 sizeof(glm::vec4), &first);
    test::parallel_passes().sum(queue, n, items, total, test::scratch(sum_scratch_bytes(n)));
    EXPECT_EQ(test::download<glm::vec4>(total, 1)[0], 3.0f * first);
}

TEST(ParallelBounds, HoldAllThatIsANumber) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : test::item_counts) {
            std::vector<glm::vec4> items = random_vectors(n);
            for (std::size_t i = 0; i < items.size(); i += 5) items[i].y = nan_value;
            if (n > 16) items[16].x = items[n - 1].z = infinity;
            if (n > 16) items[15].x = items[n - 2].w = -infinity;
            glm::vec4 lower(infinity), upper(-infinity);
            std::uint32_t nans = 0;
            for (const glm::vec4& item : items)
                for (int c = 0; c < 4; ++c) {
                    nans += std::isnan(item[c]);
                    lower[c] = std::fmin(lower[c], item[c]);
                    upper[c] = std::fmax(upper[c], item[c]);
                }
            const ItemBounds found = test::bounds(passes, items);
            EXPECT_EQ(found.lower, lower) << n;
            EXPECT_EQ(found.upper, upper) << n;
            EXPECT_EQ(found.nans, nans) << n;
        }
}

TEST(ParallelReductions, TakeACountFromTheDevice) {
    const std::vector<glm::vec4> items = random_vectors(9000);
    const std::vector<float> floats = tied_floats(9000);
    const cl::CommandQueue& queue = test::device().queue;
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : {0u, 1u, 4097u, 8999u, 20000u}) {
            const std::uint32_t used = std::min(n, 9000u);
            const Items number(9000, test::upload(std::vector<std::uint32_t>{n}));
            const cl::Buffer best = test::empty<ArgMax>(1), total = test::empty<glm::vec4>(1),
                             box = test::empty<ItemBounds>(1);
            passes.arg_max(queue, number, test::upload(floats), best,
                           test::scratch(arg_max_scratch_bytes(9000)));
            passes.sum(queue, number, test::upload(items), total,
                       test::scratch(sum_scratch_bytes(9000)));
            passes.bounds(queue, number, test::upload(items), box,
                          test::scratch(bounds_scratch_bytes(9000)));
            const ArgMax right = test::arg_max(passes, {floats.begin(), floats.begin() + used});
            EXPECT_EQ(test::download<ArgMax>(best, 1)[0].index, right.index) << n;
            const std::vector<glm::vec4> first(items.begin(), items.begin() + used);
            EXPECT_EQ(test::download<glm::vec4>(total, 1)[0], test::sum(passes, first)) << n;
            EXPECT_EQ(test::download<ItemBounds>(box, 1)[0].upper,
                      test::bounds(passes, first).upper)
                << n;
        }
}

// Every buffer of every routine, a byte too small; nothing is enqueued then.
TEST(ParallelRoutines, RefuseBuffersTooSmallBeforeTheyEnqueue) {
    const ParallelPasses& passes = test::parallel_passes();
    const cl::CommandQueue& queue = test::device().queue;
    constexpr std::uint32_t n = 5000;
    const cl::Buffer z = test::upload(std::vector<float>(1 << 20));
    const cl::Buffer none = test::upload(std::vector<float>(1 << 14));  // flags that stay 0
    const auto refuses = [&](const std::string& name, std::size_t needed, auto&& call) {
        test::calls.clear();
        try {
            call(test::empty<char>(needed - 1));
            ADD_FAILURE() << name << " was taken";
        } catch (const Error& error) {
            EXPECT_EQ(error.what(), "parallel." + name + " holds " + std::to_string(needed - 1) +
                                        " bytes, " + std::to_string(needed) + " needed");
        }
        EXPECT_EQ(test::calls.enqueued, 0) << name;
        EXPECT_NO_THROW(call(test::empty<char>(needed)).wait()) << name;
    };
    using B = const cl::Buffer&;
    refuses("scan_sums: items", 4 * n, [&](B b) { return passes.scan(queue, n, b, z, z, z); });
    refuses("scan_tiles: before", 4 * n, [&](B b) { return passes.scan(queue, n, z, b, z, z); });
    refuses("offsets: total", 4, [&](B b) { return passes.scan(queue, n, z, z, b, z); });
    refuses("scan_sums: sums", 8, [&](B b) { return passes.scan(queue, n, z, z, z, b); });
    refuses("flag_sums: flags", n, [&](B b) { return passes.list(queue, n, b, z, z, z); });
    refuses("flag_list: indices", 4 * n, [&](B b) { return passes.list(queue, n, none, b, z, z); });
    refuses("arg_max_tiles: items", 4 * n, [&](B b) { return passes.arg_max(queue, n, b, z, z); });
    refuses("arg_max_merge: result", 16, [&](B b) { return passes.arg_max(queue, n, z, b, z); });
    refuses("arg_max_tiles: best", 32, [&](B b) { return passes.arg_max(queue, n, z, z, b); });
    refuses("sum_tiles: items", 16 * n, [&](B b) { return passes.sum(queue, n, b, z, z); });
    refuses("sum_merge: result", 16, [&](B b) { return passes.sum(queue, n, z, b, z); });
    refuses("sum_tiles: sums", 32, [&](B b) { return passes.sum(queue, n, z, z, b); });
    refuses("bounds_tiles: items", 16 * n, [&](B b) { return passes.bounds(queue, n, b, z, z); });
    refuses("bounds_merge: result", 48, [&](B b) { return passes.bounds(queue, n, z, b, z); });
    refuses("bounds_tiles: boxes", 96, [&](B b) { return passes.bounds(queue, n, z, z, b); });
    refuses("scan_tiles: count", 4, [&](B b) { return passes.scan(queue, {n, b}, z, z, z, z); });
    EXPECT_THROW(passes.sum(queue, (1u << 31) + 1, z, z, z), Error);
    const auto with = [&](cl::Buffer SortBuffers::*which, B b) {
        SortBuffers buffers = test::sort_buffers(test::random_words(n), test::random_words(n));
        buffers.*which = b;
        return passes.sort(queue, n, 32, buffers);
    };
    refuses("digit_counts: keys", 4 * n, [&](B b) { return with(&SortBuffers::keys, b); });
    refuses("digit_scatter: payload", 4 * n, [&](B b) { return with(&SortBuffers::payload, b); });
    refuses("digit_scatter: other_keys", 4 * n,
            [&](B b) { return with(&SortBuffers::other_keys, b); });
    refuses("digit_scatter: other_payload", 4 * n,
            [&](B b) { return with(&SortBuffers::other_payload, b); });
}

// Each pass waits for the one before by name, the first for what it is given.
TEST(ParallelRoutines, RunOnQueuesOutOfOrder) {
    const cl::CommandQueue queue(test::device().context, test::device().device,
                                 CL_QUEUE_OUT_OF_ORDER_EXEC_MODE_ENABLE);
    const ParallelPasses& passes = test::parallel_passes();
    const auto keys = test::random_words(50000, 1), payload = test::random_words(50000, 2);
    const SortBuffers buffers = test::sort_buffers(keys, payload);
    cl::UserEvent gate(test::device().context);
    const cl::Event end = passes.sort(queue, 50000, 32, buffers, {gate});
    EXPECT_GT(end.getInfo<CL_EVENT_COMMAND_EXECUTION_STATUS>(), CL_RUNNING);
    gate.setStatus(CL_COMPLETE);
    end.wait();
    const test::Sorted found{test::download<std::uint32_t>(buffers.keys, 50000),
                             test::download<std::uint32_t>(buffers.payload, 50000)};
    EXPECT_EQ(found, test::sort(passes, keys, 32, payload));
}

}  // namespace
}  // namespace clgi
