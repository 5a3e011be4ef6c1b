// SPDX-License-Identifier: MIT
#include <clgi/passes/parallel.hpp>

#include "core/opencl/program.hpp"
#include "core/parallel/launch.hpp"

namespace clgi {

using namespace parallel;

namespace {

constexpr std::size_t digit_local_bytes = 16 << 10;  // so that a GPU's core holds several groups

std::size_t digit_local(std::uint32_t bits, std::size_t group) {
    return (group * sizeof(std::uint16_t) + sizeof(std::uint32_t)) << bits;
}

void need_digit(const PassKernel& pass, const DigitParams& params) {
    if (params.bits > DIGIT_BITS)
        throw Error(pass.name + ": bits is " + std::to_string(params.bits) + ", at most " +
                    std::to_string(DIGIT_BITS) + " needed");
    if (params.tiles != parallel_tiles(params.most))
        throw Error(pass.name + ": tiles is " + std::to_string(params.tiles) + ", " +
                    std::to_string(parallel_tiles(params.most)) + " needed");
}

}  // namespace

ParallelPasses::ParallelPasses(const Programs& programs, const BuildOptions& options) {
    BuildOptions strict = options;
    strict.math = Math::strict;
    const bool alone = !in_groups(programs.device(), options);
    const auto kernel = [&](const char* pass, std::size_t many = PARALLEL_LEAVES) {
        PassKernel out = programs.kernel("parallel", pass, strict);
        // In packets a core takes a tile at a time, alone: its lanes are vectors in the kernel.
        if (options.local_size == 0) out.local_size = alone ? 1 : many;
        return out;
    };
    offsets_ = kernel("offsets");
    scan_sums_ = kernel("scan_sums");
    scan_tiles_ = kernel("scan_tiles");
    flag_sums_ = kernel("flag_sums");
    flag_list_ = kernel("flag_list");
    pick_ = programs.kernel("parallel", "pick", strict);
    arg_max_tiles_ = kernel("arg_max_tiles");
    arg_max_merge_ = kernel("arg_max_merge");
    sum_tiles_ = kernel("sum_tiles");
    sum_merge_ = kernel("sum_merge");
    bounds_tiles_ = kernel("bounds_tiles");
    bounds_merge_ = kernel("bounds_merge");
    digit_counts_ = kernel("digit_counts", 64);
    digit_scatter_ = kernel("digit_scatter", 64);
    while (digit_bits_ > 1 &&
           digit_local(digit_bits_, digit_scatter_.local_size) > digit_local_bytes)
        --digit_bits_;
}

void ParallelPasses::build(std::initializer_list<const char*> passes) const {
    build_named({offsets_, scan_sums_, scan_tiles_, flag_sums_, flag_list_, pick_, arg_max_tiles_,
                 arg_max_merge_, sum_tiles_, sum_merge_, bounds_tiles_, bounds_merge_,
                 digit_counts_, digit_scatter_},
                passes);
}

cl::Event ParallelPasses::offsets(const cl::CommandQueue& queue, std::uint32_t count,
                                  const cl::Buffer& sums, const cl::Buffer& total,
                                  const WaitList& wait) const {
    need_items(offsets_, count);
    need_of<std::uint32_t>(offsets_, "sums", sums, count);
    if (total()) need_of<std::uint32_t>(offsets_, "total", total, 1);
    return launch(offsets_, queue, groups(offsets_, 1), wait, count, sums, total,
                  local_of<std::uint32_t>(offsets_));
}

cl::Event ParallelPasses::scan_sums(const cl::CommandQueue& queue, const Items& number,
                                    const cl::Buffer& items, const cl::Buffer& sums,
                                    const WaitList& wait) const {
    const std::size_t tiles = need_items(scan_sums_, number);
    need_of<std::uint32_t>(scan_sums_, "items", items, number.most);
    need_of<std::uint32_t>(scan_sums_, "sums", sums, tiles);
    return launch(scan_sums_, queue, groups(scan_sums_, tiles), wait, number.most, number.count,
                  items, sums, local_of<std::uint32_t>(scan_sums_));
}

cl::Event ParallelPasses::scan_tiles(const cl::CommandQueue& queue, const Items& number,
                                     const cl::Buffer& offsets, const cl::Buffer& items,
                                     const cl::Buffer& before, const WaitList& wait) const {
    const std::size_t tiles = need_items(scan_tiles_, number);
    need_of<std::uint32_t>(scan_tiles_, "offsets", offsets, tiles);
    need_of<std::uint32_t>(scan_tiles_, "items", items, number.most);
    need_of<std::uint32_t>(scan_tiles_, "before", before, number.most);
    return launch(scan_tiles_, queue, groups(scan_tiles_, tiles), wait, number.most, number.count,
                  offsets, items, before, local_of<std::uint32_t>(scan_tiles_));
}

cl::Event ParallelPasses::flag_sums(const cl::CommandQueue& queue, const Items& number,
                                    const cl::Buffer& flags, const cl::Buffer& sums,
                                    const WaitList& wait) const {
    const std::size_t tiles = need_items(flag_sums_, number);
    need_of<std::uint8_t>(flag_sums_, "flags", flags, number.most);
    need_of<std::uint32_t>(flag_sums_, "sums", sums, tiles);
    return launch(flag_sums_, queue, groups(flag_sums_, tiles), wait, number.most, number.count,
                  flags, sums, local_of<std::uint32_t>(flag_sums_));
}

cl::Event ParallelPasses::flag_list(const cl::CommandQueue& queue, const Items& number,
                                    const cl::Buffer& offsets, const cl::Buffer& flags,
                                    const cl::Buffer& indices, const WaitList& wait) const {
    const std::size_t tiles = need_items(flag_list_, number);
    need_of<std::uint32_t>(flag_list_, "offsets", offsets, tiles);
    need_of<std::uint8_t>(flag_list_, "flags", flags, number.most);
    need_of<std::uint32_t>(flag_list_, "indices", indices, number.most);
    return launch(flag_list_, queue, groups(flag_list_, tiles), wait, number.most, number.count,
                  offsets, flags, indices, local_of<std::uint32_t>(flag_list_));
}

cl::Event ParallelPasses::pick(const cl::CommandQueue& queue, const PickParams& params,
                               const cl::Buffer& count, const cl::Buffer& indices,
                               const cl::Buffer& planes, const cl::Buffer& picked,
                               const WaitList& wait) const {
    need_items(pick_, {params.most, count});
    if (params.out_stride < params.most)
        throw Error(pick_.name + ": out_stride is " + std::to_string(params.out_stride) +
                    ", at least " + std::to_string(params.most) + " needed");
    need_of<std::uint32_t>(pick_, "indices", indices, params.most);
    need_of<std::uint32_t>(pick_, "planes", planes, std::size_t{params.planes} * params.stride);
    need_of<std::uint32_t>(pick_, "picked", picked, std::size_t{params.planes} * params.out_stride);
    return launch(pick_, queue, params.most, wait, params, count, indices, planes, picked);
}

cl::Event ParallelPasses::arg_max_tiles(const cl::CommandQueue& queue, const Items& number,
                                        const cl::Buffer& items, const cl::Buffer& best,
                                        const WaitList& wait) const {
    const std::size_t tiles = need_items(arg_max_tiles_, number);
    need_of<float>(arg_max_tiles_, "items", items, number.most);
    need_of<ArgMax>(arg_max_tiles_, "best", best, tiles);
    return launch(arg_max_tiles_, queue, groups(arg_max_tiles_, tiles), wait, number.most,
                  number.count, items, best, local_of<ArgMax>(arg_max_tiles_));
}

cl::Event ParallelPasses::arg_max_merge(const cl::CommandQueue& queue, std::uint32_t tiles,
                                        const cl::Buffer& best, const cl::Buffer& result,
                                        const WaitList& wait) const {
    need_items(arg_max_merge_, tiles);
    need_of<ArgMax>(arg_max_merge_, "best", best, tiles);
    need_of<ArgMax>(arg_max_merge_, "result", result, 1);
    return launch(arg_max_merge_, queue, groups(arg_max_merge_, 1), wait, tiles, best, result,
                  local_of<ArgMax>(arg_max_merge_));
}

cl::Event ParallelPasses::sum_tiles(const cl::CommandQueue& queue, const Items& number,
                                    const cl::Buffer& items, const cl::Buffer& sums,
                                    const WaitList& wait) const {
    const std::size_t tiles = need_items(sum_tiles_, number);
    need_of<float4>(sum_tiles_, "items", items, number.most);
    need_of<float4>(sum_tiles_, "sums", sums, tiles);
    return launch(sum_tiles_, queue, groups(sum_tiles_, tiles), wait, number.most, number.count,
                  items, sums);
}

cl::Event ParallelPasses::sum_merge(const cl::CommandQueue& queue, std::uint32_t tiles,
                                    const cl::Buffer& sums, const cl::Buffer& result,
                                    const WaitList& wait) const {
    need_items(sum_merge_, tiles);
    need_of<float4>(sum_merge_, "sums", sums, tiles);
    need_of<float4>(sum_merge_, "result", result, 1);
    return launch(sum_merge_, queue, groups(sum_merge_, 1), wait, tiles, sums, result);
}

cl::Event ParallelPasses::bounds_tiles(const cl::CommandQueue& queue, const Items& number,
                                       const cl::Buffer& items, const cl::Buffer& boxes,
                                       const WaitList& wait) const {
    const std::size_t tiles = need_items(bounds_tiles_, number);
    need_of<float4>(bounds_tiles_, "items", items, number.most);
    need_of<ItemBounds>(bounds_tiles_, "boxes", boxes, tiles);
    return launch(bounds_tiles_, queue, groups(bounds_tiles_, tiles), wait, number.most,
                  number.count, items, boxes, local_of<ItemBounds>(bounds_tiles_));
}

cl::Event ParallelPasses::bounds_merge(const cl::CommandQueue& queue, std::uint32_t tiles,
                                       const cl::Buffer& boxes, const cl::Buffer& result,
                                       const WaitList& wait) const {
    need_items(bounds_merge_, tiles);
    need_of<ItemBounds>(bounds_merge_, "boxes", boxes, tiles);
    need_of<ItemBounds>(bounds_merge_, "result", result, 1);
    return launch(bounds_merge_, queue, groups(bounds_merge_, 1), wait, tiles, boxes, result,
                  local_of<ItemBounds>(bounds_merge_));
}

cl::Event ParallelPasses::digit_counts(const cl::CommandQueue& queue, const DigitParams& params,
                                       const cl::Buffer& count, const cl::Buffer& keys,
                                       const cl::Buffer& counts, const WaitList& wait) const {
    need_items(digit_counts_, {params.most, count});
    need_digit(digit_counts_, params);
    const std::size_t digits = std::size_t{1} << params.bits;
    need_of<std::uint32_t>(digit_counts_, "keys", keys, params.most);
    need_of<std::uint32_t>(digit_counts_, "counts", counts, digits * params.tiles);
    return launch(digit_counts_, queue, groups(digit_counts_, params.tiles), wait, params, count,
                  keys, counts, local_of<std::uint16_t>(digit_counts_, digits));
}

cl::Event ParallelPasses::digit_scatter(const cl::CommandQueue& queue, const DigitParams& params,
                                        const cl::Buffer& count, const cl::Buffer& offsets,
                                        const cl::Buffer& keys, const cl::Buffer& payload,
                                        const cl::Buffer& sorted_keys,
                                        const cl::Buffer& sorted_payload,
                                        const WaitList& wait) const {
    need_items(digit_scatter_, {params.most, count});
    need_digit(digit_scatter_, params);
    const std::size_t digits = std::size_t{1} << params.bits;
    need_of<std::uint32_t>(digit_scatter_, "offsets", offsets, digits * params.tiles);
    need_of<std::uint32_t>(digit_scatter_, "keys", keys, params.most);
    need_of<std::uint32_t>(digit_scatter_, "payload", payload, params.most);
    need_of<std::uint32_t>(digit_scatter_, "sorted_keys", sorted_keys, params.most);
    need_of<std::uint32_t>(digit_scatter_, "sorted_payload", sorted_payload, params.most);
    return launch(
        digit_scatter_, queue, groups(digit_scatter_, params.tiles), wait, params, count, offsets,
        keys, payload, sorted_keys, sorted_payload, local_of<std::uint16_t>(digit_scatter_, digits),
        cl::Local(digits * sizeof(std::uint32_t)), local_of<std::uint32_t>(digit_scatter_));
}

}  // namespace clgi
