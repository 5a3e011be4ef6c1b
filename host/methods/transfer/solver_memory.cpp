// What the dynamic transfer solver needs in memory and time: options in range, and the table of
// buffers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>

#include "core/kit/ranges.hpp"
#include "core/opencl/check.hpp"
#include "core/opencl/word.hpp"
#include "methods/transfer/solver_state.hpp"

namespace clgi {
namespace {

const DynamicTransferOptions& checked(const DynamicTransferOptions& options) {
    need_range(transfer_owner, "interreflections", options.interreflections, 0, 1);
    mask_table_bytes(options.masks);  // throws for masks out of range
    if (!occludes(options.occlusion) && options.interreflections > 0)
        throw Error(
            "dynamic-transfer: occlusion is none and interreflections is 1, 0 needed: what "
            "receivers see of "
            "the scene is found with their masks");
    return options;
}

std::size_t mask_cells(const MaskOptions& masks) {
    const auto side = static_cast<std::size_t>(masks.size / masks.block);
    return side * side;
}

}  // namespace

TransferBuffers::TransferBuffers(const Scene& file, const DeviceScene& of,
                                 const DynamicTransferOptions& wanted)
    : scene(of),
      options(checked(wanted)),
      glossy(wanted.gloss && of.has_lobes()),
      vertices(file, of),
      levels(occludes(wanted.occlusion)
                 ? blocker_levels(file, of, wanted.coarse, wanted.rings, wanted.memory_budget)
                 : BlockerLevels()),
      sky(scene, wanted.masks.bands, wanted.directional) {
    if (occludes(options.occlusion)) vertices.add_other_sides(levels);
    receivers.count = vertices.count();
    receivers.stride = plane_stride(receivers.count);
    both.triangle_count = static_cast<std::uint32_t>(levels.triangles.size());
    both.stride = blocker_stride(both.triangle_count);
    both.receivers_per_list = levels.receivers_per_list;
    const bool shared = levels.receivers_per_list != 1;
    for (std::size_t i = 1; i < levels.ranges.size(); i += 2)
        listed_triangles +=
            std::size_t{levels.ranges[i]} * BLOCKER_CLUSTER * (shared ? receivers.count : 1);
    listed_triangles += levels.near.size();
}

// What masks of receivers are made of, and what they become.
void TransferBuffers::add_shadows(BufferTable& t) {
    const char* triangle = "the scene's triangles";
    const std::size_t stride = receivers.stride;
    const auto terms = static_cast<std::size_t>(sh::terms(options.masks.bands));
    t.add(receivers.masks, "masks", "mask size",
          static_cast<std::size_t>(MASK_WORDS(options.masks.size)) * stride * word);
    t.add(receivers.transfer, "transfer vectors", "bands", terms * stride * word);
    t.add(triangles, "triangles that block", triangle,
          levels.triangles.size() * sizeof(glm::uvec4));
    t.add(both.corners, "blockers", triangle, BLOCKER_PLANES * word * both.stride);
    t.add(both.boxes, "boxes of blockers", triangle,
          both.stride / BLOCKER_CLUSTER * sizeof(BlockerBox));
    t.add(both.lists, "lists of clusters", triangle, levels.lists.size() * word);
    t.add(both.ranges, "lists of clusters", triangle, levels.ranges.size() * word);
    t.add(fine.lists, "lists of clusters", triangle, 2 * word);
    t.add(fine.ranges, "lists of clusters", triangle, 2 * word);
    if (!levels.near.empty()) {
        t.add(both.near_lists, "lists of singles", triangle, levels.near_lists.size() * word);
        t.add(both.near, "lists of singles", triangle, levels.near.size() * word);
    }
    if (options.interreflections > 0) {
        t.add(reflectance, "reflectances", "the scene's vertices", 3 * stride * word);
        t.add(exitance, "light of triangles", triangle,
              2 * levels.triangles.size() * sizeof(glm::vec4));
        t.add(heights, "heights of pixels", "mask size",
              pixel_heights(options.masks.size).size() * word);
    }
    t.add(drawn, "the table of planes", "table size", mask_table_bytes(options.masks));
}

BufferTable TransferBuffers::table() {
    const char* vertex = "the scene's vertices";
    const std::size_t stride = receivers.stride;
    const auto terms = static_cast<std::size_t>(sh::terms(options.masks.bands));
    const auto turns = static_cast<std::size_t>(2 * options.masks.bands - 1);
    BufferTable t(transfer_owner);
    t.add(receivers.planes, "receivers", vertex, RECEIVER_PLANES * stride * word);
    t.add(irradiance, "irradiance", vertex, 3 * stride * word);
    t.add(other_side, "other sides", vertex, vertices.other_side.size() * word);
    t.add(fronts, "other sides", vertex, vertices.fronts.size() * word);
    if (glossy) {
        t.add(lobes, "transfer vectors of lobes", "bands", terms * stride * word);
        t.add(gloss, "gloss", vertex, 3 * stride * word);
        t.add(exponents, "exponents of lobes", vertex, stride * word);
    }
    if (occludes(options.occlusion)) add_shadows(t);
    if (integrates()) {
        t.add(weights, "weights of cells", "bands", (mask_cells(options.masks) + 1) * terms * word);
        t.add(directions, "directions of cells", "mask size",
              (mask_cells(options.masks) + turns) * sizeof(glm::vec4));
    }
    t.add(status, "counters", "nothing", MASK_STATUS_WORDS * word);
    t.add_word(bad, "counters", 0);
    sky.add_to(t);
    return t;
}

Estimate estimate(const cl::Device& device, const Scene& scene, const DeviceScene& device_scene,
                  const DynamicTransferOptions& options) {
    DynamicTransferOptions without_budget = options;
    without_budget.memory_budget = 0;  // an estimate tells what a budget would refuse
    TransferBuffers buffers(scene, device_scene, without_budget);
    Estimate out;
    out.bytes = buffers.table().bytes();

    // In pairs of a point and a light, as measured on a CPU with packets of 16: a triangle that a
    // mask looks at is worth 10 of them, as most are culled with their cluster; a term of a cell 2.
    const double masks = 10.0 * static_cast<double>(buffers.listed_triangles);
    const double integrals =
        (occludes(options.occlusion) ? 1.0 : 0.0) + (buffers.glossy ? 1.0 : 0.0);
    const double cells =
        static_cast<double>(mask_cells(options.masks)) * sh::terms(options.masks.bands) * integrals;
    const double pairs =
        masks * (1 + options.interreflections) + 2.0 * (cells + sh::terms(options.masks.bands)) *
                                                     static_cast<double>(buffers.receivers.count);
    out.milliseconds = 1e3 * pairs / pairs_per_second(device);
    return out;
}

}  // namespace clgi
