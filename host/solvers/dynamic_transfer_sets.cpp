// Potentially visible sets of the receivers of a scene.              [Kautz04, section 3.2]
// SPDX-License-Identifier: MIT
#include "solvers/dynamic_transfer_state.hpp"

namespace clgi {

cl::Event DynamicTransferSolver::State::look(const WaitList& wait) {
    if (!seen()) {
        BufferTable t(transfer_owner);
        t.add(seen, "bits of visible sets", "the scene's vertices",
              visible_words(both.triangle_count) * receivers.stride * sizeof(std::uint32_t));
        if (!heights())
            t.add(heights, "heights of pixels", "mask size",
                  pixel_heights(options.masks.size).size() * sizeof(float));
        t.check(queue.getInfo<CL_QUEUE_DEVICE>(), 0, scene.bytes() + bytes);
        t.allocate(record);
        bytes += t.bytes();
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
    if (!seen()) throw Error("dynamic-transfer: sets before the first look");
    record.wait();
    std::vector<std::uint32_t> words(visible_words(both.triangle_count) * receivers.stride);
    queue.enqueueReadBuffer(seen, CL_TRUE, 0, words.size() * sizeof(words[0]), words.data());
    record.fill(seen, 0);
    return visible_sets(words, receivers.count, receivers.stride, both.triangle_count);
}

void DynamicTransferSolver::State::restrict(const VisibleSets& sets) {
    if (sets.near_lists.size() != std::size_t{receivers.count} + 1 ||
        sets.near_lists.back() != sets.near.size())
        throw Error("dynamic-transfer: the sets are of " + std::to_string(sets.near_lists.size()) +
                    " receivers less one, " + std::to_string(receivers.count) + " needed");
    for (const std::uint32_t triangle : sets.near)
        if (triangle >= blockers.triangle_count)
            throw Error("dynamic-transfer: the sets name triangle " + std::to_string(triangle) +
                        ", there are " + std::to_string(blockers.triangle_count));
    // Those of the hierarchy stay: look() goes on with them.
    blockers.lists = blockers.ranges = blockers.near_lists = blockers.near = cl::Buffer();
    blockers.receivers_per_list = ~0u;
    BufferTable t(transfer_owner);
    t.add_word(blockers.lists, "lists of clusters", 0);
    t.add_word(blockers.ranges, "lists of clusters", 0);
    t.add(blockers.near_lists, "lists of singles", "the scene's vertices",
          sets.near_lists.size() * sizeof(std::uint32_t));
    t.add(blockers.near, "lists of singles", "the scene's vertices",
          sets.near.size() * sizeof(std::uint32_t));
    t.check(queue.getInfo<CL_QUEUE_DEVICE>(), 0, scene.bytes() + bytes);
    t.allocate(record);
    put(blockers.near_lists, sets.near_lists);
    put(blockers.near, sets.near);
    masks.build({"mask_near"});
    listed_triangles = sets.near.size();
}

}  // namespace clgi
