// How light from a leaf that is larger than a bin is spread over the bins around the one that its
// middle is seen in. [Dachsbacher07, section 3.1]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/direction_bins.hpp>
#include <vector>

namespace clgi {

struct SpreadShare {
    int bin;
    double weight;
};

// For each bin, and for cones of 1, 2, 4 ... bins up to half of the sphere: the bins whose middle
// lies in the cone around that of the bin. Weights are solid angle times a Gaussian of the angle,
// whose deviation is sqrt(4 pi / m); they sum to 1.
class SpreadTable {
public:
    explicit SpreadTable(const DirectionBins& bins);

    // solid_angle: sr, of the leaf. The smallest cone that holds it; the bin itself alone for what
    // is no larger than a bin.
    const std::vector<SpreadShare>& row(int bin, double solid_angle) const;

private:
    double mean_;                                              // sr, of a bin
    std::vector<std::vector<std::vector<SpreadShare>>> rows_;  // [cones][bins]
};

}  // namespace clgi
