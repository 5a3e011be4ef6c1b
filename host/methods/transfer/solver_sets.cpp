// Potentially visible sets of the receivers of a scene.              [Kautz04, section 3.2]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>
#include <string>

#include "core/opencl/planes.hpp"
#include "methods/transfer/solver_state.hpp"

namespace clgi {
namespace {

void check(const VisibleSets& sets, std::uint32_t receivers, std::uint32_t triangles) {
    const std::vector<std::uint32_t>& lists = sets.near_lists;
    const std::string what = std::string(transfer_owner) + ": the sets ";
    if (lists.size() != std::size_t{receivers} + 1)
        throw Error(what + "are of " + std::to_string(lists.size()) + " receivers less one, " +
                    std::to_string(receivers) + " needed");
    if (lists.front() != 0 || lists.back() != sets.near.size())
        throw Error(what + "begin at " + std::to_string(lists.front()) + " and end at " +
                    std::to_string(lists.back()) + ", 0 and " + std::to_string(sets.near.size()) +
                    " needed");
    const auto falls = std::adjacent_find(lists.begin(), lists.end(), std::greater<>());
    if (falls != lists.end())
        throw Error(what + "of receiver " + std::to_string(falls - lists.begin()) +
                    " end before they begin");
    for (const std::uint32_t triangle : sets.near)
        if (triangle >= triangles)
            throw Error(what + "name triangle " + std::to_string(triangle) + ", there are " +
                        std::to_string(triangles));
}

// Visible sets say what blocks.
void need_shadows(const DynamicTransferOptions& options, const char* call) {
    if (!occludes(options.occlusion))
        throw Error(std::string(transfer_owner) + ": " + call +
                    " of a solver without shadows, DynamicTransferOptions::occlusion needed");
}

}  // namespace

void DynamicTransferSolver::State::allocate_more(const BufferTable& more) {
    // 0 would be no budget.
    const std::size_t left = options.memory_budget - std::min(bytes, options.memory_budget);
    more.check(queue.getInfo<CL_QUEUE_DEVICE>(),
               options.memory_budget > 0 ? std::max<std::size_t>(left, 1) : 0,
               scene.bytes() + bytes);
    more.allocate(record);
    bytes += more.bytes();
}

cl::Event DynamicTransferSolver::State::look(const WaitList& wait) {
    need_shadows(options, "look()");
    if (!seen()) {
        need_countable(transfer_owner, "bits of visible sets", visible_words(both.triangle_count),
                       receivers.stride);
        BufferTable t(transfer_owner);
        t.add(seen, "bits of visible sets", "the scene's vertices",
              visible_words(both.triangle_count) * receivers.stride * sizeof(std::uint32_t));
        if (!heights())
            t.add(heights, "heights of pixels", "mask size",
                  pixel_heights(options.masks.size).size() * sizeof(float));
        allocate_more(t);
        put(heights, pixel_heights(options.masks.size));
        record.fill(seen, 0);
        masks.build({"visible"});
    }
    record.begin(wait);
    place_receivers();
    record("transfer.visible", receivers.count, [&](const WaitList& before) {
        return masks.visible(queue, receivers, both, heights, seen, before);
    });
    return record.last();
}

VisibleSets DynamicTransferSolver::State::sets() {
    need_shadows(options, "sets()");
    if (!seen()) throw Error("dynamic-transfer: sets before the first look");
    record.wait();
    std::vector<std::uint32_t> words(visible_words(both.triangle_count) * receivers.stride);
    queue.enqueueReadBuffer(seen, CL_TRUE, 0, words.size() * sizeof(words[0]), words.data());
    record.fill(seen, 0);
    return visible_sets(words, receivers.count, receivers.stride, both.triangle_count);
}

void DynamicTransferSolver::State::restrict(const VisibleSets& sets) {
    need_shadows(options, "restrict()");
    check(sets, receivers.count, both.triangle_count);
    // Those of the hierarchy stay: look() goes on with them. Those of before stay until all that
    // may fail is done.
    BlockerBuffers made = blockers;
    made.lists = made.ranges = made.near_lists = made.near = cl::Buffer();
    made.receivers_per_list = ~0u;
    BufferTable t(transfer_owner);
    t.add_word(made.lists, "lists of clusters", 0);
    t.add_word(made.ranges, "lists of clusters", 0);
    t.add(made.near_lists, "lists of singles", "the scene's vertices",
          sets.near_lists.size() * sizeof(std::uint32_t));
    t.add(made.near, "lists of singles", "the scene's vertices",
          sets.near.size() * sizeof(std::uint32_t));
    masks.build({"mask_near"});
    if (options.interreflections > 0) masks.build({"bounce_near"});
    allocate_more(t);
    try {
        put(made.near_lists, sets.near_lists);
        put(made.near, sets.near);
    } catch (...) {
        bytes -= t.bytes();
        throw;
    }
    blockers = made;
    bytes -= bytes_of_sets;
    bytes_of_sets = t.bytes();
    listed_triangles = sets.near.size();
}

}  // namespace clgi
