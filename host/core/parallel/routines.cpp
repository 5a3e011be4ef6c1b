// Several passes in a row, each after the one before.
// SPDX-License-Identifier: MIT
#include <clgi/passes/parallel.hpp>

#include "core/parallel/launch.hpp"

namespace clgi {

using namespace parallel;

// What only a later pass would refuse is refused before the first is enqueued.

cl::Event ParallelPasses::scan(const cl::CommandQueue& queue, const Items& number,
                               const cl::Buffer& items, const cl::Buffer& before,
                               const cl::Buffer& total, const cl::Buffer& scratch,
                               const WaitList& wait) const {
    const auto tiles = static_cast<std::uint32_t>(parallel_tiles(number.most));
    need_items(scan_tiles_, number);
    need_of<std::uint32_t>(scan_tiles_, "before", before, number.most);
    need_of<std::uint32_t>(offsets_, "total", total, 1);
    const cl::Event summed = scan_sums(queue, number, items, scratch, wait);
    const cl::Event placed = offsets(queue, tiles, scratch, total, {summed});
    return scan_tiles(queue, number, scratch, items, before, {placed});
}

cl::Event ParallelPasses::list(const cl::CommandQueue& queue, const Items& number,
                               const cl::Buffer& flags, const cl::Buffer& indices,
                               const cl::Buffer& listed, const cl::Buffer& scratch,
                               const WaitList& wait) const {
    const auto tiles = static_cast<std::uint32_t>(parallel_tiles(number.most));
    need_items(flag_list_, number);
    need_of<std::uint32_t>(flag_list_, "indices", indices, number.most);
    need_of<std::uint32_t>(offsets_, "total", listed, 1);
    const cl::Event counted = flag_sums(queue, number, flags, scratch, wait);
    const cl::Event placed = offsets(queue, tiles, scratch, listed, {counted});
    return flag_list(queue, number, scratch, flags, indices, {placed});
}

cl::Event ParallelPasses::arg_max(const cl::CommandQueue& queue, const Items& number,
                                  const cl::Buffer& items, const cl::Buffer& result,
                                  const cl::Buffer& scratch, const WaitList& wait) const {
    const auto tiles = static_cast<std::uint32_t>(parallel_tiles(number.most));
    need_items(arg_max_merge_, tiles);
    need_of<ArgMax>(arg_max_merge_, "result", result, 1);
    const cl::Event found = arg_max_tiles(queue, number, items, scratch, wait);
    return arg_max_merge(queue, tiles, scratch, result, {found});
}

cl::Event ParallelPasses::sum(const cl::CommandQueue& queue, const Items& number,
                              const cl::Buffer& items, const cl::Buffer& result,
                              const cl::Buffer& scratch, const WaitList& wait) const {
    const auto tiles = static_cast<std::uint32_t>(parallel_tiles(number.most));
    need_items(sum_merge_, tiles);
    need_of<float4>(sum_merge_, "result", result, 1);
    const cl::Event summed = sum_tiles(queue, number, items, scratch, wait);
    return sum_merge(queue, tiles, scratch, result, {summed});
}

cl::Event ParallelPasses::bounds(const cl::CommandQueue& queue, const Items& number,
                                 const cl::Buffer& items, const cl::Buffer& result,
                                 const cl::Buffer& scratch, const WaitList& wait) const {
    const auto tiles = static_cast<std::uint32_t>(parallel_tiles(number.most));
    need_items(bounds_merge_, tiles);
    need_of<ItemBounds>(bounds_merge_, "result", result, 1);
    const cl::Event found = bounds_tiles(queue, number, items, scratch, wait);
    return bounds_merge(queue, tiles, scratch, result, {found});
}

// Digits from the lowest up, each pass stable. An even number of passes leaves the result where the
// keys came from; digits are as even as that allows, the last may have no bits.
cl::Event ParallelPasses::sort(const cl::CommandQueue& queue, const Items& number,
                               std::uint32_t key_bits, const SortBuffers& buffers,
                               const WaitList& wait) const {
    if (key_bits > 32)
        throw Error("parallel.sort: key_bits is " + std::to_string(key_bits) +
                    ", at most 32 needed");
    const std::size_t tiles = need_items(digit_scatter_, number);
    const std::uint32_t passes = (key_bits + 2 * digit_bits_ - 1) / (2 * digit_bits_) * 2;
    const std::uint32_t bits = passes > 0 ? (key_bits + passes - 1) / passes : 0;
    need_of<std::uint32_t>(digit_scatter_, "payload", buffers.payload, number.most);
    need_of<std::uint32_t>(digit_scatter_, "other_keys", buffers.other_keys, number.most);
    need_of<std::uint32_t>(digit_scatter_, "other_payload", buffers.other_payload, number.most);
    need_of<std::uint32_t>(scan_sums_, "sums", buffers.sums, parallel_tiles(tiles << bits));
    DigitParams params{number.most, static_cast<std::uint32_t>(tiles), 0, 0};
    if (number.most == 0 || passes == 0) return launch(digit_scatter_, queue, 0, wait, params);
    SortBuffers from = buffers;
    WaitList before = wait;
    for (std::uint32_t pass = 0; pass < passes; ++pass) {
        params.bits = std::min(bits, key_bits - params.shift);
        const std::uint32_t counts = params.tiles << params.bits;
        const auto counted =
            digit_counts(queue, params, number.count, from.keys, from.counts, before);
        const auto summed = scan_sums(queue, counts, from.counts, from.sums, {counted});
        const auto sums = static_cast<std::uint32_t>(parallel_tiles(counts));
        const auto placed = offsets(queue, sums, from.sums, cl::Buffer(), {summed});
        const auto scanned =
            scan_tiles(queue, counts, from.sums, from.counts, from.counts, {placed});
        before = {digit_scatter(queue, params, number.count, from.counts, from.keys, from.payload,
                                from.other_keys, from.other_payload, {scanned})};
        params.shift += params.bits;
        std::swap(from.keys, from.other_keys);
        std::swap(from.payload, from.other_payload);
    }
    return before.front();
}

}  // namespace clgi
