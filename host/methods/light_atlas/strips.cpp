// SPDX-License-Identifier: MIT
#include "methods/light_atlas/strips.hpp"

#include <algorithm>

namespace clgi {
namespace {

constexpr double least_aspect = 4.0, longest_cell = 10.0;
constexpr double most_extra = 0.25;  // of all VPLs

}  // namespace

void raise_density(std::vector<Region>& regions, const std::vector<double>& extents,
                   double vpl_area, double most) {
    double even = 0.0, extra = 0.0;
    for (std::size_t r = 0; r < regions.size(); ++r) {
        Region& region = regions[r];
        const double width = region.area / extents[r];
        const bool narrow = extents[r] >= least_aspect * width;
        region.density = narrow ? std::max(1.0, std::min(most, vpl_area / (width * width))) : 1.0;
        const double area = (region.double_sided ? 2.0 : 1.0) * region.area;
        even += area;
        extra += area * (region.density - 1.0);
    }
    const double room = most_extra / (1.0 - most_extra) * even;
    if (!(extra > room)) return;
    for (Region& region : regions) region.density = 1.0 + room / extra * (region.density - 1.0);
}

glm::dvec3 stretch_of(const glm::dvec3& size) {
    glm::dvec3 out(1.0);
    const int across = size.x < size.y ? 0 : 1;
    if (size[across] > 0.0) out[across] = std::min(longest_cell, size[1 - across] / size[across]);
    return out;
}

}  // namespace clgi
