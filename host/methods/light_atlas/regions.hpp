// Patches merged into regions that are worth a VPL each, and how many VPLs each region gets.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/patches.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

struct Region {
    std::vector<std::uint32_t> patches;  // rising
    double area = 0.0;                   // m^2, one side
    glm::dvec3 normal{};                 // unit, mean weighted by area
    bool double_sided = false;
    double density = 1.0;    // of VPLs, relative to other regions
    std::uint32_t vpls = 1;  // on either side
};

// Regions by their first patch. count: VPLs wanted on all sides together, at least 1.
//
// 1. Patches smaller than half a VPL's area join the neighbour that faces most nearly as they do,
//    within normal cones of 45 degrees.
// 2. Regions smaller than a VPL's area take more than their share. While this excess is more than
//    a quarter of all VPLs, or there are more regions than VPLs, the smallest ones join neighbours
//    within cones of 90 degrees.
// 3. What still has no neighbour to join is clustered by direction and place.
//
// VPLs are then shared out by area (Sainte-Lague), at least one a region.
std::vector<Region> make_regions(const Patches& patches, std::uint32_t count);

// The last step alone, by area times density.
void share_out(std::vector<Region>& regions, std::uint32_t count);

}  // namespace clgi
