// What AntiradianceSolver allocates, and what its size follows from. Without links, kernels and
// queue.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/emitters.hpp>
#include <clgi/antiradiance.hpp>
#include <vector>

#include "methods/antiradiance/element_surface.hpp"
#include "methods/antiradiance/glossy_leaves.hpp"

namespace clgi {

inline constexpr const char* antiradiance_owner = "antiradiance";

struct AntiradianceBuffers {
    // Throws Error for options out of range and scenes without surfaces.
    AntiradianceBuffers(const Scene& file, const DeviceScene& of,
                        const AntiradianceOptions& wanted);

    // The elements in each of the poses; none where nothing moves.
    std::vector<ElementTree> posed(const Scene& file) const;

    // Without what is for geometry that moves. row_count: of exitant intensity.
    BufferTable table(std::size_t link_count, std::uint32_t row_count);
    void add_gloss(BufferTable& table);

    const DeviceScene& scene;
    SceneFrame frame;  // that elements and links are made for
    AntiradianceOptions options;
    double linking = 0.0;  // seconds
    DirectionBins bins;
    ElementTree tree;
    ElementSurface made;  // on the host
    GlossyLeaves glossy;
    Emitters emitters;
    LinkBuffers links;
    ElementRows rows;
    LeafBuffers leaves;
    LeafSurface surface;
    GlossBuffers gloss;
    RasterBuffers lists;
    LeafPointParams point_params{};
    GBuffer points;
    cl::Buffer samples, irradiance, directions, leaf_list, inner_list, sum, scratch, bad_points;
};

}  // namespace clgi
