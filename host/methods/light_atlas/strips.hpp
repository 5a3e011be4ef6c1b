// Narrow regions: edges of doors and windows, reveals, frames. Light passes through the gaps
// between them, and changes over their width, which may be far less than the distance of VPLs.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "methods/light_atlas/regions.hpp"

namespace clgi {

// extents: [regions] metres along the longest side of each. vpl_area: m^2, of a VPL where all
// regions are served alike. Sets Region::density:
//
//   min(most, vpl_area / width^2), at least 1,   width = area / extent
//
// for regions at least four times as long as wide, and 1 for others. Where narrow regions would
// take more than a quarter of all VPLs in addition to their share, what is above 1 is scaled down
// to that.
void raise_density(std::vector<Region>& regions, const std::vector<double>& extents,
                   double vpl_area, double most);

// By how much a narrow region is to be stretched across, so that cells that are square afterwards
// are up to ten times as long as wide on it: light varies across it, along it hardly. size: metres
// in its frame. 1 along the other axes, and never more than makes it square.
glm::dvec3 stretch_of(const glm::dvec3& size);

}  // namespace clgi
