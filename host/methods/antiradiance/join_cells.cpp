// SPDX-License-Identifier: MIT
#include "methods/antiradiance/join_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/disjoint_sets.hpp"

namespace clgi {
namespace {

constexpr int cell_rounds = 16;
constexpr double one_way = 0.9;  // least vector area of joined cells, of their area
constexpr double round = 8.0;    // largest square of the diagonal of their box, of the allowed area

struct Cell {
    double area = 0.0;
    glm::dvec3 vector_area{0.0};
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{-low};

    void add(const Cell& other) {
        area += other.area;
        vector_area += other.vector_area;
        low = glm::min(low, other.low);
        high = glm::max(high, other.high);
    }
    bool fits(double allowed) const {
        const glm::dvec3 size = high - low;
        return area <= allowed && glm::length(vector_area) >= one_way * area &&
               glm::dot(size, size) <= round * allowed;
    }
};

}  // namespace

std::vector<std::uint32_t> join_cells(const std::vector<std::uint32_t>& cells,
                                      const std::vector<Face>& faces,
                                      const std::vector<std::uint32_t>& fronts, double max_area) {
    if (cells.empty() || !(max_area > 0.0)) return cells;
    std::vector<Cell> joined(*std::max_element(cells.begin(), cells.end()) + std::size_t{1});
    for (std::uint32_t t = 0; t < fronts.size(); ++t) {
        if (fronts[t] == no_index) continue;
        const Face& face = faces[fronts[t]];
        for (std::uint32_t k = 0; k < 3; ++k)
            joined[cells[3 * t + k]].add(
                {face.area / 3.0, face.area / 3.0 * face.normal, face.corners[k], face.corners[k]});
    }
    DisjointSets sets(joined.size());
    for (int r = cell_rounds; r-- > 0;)
        for (std::uint32_t t = 0; t < fronts.size(); ++t) {
            if (fronts[t] == no_index) continue;
            for (std::uint32_t side = 0; side < 3; ++side) {
                const std::uint32_t a = sets.find(cells[3 * t + side]);
                const std::uint32_t b = sets.find(cells[3 * t + (side + 1) % 3]);
                if (a == b) continue;
                Cell both = joined[a];
                both.add(joined[b]);
                if (!both.fits(std::ldexp(max_area, -r))) continue;
                sets.join(a, b);
                joined[sets.find(a)] = both;
            }
        }
    const std::vector<std::uint32_t> numbers = sets.numbered();
    std::vector<std::uint32_t> out;
    out.reserve(cells.size());
    for (const std::uint32_t cell : cells) out.push_back(numbers[cell]);
    return out;
}

}  // namespace clgi
