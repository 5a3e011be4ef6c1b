// Where the triangles of a scene lie in an atlas, before its texels are known.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/atlas_layout.hpp>
#include <glm/glm.hpp>
#include <vector>

#include "scene/lightmap_uvs.hpp"

namespace clgi {

constexpr std::uint32_t no_chart = 0xffffffffu;

struct AtlasPlacement {
    std::vector<glm::dvec2> corners;            // [3 * triangles] in the unit square of the page
    std::vector<std::uint32_t> triangle_chart;  // [triangles] or no_chart
    std::vector<AtlasChart> charts;
    int pages = 1;
    double texels_per_metre = 0.0;
};

// Twice the area of a triangle along its normal, m^2; zero if its corners lie on a line.
glm::dvec3 doubled_area_of(const Scene& scene, std::uint32_t triangle);

// with_atlas_uvs with a vertex for every corner, corner k of triangle t at 3 t + k.
Scene with_corner_uvs(const Scene& scene, const AtlasLayout& atlas, AtlasPages pages);

// Charts are what edges connect that agree in position and texture coordinates. Their boxes are
// those of their corners.
AtlasPlacement place_by_uvs(const Scene& scene, int uv_set, int size);

// Charts made of regions. mesh: adjacency(scene), or null: it is found where it is needed. Throws
// InputError if they do not fit.
AtlasPlacement place_by_regions(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                                const Adjacency* mesh, const AtlasOptions& options);

// make_atlas with this mesh.
AtlasLayout make_atlas(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                       const Adjacency* mesh, const AtlasOptions& options);

// Throws InputError where the texels of all pages, or one more, are not counted in 32 bits.
void need_countable_texels(const char* name, int size, int pages);

// Texels, dilated, uvs, triangle_page, triangle_chart, charts and skipped_area of a layout whose
// size is set.
void list_texels(const Scene& scene, const AtlasPlacement& placed, AtlasLayout& layout);
void list_dilated(int padding, AtlasLayout& layout);

}  // namespace clgi
