// An element tree as the passes of the room take it: elements by level, sample points of leaves,
// and where leaves lie in their triangles and meet at vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/antiradiance.h>
#include <clgi/shared/gbuffer.h>
#include <clgi/advanced/direction_bins.hpp>
#include <clgi/advanced/elements.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/scene.hpp>
#include <vector>

namespace clgi {

struct ElementSurface {
    std::vector<Element> elements;
    std::vector<std::uint32_t> leaves;  // elements by row; those that face backwards come last
    std::uint32_t first_back = 0;       // row
    std::vector<std::uint32_t> inner;   // elements from the root's level down
    std::vector<std::uint32_t> level_begins;  // [levels + 1] in inner

    std::vector<SurfaceSample> samples;  // [leaves][leaf_samples]; of no triangle where a leaf is
                                         // the dark back of a one-sided triangle
    std::vector<PatchCorners> patches;   // [elements], then of triangles with leaves at vertices
    std::vector<TrianglePatches> roots;  // [triangles of the device]

    std::vector<std::uint32_t> first_leaves;  // [vertices + 1] in vertex_leaves
    std::vector<glm::uvec2> vertex_leaves;    // row, and the bits of its share of the vertex

    std::uint32_t vertices() const { return static_cast<std::uint32_t>(first_leaves.size() - 1); }
};

constexpr std::uint32_t leaf_samples =
    4;  // sample points of a leaf: the middles of its four quarters

ElementSurface make_element_surface(const ElementTree& tree, const DirectionBins& bins,
                                    const Scene& scene, const DeviceScene& device);

// Of rows in half storage: what they hold is about as large as radiance then, whatever the areas.
void set_row_exponents(std::vector<Element>& elements);

}  // namespace clgi
