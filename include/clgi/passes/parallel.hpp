// Prefix sum, stable compaction, reductions and sort of any number of items, up to 2^31.
// Structs: clgi/shared/parallel.h. Rules for passes: clgi/passes/gbuffer.hpp.
//
// Each costs the same for every item (see "Cost" in kernels/parallel), gives the same bits for
// every work-group size, and leaves its result on the device. Routines enqueue several passes, each
// of which waits for the one before, so a queue may be in order or not; they allocate nothing and
// never wait. The event stands for the last pass.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/parallel.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>

namespace clgi {

// How many items there are: a number, or the smaller of a number and what a buffer of one uint
// holds when the kernels run. Buffers must suffice for `most`.
struct Items {
    Items(std::uint32_t all) : most(all) {}
    Items(std::uint32_t at_most, const cl::Buffer& device_count)
        : most(at_most), count(device_count) {}
    std::uint32_t most;
    cl::Buffer count;  // none: exactly `most`
};

// Tiles of items, and the bytes of scratch that a routine needs.
constexpr std::size_t parallel_tiles(std::size_t items) {
    return (items + PARALLEL_TILE - 1) / PARALLEL_TILE;
}
constexpr std::size_t scan_scratch_bytes(std::size_t items) {  // of scan and of list
    return parallel_tiles(items) * sizeof(std::uint32_t);
}
constexpr std::size_t arg_max_scratch_bytes(std::size_t items) {
    return parallel_tiles(items) * sizeof(ArgMax);
}
constexpr std::size_t sum_scratch_bytes(std::size_t items) {
    return parallel_tiles(items) * sizeof(float4);
}
constexpr std::size_t bounds_scratch_bytes(std::size_t items) {
    return parallel_tiles(items) * sizeof(ItemBounds);
}
constexpr std::size_t sort_counts_bytes(std::size_t items) {
    return (parallel_tiles(items) << DIGIT_BITS) * sizeof(std::uint32_t);
}
constexpr std::size_t sort_sums_bytes(std::size_t items) {
    return scan_scratch_bytes(parallel_tiles(items) << DIGIT_BITS);
}

// What a sort works on: keys and payload are sorted in place, all else is scratch.
struct SortBuffers {
    cl::Buffer keys, payload;              // [most] uint
    cl::Buffer other_keys, other_payload;  // [most] uint
    cl::Buffer counts, sums;               // sort_counts_bytes, sort_sums_bytes
};

// Built with strict math whatever the options say: a fixed tree must not be reordered.
class CLGI_API ParallelPasses {
public:
    explicit ParallelPasses(const Programs& programs, const BuildOptions& options = {});
    ParallelPasses(const cl::Context& context, const cl::Device& device,
                   const BuildOptions& options = {})
        : ParallelPasses(Programs(context, device), options) {}

    // Builds these kernels now, by the names of the passes (clgi/passes/gbuffer.hpp).
    void build(std::initializer_list<const char*> passes) const;

    // ---- routines ------------------------------------------------------------------------------

    // before[i] = the sum of items 0 .. i - 1, and total [1] = the sum of all, modulo 2^32.
    // items may be before.
    CLGI_EXPERIMENTAL cl::Event scan(const cl::CommandQueue& queue, const Items& number,
                                     const cl::Buffer& items, const cl::Buffer& before,
                                     const cl::Buffer& total, const cl::Buffer& scratch,
                                     const WaitList& wait = {}) const;

    // flags [most] uchar -> the indices of those that are not 0, in order, in indices [most], and
    // how many they are in listed [1].
    cl::Event list(const cl::CommandQueue& queue, const Items& number, const cl::Buffer& flags,
                   const cl::Buffer& indices, const cl::Buffer& listed, const cl::Buffer& scratch,
                   const WaitList& wait = {}) const;

    // items [most] float -> result [1] ArgMax. A tie goes to the smaller index.
    cl::Event arg_max(const cl::CommandQueue& queue, const Items& number, const cl::Buffer& items,
                      const cl::Buffer& result, const cl::Buffer& scratch,
                      const WaitList& wait = {}) const;

    // items [most] float4 -> result [1] float4. Error: at most (24 + ceil(n / 2^24)) 2^-24 times
    // the sum of magnitudes.
    cl::Event sum(const cl::CommandQueue& queue, const Items& number, const cl::Buffer& items,
                  const cl::Buffer& result, const cl::Buffer& scratch,
                  const WaitList& wait = {}) const;

    // items [most] float4 -> result [1] ItemBounds.
    CLGI_EXPERIMENTAL cl::Event bounds(const cl::CommandQueue& queue, const Items& number,
                                       const cl::Buffer& items, const cl::Buffer& result,
                                       const cl::Buffer& scratch, const WaitList& wait = {}) const;

