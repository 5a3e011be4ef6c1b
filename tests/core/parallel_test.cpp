// Prefix sums, compaction and sorting: against the standard library, for every work-group size.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <numeric>

#include "parallel_tools.hpp"

namespace clgi {
namespace {

using test::item_counts;
using Words = std::vector<std::uint32_t>;

void expect_scanned(const ParallelPasses& passes, const Words& items) {
    Words right(items.size());
    std::exclusive_scan(items.begin(), items.end(), right.begin(), 0u);
    const test::Scanned found = test::scan(passes, items);
    EXPECT_EQ(found.before, right) << items.size();
    EXPECT_EQ(found.total, std::accumulate(items.begin(), items.end(), 0u)) << items.size();
}

// Words of 32 random bits: sums wrap around, on the device as on the host.
TEST(ParallelScan, IsTheExclusiveSumForEveryWorkGroup) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : item_counts) expect_scanned(passes, test::random_words(n, n));
}

// More tiles than one group takes at a time: 4096 x 4096 items and some.
TEST(ParallelScan, GoesThroughManyTilesOfTiles) {
    expect_scanned(test::parallel_passes(), test::random_words((1 << 24) + 5000));
}

TEST(ParallelScan, MayBeDoneInPlace) {
    for (const ParallelPasses& passes : test::all_parallel_passes()) {
        const Words items = test::random_words(9001);
        Words right(items.size());
        std::exclusive_scan(items.begin(), items.end(), right.begin(), 0u);
        const cl::Buffer both = test::upload(items), total = test::empty<cl_uint>(1);
        passes.scan(test::device().queue, 9001, both, both, total,
                    test::scratch(scan_scratch_bytes(9001)));
        EXPECT_EQ(test::download<std::uint32_t>(both, 9001), right);
    }
}

// The count is on the device; what lies behind it is neither read into the sum nor written.
TEST(ParallelScan, TakesACountFromTheDevice) {
    const std::uint32_t most = 10000;
    const Words items = test::random_words(most);
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : {0u, 1u, 4096u, 4100u, 9999u, 10000u, 70000u}) {
            const std::uint32_t used = std::min(n, most);
            const cl::Buffer before = test::upload(Words(most, 7u));
            const cl::Buffer total = test::empty<cl_uint>(1);
            passes.scan(test::device().queue, {most, test::upload(Words{n})}, test::upload(items),
                        before, total, test::scratch(scan_scratch_bytes(most)));
            Words right(most, 7u);
            std::exclusive_scan(items.begin(), items.begin() + used, right.begin(), 0u);
            EXPECT_EQ(test::download<std::uint32_t>(before, most), right) << n;
            EXPECT_EQ(test::download<std::uint32_t>(total, 1)[0],
                      std::accumulate(items.begin(), items.begin() + used, 0u))
                << n;
        }
}

// Any byte but 0 is set.
std::vector<std::uint8_t> random_flags(std::size_t count, std::uint32_t one_in) {
    std::vector<std::uint8_t> flags;
    for (const std::uint32_t word : test::random_words(count, one_in))
        flags.push_back(word % one_in == 0 ? static_cast<std::uint8_t>(1 + (word >> 8) % 255) : 0);
    return flags;
}

Words indices_of(const std::vector<std::uint8_t>& flags) {
    Words right;
    for (std::uint32_t i = 0; i < flags.size(); ++i)
        if (flags[i]) right.push_back(i);
    return right;
}

TEST(ParallelList, HoldsWhatIsFlaggedInOrder) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : item_counts)
            for (const std::uint32_t one_in : {1u, 2u, 100u}) {
                const auto flags = random_flags(n, one_in);
                EXPECT_EQ(test::list(passes, flags), indices_of(flags)) << n << " " << one_in;
            }
}

TEST(ParallelList, HoldsSomeOfMillions) {
    const auto flags = random_flags(3000001, 3);
    EXPECT_EQ(test::list(test::parallel_passes(), flags), indices_of(flags));
}

