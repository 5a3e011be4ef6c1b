// Bins of directions, evenly spread over the sphere [Dachsbacher07, section 3.1].
//
// A bin is all directions that are nearer to its own than to that of any other bin. Bins come in
// opposite pairs, so light that goes on behind a surface stays in its bin, and a hemisphere about
// any normal has as many bins as the one below it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

struct DirectionBins {
    std::vector<glm::dvec3> directions;  // [count()] unit; the second half is minus the first
    std::vector<double> solid_angles;    // [count()] sr, exact; within 15 % of 4 pi / count()

    int count() const { return static_cast<int>(directions.size()); }
    int opposite(int bin) const { return (bin + count() / 2) % count(); }

    // The bin that a direction, of any length above 0, lies in; on a border the first such.
    CLGI_API int nearest(const glm::dvec3& direction) const;

    // pi / sum over bins of omega max(0, n.w), n a unit normal: what makes the cosines of a surface
    // reflect exactly what arrives. Within 0.01 of 1 from 128 bins on.
    CLGI_API double hemisphere_scale(const glm::dvec3& normal) const;
};

// count: even, 32 to 4096; the paper has 128 to 1024. The same bins in every run.
// Throws Error for other counts.
CLGI_API DirectionBins direction_bins(int count);

}  // namespace clgi