    // Keys in rising order of their lowest key_bits bits, 0 to 32; equal ones stay in order.
    // Higher bits go with the key and are not looked at.
    CLGI_EXPERIMENTAL cl::Event sort(const cl::CommandQueue& queue, const Items& number,
                                     std::uint32_t key_bits, const SortBuffers& buffers,
                                     const WaitList& wait = {}) const;

    // ---- passes, one method a kernel -----------------------------------------------------------

    // sums [count] uint become the sums of all before, in place; total [1], or
    // none: the sum of all.
    cl::Event offsets(const cl::CommandQueue& queue, std::uint32_t count, const cl::Buffer& sums,
                      const cl::Buffer& total, const WaitList& wait = {}) const;

    // sums, offsets, best, boxes: one for each tile of `most` items.
    cl::Event scan_sums(const cl::CommandQueue& queue, const Items& number, const cl::Buffer& items,
                        const cl::Buffer& sums, const WaitList& wait = {}) const;
    cl::Event scan_tiles(const cl::CommandQueue& queue, const Items& number,
                         const cl::Buffer& offsets, const cl::Buffer& items,
                         const cl::Buffer& before, const WaitList& wait = {}) const;
    cl::Event flag_sums(const cl::CommandQueue& queue, const Items& number, const cl::Buffer& flags,
                        const cl::Buffer& sums, const WaitList& wait = {}) const;
    cl::Event flag_list(const cl::CommandQueue& queue, const Items& number,
                        const cl::Buffer& offsets, const cl::Buffer& flags,
                        const cl::Buffer& indices, const WaitList& wait = {}) const;

    // picked [planes][out_stride] from planes [planes][stride], words of 32 bits:
    // picked[p][i] = planes[p][indices[i]] for the first *count of params.most.
    CLGI_EXPERIMENTAL cl::Event pick(const cl::CommandQueue& queue, const PickParams& params,
                                     const cl::Buffer& count, const cl::Buffer& indices,
                                     const cl::Buffer& planes, const cl::Buffer& picked,
                                     const WaitList& wait = {}) const;

    cl::Event arg_max_tiles(const cl::CommandQueue& queue, const Items& number,
                            const cl::Buffer& items, const cl::Buffer& best,
                            const WaitList& wait = {}) const;
    cl::Event arg_max_merge(const cl::CommandQueue& queue, std::uint32_t tiles,
                            const cl::Buffer& best, const cl::Buffer& result,
                            const WaitList& wait = {}) const;
    cl::Event sum_tiles(const cl::CommandQueue& queue, const Items& number, const cl::Buffer& items,
                        const cl::Buffer& sums, const WaitList& wait = {}) const;
    cl::Event sum_merge(const cl::CommandQueue& queue, std::uint32_t tiles, const cl::Buffer& sums,
                        const cl::Buffer& result, const WaitList& wait = {}) const;
    CLGI_EXPERIMENTAL cl::Event bounds_tiles(const cl::CommandQueue& queue, const Items& number,
                                             const cl::Buffer& items, const cl::Buffer& boxes,
                                             const WaitList& wait = {}) const;
    CLGI_EXPERIMENTAL cl::Event bounds_merge(const cl::CommandQueue& queue, std::uint32_t tiles,
                                             const cl::Buffer& boxes, const cl::Buffer& result,
                                             const WaitList& wait = {}) const;

    // counts [2^bits][tiles]; offsets: their prefix sum.
    CLGI_EXPERIMENTAL cl::Event digit_counts(const cl::CommandQueue& queue,
                                             const DigitParams& params, const cl::Buffer& count,
                                             const cl::Buffer& keys, const cl::Buffer& counts,
                                             const WaitList& wait = {}) const;
    CLGI_EXPERIMENTAL cl::Event digit_scatter(const cl::CommandQueue& queue,
                                              const DigitParams& params, const cl::Buffer& count,
                                              const cl::Buffer& offsets, const cl::Buffer& keys,
                                              const cl::Buffer& payload,
                                              const cl::Buffer& sorted_keys,
                                              const cl::Buffer& sorted_payload,
                                              const WaitList& wait = {}) const;

private:
    PassKernel offsets_, scan_sums_, scan_tiles_, flag_sums_, flag_list_, pick_;
    PassKernel arg_max_tiles_, arg_max_merge_, sum_tiles_, sum_merge_, bounds_tiles_, bounds_merge_;
    PassKernel digit_counts_, digit_scatter_;
    std::uint32_t digit_bits_ = DIGIT_BITS;  // what a sorting pass takes at a time
};

}  // namespace clgi
