// The tools over any number of items, called with buffers of exactly the size that each needs.
// SPDX-License-Identifier: MIT
#pragma once

#include <deque>
#include <random>

#include "device.hpp"

namespace clgi::test {

// As built by default first, then with work-groups of all kinds and other packets.
inline const std::deque<ParallelPasses>& all_parallel_passes() {
    static const std::deque<ParallelPasses> all = [] {
        std::deque<ParallelPasses> out;
        for (const BuildOptions& build : {BuildOptions{},
                                          BuildOptions{.packet_width = 1, .local_size = 1},
                                          {.packet_width = 4, .local_size = 7},
                                          {.math = Math::fast, .local_size = 64},
                                          {.packet_width = 8, .local_size = 256}})
            out.emplace_back(device().context, device().device, build);
        return out;
    }();
    return all;
}

inline const ParallelPasses& parallel_passes() {
    return all_parallel_passes()[usual_build().math == Math::fast ? 3 : 0];
}

// No item, one, a leaf more or less, a tile more or less, several tiles.
inline const std::vector<std::uint32_t> item_counts = {0,    1,    15,   16,   17,    1000,
                                                       4095, 4096, 4097, 8192, 100007};

// A buffer that may be empty, which OpenCL does not know.
template <typename T>
cl::Buffer upload_any(const std::vector<T>& values) {
    return values.empty() ? empty<T>(1) : upload(values);
}
inline cl::Buffer scratch(std::size_t bytes) { return empty<char>(bytes > 0 ? bytes : 1); }

inline std::vector<std::uint32_t> random_words(std::size_t count, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::vector<std::uint32_t> out(count);
    for (std::uint32_t& word : out) word = static_cast<std::uint32_t>(random());
    return out;
}

struct Scanned {
    std::vector<std::uint32_t> before;
    std::uint32_t total;
};

inline Scanned scan(const ParallelPasses& passes, const std::vector<std::uint32_t>& items) {
    const auto n = static_cast<std::uint32_t>(items.size());
    const cl::Buffer before = empty<cl_uint>(n + 1), total = empty<cl_uint>(1);
    passes.scan(device().queue, n, upload_any(items), before, total, scratch(scan_scratch_bytes(n)))
        .wait();
    return {download<std::uint32_t>(before, n), download<std::uint32_t>(total, 1)[0]};
}

inline std::vector<std::uint32_t> list(const ParallelPasses& passes,
                                       const std::vector<std::uint8_t>& flags) {
    const auto n = static_cast<std::uint32_t>(flags.size());
    const cl::Buffer indices = empty<cl_uint>(n + 1), listed = empty<cl_uint>(1);
    passes
        .list(device().queue, n, upload_any(flags), indices, listed, scratch(scan_scratch_bytes(n)))
        .wait();
    return download<std::uint32_t>(indices, download<std::uint32_t>(listed, 1)[0]);
}

inline ArgMax arg_max(const ParallelPasses& passes, const std::vector<float>& items) {
    const auto n = static_cast<std::uint32_t>(items.size());
    const cl::Buffer result = empty<ArgMax>(1);
    passes.arg_max(device().queue, n, upload_any(items), result, scratch(arg_max_scratch_bytes(n)))
        .wait();
    return download<ArgMax>(result, 1)[0];
}

inline glm::vec4 sum(const ParallelPasses& passes, const std::vector<glm::vec4>& items) {
    const auto n = static_cast<std::uint32_t>(items.size());
    const cl::Buffer result = empty<glm::vec4>(1);
    passes.sum(device().queue, n, upload_any(items), result, scratch(sum_scratch_bytes(n))).wait();
    return download<glm::vec4>(result, 1)[0];
}

inline ItemBounds bounds(const ParallelPasses& passes, const std::vector<glm::vec4>& items) {
    const auto n = static_cast<std::uint32_t>(items.size());
    const cl::Buffer result = empty<ItemBounds>(1);
    passes.bounds(device().queue, n, upload_any(items), result, scratch(bounds_scratch_bytes(n)))
        .wait();
    return download<ItemBounds>(result, 1)[0];
}

// Keys and payload, one after the other.
struct Sorted {
    std::vector<std::uint32_t> keys, payload;
    bool operator==(const Sorted&) const = default;
};

inline SortBuffers sort_buffers(const std::vector<std::uint32_t>& keys,
                                const std::vector<std::uint32_t>& payload) {
    const std::size_t n = keys.size();
    return {upload_any(keys),      upload_any(payload),           empty<cl_uint>(n + 1),
            empty<cl_uint>(n + 1), scratch(sort_counts_bytes(n)), scratch(sort_sums_bytes(n))};
}

inline Sorted sort(const ParallelPasses& passes, const std::vector<std::uint32_t>& keys,
                   std::uint32_t key_bits, const std::vector<std::uint32_t>& payload) {
    const auto n = static_cast<std::uint32_t>(keys.size());
    const SortBuffers buffers = sort_buffers(keys, payload);
    passes.sort(device().queue, n, key_bits, buffers).wait();
    return {download<std::uint32_t>(buffers.keys, n), download<std::uint32_t>(buffers.payload, n)};
}

}  // namespace clgi::test
