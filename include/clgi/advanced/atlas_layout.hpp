// Where a light atlas has its texels: on which triangle, how much of it, in which chart.
//
// [Schaerfig16, section 4] fills an atlas and does not say how it is made. Here its charts are
// those of the scene's texture coordinates, or regions of triangles that are laid flat and packed.
// Texel (column, row) of a page covers the square from (column, row) to (column + 1, row + 1);
// row 0 lies at v = 0 and column 0 at u = 0. Samplers must clamp to the edge.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

namespace clgi {

enum class AtlasUvs {
    automatic,  // UV set 1 if it serves as a lightmap, else charts
    set_0,      // this set, or an InputError
    set_1,
    charts,  // whatever the texture coordinates are
};

struct AtlasOptions {
    int size = 512;  // texels, side of a page; 1 to 8192
    // Where charts do not fit, the size of pages is doubled as long as it is at most this. Below
    // twice `size`, such as 0: it is not. At most 8192.
    int largest_size = 0;
    AtlasUvs uvs = AtlasUvs::automatic;
    int padding = 2;                // texels around a chart that are empty; 1 to 64. None is kept
                                    // free beyond the edge of a page, nor in a UV set
    double texels_per_metre = 0.0;  // of charts; 0: what fills the pages
    int most_pages = 1;             // for charts; 1 to 64, and fewer than 2^32 texels,
                                    // at the largest size that pages may be doubled to
};

// A texel that the surface covers, entirely or in part. Of several charts in a texel, which only a
// UV set can have, the one at its centre counts, else the one with the largest share.
struct AtlasTexel {
    std::uint32_t texel;     // (page * size + row) * size + column
    std::uint32_t triangle;  // of the scene: the one at the centre, else the one that covers most
    float b1, b2;    // weights of its second and third corner: at the texel's centre, else at the
                     // centroid of the triangle's part of the texel. b1, b2 >= 0, b1 + b2 <= 1
    float coverage;  // (0,1] share of the texel's square that the chart covers
    float area;      // m^2 of the chart's surface that lie in the texel
    std::uint32_t chart;  // index into AtlasLayout::charts
    bool centre;          // whether the chart covers the texel's centre
};

// The smallest box of whole texels around a chart.
struct AtlasChart {
    int page, column, row;  // of its first texel
    int width, height;      // texels
    std::uint32_t region;   // triangle_chart of its triangles; 0xffffffff for those of a UV set
};

// An empty texel that interpolation reads, and the listed texel that is nearest to it.
struct AtlasDilated {
    std::uint32_t texel;   // as AtlasTexel::texel
    std::uint32_t source;  // index into AtlasLayout::texels
};

struct AtlasLayout {
    int size = 0;                       // texels, side of a page
    int pages = 0;                      // in use
    std::vector<AtlasTexel> texels;     // by rising AtlasTexel::texel, none twice
    std::vector<AtlasDilated> dilated;  // the same; within `padding` texels, diagonals included
    std::vector<glm::vec2> uvs;  // [3 * triangles] corner k of triangle t at 3 t + k, in texels of
                                 // its page; (0, 0) if it is in no chart
    std::vector<std::uint32_t> triangle_page;   // [triangles] 0xffffffff: in no chart
    std::vector<std::uint32_t> triangle_chart;  // [triangles] the same
    std::vector<AtlasChart> charts;
    int uv_set = -1;                    // that was taken; -1: charts were made
    double texels_per_metre = 0.0;      // of charts; of a UV set the mean over its area
    double skipped_area = 0.0;          // m^2 that no listed texel has: with the sum of
                                        // AtlasTexel::area this is the area of the scene
    std::vector<std::string> warnings;  // one line each
};

// region_of: [triangles] the region that each belongs to, connected and about flat; 0xffffffff
// leaves the triangle out. Only charts need it. A region is laid onto the plane of its mean normal;
// triangles that would lose more than half of their area by that, or lie on others, get charts of
// their own. No two charts share a texel, or a texel that bilinear interpolation reads. Triangles
// without area are left out.
//
// Deterministic. Throws Error for options out of range and a region_of of another length,
// InputError for scenes that are not valid or without a triangle that has an area, for a UV set
// that does not serve, and for charts that do not fit.
CLGI_API AtlasLayout make_atlas(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                                const AtlasOptions& options = {});

// The layout of a scene of `count` triangles of which triangles[t] is triangle t of a layout's
// scene; the others are in no chart. Throws Error for another number of triangles, and one that
// is not below `count`.
CLGI_API AtlasLayout atlas_of_whole(const AtlasLayout& part,
                                    const std::vector<std::uint32_t>& triangles, std::size_t count);

enum class AtlasPages {
    stacked,  // one unit square with the pages below each other
    each,     // a unit square each
};

// The scene with the atlas's coordinates as UV set 1. Vertices are those that differ in anything.
// Materials that read UV set 1 read the atlas's then. Throws Error for a layout of another scene.
CLGI_API Scene with_atlas_uvs(const Scene& scene, const AtlasLayout& atlas,
                              AtlasPages pages = AtlasPages::stacked);

}  // namespace clgi
