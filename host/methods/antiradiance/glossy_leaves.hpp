// Leaves whose surfaces have lobes, as the passes take them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>

#include "methods/antiradiance/element_surface.hpp"

namespace clgi {

struct GlossyLeaves {
    std::vector<GlossyLeaf> leaves;         // by row
    std::vector<std::uint32_t> others;      // elements of the other leaves, by row
    std::vector<float> albedos;             // [materials][ALBEDO_STEPS + 1]
    std::vector<std::uint32_t> rows;        // [vertices] of those below, ELEMENT_NONE: no lobe
    std::vector<std::uint32_t> first;       // [glossy vertices + 1] in vertex_leaves
    std::vector<glm::uvec2> vertex_leaves;  // glossy leaf, and the bits of its share of the vertex

    std::uint32_t count() const { return static_cast<std::uint32_t>(leaves.size()); }
    std::uint32_t vertices() const {
        return first.empty() ? 0 : static_cast<std::uint32_t>(first.size() - 1);
    }
};

// Those whose material's coat and lobe reflect more than `least`, of all light. The backs of
// one-sided triangles are not among them.
GlossyLeaves find_glossy_leaves(const ElementTree& tree, const ElementSurface& surface,
                                const Scene& scene, double least);

}  // namespace clgi