TEST(ParallelPick, PutsPlanesInARow) {
    const std::uint32_t stride = 5001, most = 3000, out_stride = 3001, planes = 3;
    const Words words = test::random_words(planes * stride);
    Words indices;
    for (std::uint32_t i = 0; i < most; ++i) indices.push_back(stride - 1 - i);
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : {0u, 1u, 2999u, 3000u, 9000u}) {
            const cl::Buffer picked = test::upload(Words(planes * out_stride, 7u));
            passes.pick(test::device().queue, {most, planes, stride, out_stride},
                        test::upload(Words{n}), test::upload(indices), test::upload(words), picked);
            Words right(planes * out_stride, 7u);
            for (std::uint32_t plane = 0; plane < planes; ++plane)
                for (std::uint32_t i = 0; i < std::min(n, most); ++i)
                    right[plane * out_stride + i] = words[plane * stride + indices[i]];
            EXPECT_EQ(test::download<std::uint32_t>(picked, right.size()), right) << n;
        }
}

test::Sorted stable_sorted(const Words& keys, std::uint32_t key_bits, const Words& payload) {
    const std::uint32_t mask = key_bits == 32 ? ~0u : (1u << key_bits) - 1u;
    Words order(keys.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return (keys[a] & mask) < (keys[b] & mask);
    });
    test::Sorted right;
    for (const std::uint32_t i : order) {
        right.keys.push_back(keys[i]);
        right.payload.push_back(payload[i]);
    }
    return right;
}

// All 32 bits of a key are random, so bits that are not to be looked at would show.
TEST(ParallelSort, IsStableForEveryWorkGroup) {
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : item_counts) {
            const Words keys = test::random_words(n, 3), payload = test::random_words(n, 4);
            for (const std::uint32_t key_bits : {5u, 32u})
                EXPECT_EQ(test::sort(passes, keys, key_bits, payload),
                          stable_sorted(keys, key_bits, payload))
                    << n << " keys of " << key_bits << " bits";
        }
}

TEST(ParallelSort, TakesAnyNumberOfBits) {
    const Words keys = test::random_words(6000, 5), payload = test::random_words(6000, 6);
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (std::uint32_t key_bits = 0; key_bits <= 32; ++key_bits)
            EXPECT_EQ(test::sort(passes, keys, key_bits, payload),
                      stable_sorted(keys, key_bits, payload))
                << key_bits;
    EXPECT_THROW(test::sort(test::parallel_passes(), keys, 33, payload), Error);
}

TEST(ParallelSort, SortsMillions) {
    const Words keys = test::random_words(3000001, 7), payload = test::random_words(3000001, 8);
    EXPECT_EQ(test::sort(test::parallel_passes(), keys, 32, payload),
              stable_sorted(keys, 32, payload));
}

TEST(ParallelSort, TakesACountFromTheDevice) {
    const Words keys = test::random_words(9000, 7), payload = test::random_words(9000, 8);
    for (const ParallelPasses& passes : test::all_parallel_passes())
        for (const std::uint32_t n : {0u, 1u, 4097u, 8999u, 20000u}) {
            const SortBuffers buffers = test::sort_buffers(keys, payload);
            passes.sort(test::device().queue, {9000, test::upload(Words{n})}, 24, buffers);
            const std::uint32_t used = std::min(n, 9000u);
            test::Sorted right = stable_sorted(Words(keys.begin(), keys.begin() + used), 24,
                                               Words(payload.begin(), payload.begin() + used));
            right.keys.insert(right.keys.end(), keys.begin() + used, keys.end());
            right.payload.insert(right.payload.end(), payload.begin() + used, payload.end());
            EXPECT_EQ(test::download<std::uint32_t>(buffers.keys, 9000), right.keys) << n;
            EXPECT_EQ(test::download<std::uint32_t>(buffers.payload, 9000), right.payload) << n;
        }
}

}  // namespace
}  // namespace clgi
