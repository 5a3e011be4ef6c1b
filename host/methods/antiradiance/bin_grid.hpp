// The bin nearest to a direction, by looking at those few that are near some of its neighbours.
// [derived]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/direction_bins.hpp>
#include <cstdint>
#include <span>
#include <vector>

namespace clgi {

// Squares on three faces of a cube; a direction of the other faces is turned round, as bins come in
// opposite pairs.
class BinGrid {
public:
    // bins must outlive this object. farthest: cosine, above 0, with what is around a direction.
    BinGrid(const DirectionBins& bins, double farthest);

    // The same bin as DirectionBins::nearest; of a unit direction.
    int nearest(const glm::dvec3& direction) const;

    // Of all bins within `farthest` of the direction each is there or its opposite: bins of the
    // first half, ascending.
    std::span<const std::uint16_t> around(const glm::dvec3& direction) const {
        return around_.of(square_of(direction));
    }

private:
    struct Lists {
        std::vector<std::uint32_t> first{0};  // [squares + 1]
        std::vector<std::uint16_t> bins;
        std::span<const std::uint16_t> of(std::size_t square) const {
            return {bins.data() + first[square], bins.data() + first[square + 1]};
        }
    };

    std::size_t square_of(const glm::dvec3& direction) const;

    const DirectionBins& bins_;
    const int side_;          // squares along each side of a face
    Lists nearest_, around_;  // that may be nearest to, or around, a direction of each square
};

}  // namespace clgi
