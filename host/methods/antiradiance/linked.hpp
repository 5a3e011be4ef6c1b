// What passes over elements take and check alike.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/passes/antiradiance.hpp>

#include "core/opencl/launch.hpp"

namespace clgi {

// LINK_ARGUMENTS of kernels/antiradiance/rows.clh.
struct Linked {
    const LinkBuffers& links;
    const ElementRows& rows;
};
inline void set_argument(cl::Kernel& kernel, cl_uint& index, const Linked& from) {
    const LinkBuffers& l = from.links;
    for (const cl::Buffer* buffer :
         {&l.elements, &l.first_links, &l.senders, &l.bins, &l.form_factors, &from.rows.sky,
          &from.rows.powers, &from.rows.exitant})
        kernel.setArg(index++, *buffer);
}

// LEAF_ARGUMENTS of kernels/antiradiance/leaf.clh.
struct Lit {
    const LeafBuffers& leaves;
};
inline void set_argument(cl::Kernel& kernel, cl_uint& index, const Lit& from) {
    const LeafBuffers& l = from.leaves;
    for (const cl::Buffer* buffer :
         {&l.sources, &l.reflectances, &l.radiances, &l.irradiances, &l.changes, &l.non_finite})
        kernel.setArg(index++, *buffer);
}

inline void need_bins(int bins) {
    if (bins < 32 || bins > 4096 || bins % 4 != 0)
        throw Error("antiradiance: bins is " + std::to_string(bins) +
                    ", a multiple of 4 from 32 to 4096 needed");
}

inline void need_linked(const PassKernel& pass, int bins, const LinkBuffers& l,
                        const ElementRows& rows) {
    const auto row = static_cast<std::size_t>(bins) * sizeof(glm::vec4);
    const std::size_t count = std::max<std::size_t>(l.link_count, 1);
    need(pass, "first_links", l.first_links,
         (2 * std::size_t{l.element_count} + 1) * sizeof(std::uint32_t));
    need(pass, "senders", l.senders, count * sizeof(std::uint32_t));
    need(pass, "bins", l.bins, count * sizeof(std::uint16_t));
    need(pass, "form_factors", l.form_factors, count * sizeof(float));
    need(pass, "sky", rows.sky, row);
    need(pass, "powers", rows.powers, l.element_count * sizeof(glm::vec4));
    need(pass, "incident", rows.incident, std::max<std::size_t>(l.inner_count, 1) * row);
}

// Of so many rows.
inline std::size_t bytes_of_rows(Storage storage, int bins, std::size_t rows) {
    return rows * static_cast<std::size_t>(bins) *
           (storage == Storage::half ? sizeof(glm::vec4) / 2 : sizeof(glm::vec4));
}

inline std::size_t gloss_row_bytes(int bins) {
    return 3 * static_cast<std::size_t>(GLOSS_STRIDE(bins)) * sizeof(float);
}

// Of the passes that work on leaves.
inline void need_leaves(const PassKernel& pass, int bins, const LinkBuffers& links,
                        const ElementRows& rows, const cl::Buffer& directions,
                        const LeafBuffers& leaves) {
    const std::size_t color = sizeof(glm::vec4);
    need(pass, "exitant", rows.exitant, bytes_of_rows(pass.storage, bins, links.row_count));
    need(pass, "next", rows.next, bytes_of_rows(pass.storage, bins, links.row_count));
    need(pass, "next_powers", rows.next_powers, links.element_count * color);
    need(pass, "directions", directions, static_cast<std::size_t>(bins) * color);
    need(pass, "sources", leaves.sources, links.leaf_count * color);
    need(pass, "reflectances", leaves.reflectances, links.leaf_count * color);
    need(pass, "radiances", leaves.radiances, links.leaf_count * color);
    need(pass, "irradiances", leaves.irradiances, links.leaf_count * color);
    need(pass, "changes", leaves.changes, links.leaf_count * color);
    need(pass, "non_finite", leaves.non_finite, sizeof(std::uint32_t));
}

// Of the passes that find leaves at pixels.
inline void need_shown(const PassKernel& pass, std::uint32_t triangles, std::uint32_t elements,
                       const DeviceScene& scene, const LinkBuffers& links,
                       const LeafSurface& surface) {
    if (elements > links.element_count || links.element_count > surface.patch_count)
        throw Error(pass.name + ": element_count is " + std::to_string(elements) + ", there are " +
                    std::to_string(links.element_count) + " elements and " +
                    std::to_string(surface.patch_count) + " patches");
    if (triangles > scene.info().triangle_count)
        throw Error(pass.name + ": triangle_count is " + std::to_string(triangles) +
                    ", the scene has " + std::to_string(scene.info().triangle_count));
    need(pass, "roots", surface.roots, triangles * sizeof(TrianglePatches));
    need(pass, "elements", links.elements, links.element_count * sizeof(Element));
    need(pass, "patches", surface.patches, surface.patch_count * sizeof(PatchCorners));
}

}  // namespace clgi
