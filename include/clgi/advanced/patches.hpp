// A scene cut into almost planar patches, on which methods place their lights. [Schaerfig16, 3.1]
//
// A patch grows from the largest triangle that is in none yet, over edges that two triangles share
// and are wound alike along, as long as the next triangle faces nearly as the first one does and
// lies near its plane. The same scene gives the same patches in every run.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

struct PatchOptions {
    float max_angle = 0.3f;    // radians between the normals of a triangle and of the first one;
                               // 0 to 1.57. What rounding does to a thin triangle comes on top.
    float max_offset = 0.02f;  // of a corner from the first one's plane, as a share of the scene's
                               // radius (half the diagonal of its box); at least 0
};

struct Patch {
    double area = 0.0;        // m^2, one side
    glm::dvec3 normal{};      // unit, mean weighted by area
    glm::dvec3 centre{};      // metres, mean weighted by area; with `normal`: the patch's plane
    double spread = 0.0;      // radians, the largest angle between `normal` and a triangle's
    std::uint32_t first = 0;  // in Patches::triangles
    std::uint32_t count = 0;
    bool double_sided = false;  // all triangles of a patch are, or none is
};

struct Patches {
    std::vector<std::uint32_t> triangle_patch;  // [scene triangles]; no_index where skipped
    std::vector<Patch> patches;                 // by the area of their first triangle
    std::vector<std::uint32_t> triangles;       // of the scene, grouped by patch

    // [scene triangles][side] the triangle across; no_index at borders, where more than two meet,
    // where two are wound against each other, and for skipped triangles.
    std::vector<std::array<std::uint32_t, 3>> neighbours;

    double area = 0.0;  // m^2 of all patches, one side

    // Triangles without a normal that floats could tell (no higher than the two spacings within
    // which vertices are welded), and copies of earlier triangles: the same corners, wound alike or
    // both double-sided. They reflect nothing.
    std::uint32_t skipped_triangles = 0;
    double skipped_area = 0.0;  // m^2
};

// Throws InputError for vertices and materials that do not exist and for positions that are not
// finite, Error for an option out of range.
CLGI_API Patches make_patches(const Scene& scene, const PatchOptions& options = {});

}  // namespace clgi
