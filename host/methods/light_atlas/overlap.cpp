// A grid of about as many cells as triangles finds the pairs, separating axes decide.
// SPDX-License-Identifier: MIT
#include "methods/light_atlas/overlap.hpp"

#include <algorithm>
#include <cmath>

namespace clgi {
namespace {

// Whether b lies beyond one of the edges of a.
bool separated(const glm::dvec2* a, const glm::dvec2* b, double slack) {
    for (int k = 0; k < 3; ++k) {
        const glm::dvec2 along = a[(k + 1) % 3] - a[k];
        const double length = glm::length(along);
        double deepest = -1e300;
        for (int i = 0; i < 3; ++i) {
            const glm::dvec2 to = b[i] - a[k];
            deepest = std::max(deepest, along.x * to.y - along.y * to.x);
        }
        if (deepest <= slack * length) return true;
    }
    return false;
}

// The range of x that an edge has between two heights, added to `range`.
void add_range(glm::dvec2 a, glm::dvec2 b, double low, double high, glm::dvec2& range) {
    if (a.y > b.y) std::swap(a, b);
    if (b.y < low || a.y > high) return;
    const auto at = [&](double y) {
        return y <= a.y ? a.x : y >= b.y ? b.x : glm::mix(a.x, b.x, (y - a.y) / (b.y - a.y));
    };
    for (const double x : {at(low), at(high)}) range = {std::min(range.x, x), std::max(range.y, x)};
}

class Grid {
public:
    Grid(const std::vector<glm::dvec2>& corners, const glm::dvec2& low, const glm::dvec2& extent)
        : corners_(corners), low_(low) {
        const double count = double(corners.size()) / 3.0;
        cell_ = std::sqrt(std::max(extent.x * extent.y, 1e-300) / count);
        cell_ = std::max(cell_, std::max(extent.x, extent.y) / (count + 1.0));  // slender regions
        size_ = glm::ivec2(extent / cell_) + 1;
    }

    std::size_t cells() const {
        return static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y);
    }

    // The cells that a triangle may meet: those of its box would be far too many for slivers.
    template <typename Visit>
    void each_cell(std::uint32_t triangle, Visit&& visit) const {
        const glm::dvec2* corner = &corners_[3 * std::size_t{triangle}];
        const glm::dvec2 low = glm::min(corner[0], glm::min(corner[1], corner[2])),
                         high = glm::max(corner[0], glm::max(corner[1], corner[2]));
        constexpr double more = 1e-6;  // of a cell, against rounding
        const int last = cell_of(high.y - low_.y, more, size_.y);
        for (int y = cell_of(low.y - low_.y, -more, size_.y); y <= last; ++y) {
            glm::dvec2 range(1e300, -1e300);
            for (int k = 0; k < 3; ++k)
                add_range(corner[k], corner[(k + 1) % 3], low_.y + (y - more) * cell_,
                          low_.y + (y + 1 + more) * cell_, range);
            if (range.x > range.y) continue;
            const int end = cell_of(range.y - low_.x, more, size_.x);
            for (int x = cell_of(range.x - low_.x, -more, size_.x); x <= end; ++x)
                visit(static_cast<std::size_t>(y) * static_cast<std::size_t>(size_.x) +
                      static_cast<std::size_t>(x));
        }
    }

private:
    int cell_of(double distance, double more, int count) const {
        return std::clamp(static_cast<int>(distance / cell_ + more), 0, count - 1);
    }

    const std::vector<glm::dvec2>& corners_;
    glm::dvec2 low_;
    double cell_ = 1.0;
    glm::ivec2 size_ = glm::ivec2(1);
};

}  // namespace

std::vector<std::pair<std::uint32_t, std::uint32_t>> overlapping(
    const std::vector<glm::dvec2>& corners, double slack) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> out;
    const auto count = static_cast<std::uint32_t>(corners.size() / 3);
    if (count < 2) return out;
    glm::dvec2 low = corners[0], high = corners[0];
    for (const glm::dvec2& corner : corners) {
        low = glm::min(low, corner);
        high = glm::max(high, corner);
    }
    const Grid grid(corners, low, high - low);
    // Triangles of each cell, one list after the other.
    std::vector<std::size_t> first(grid.cells() + 1, 0);
    for (std::uint32_t t = 0; t < count; ++t)
        grid.each_cell(t, [&](std::size_t cell) { ++first[cell + 1]; });
    for (std::size_t cell = 1; cell < first.size(); ++cell) first[cell] += first[cell - 1];
    std::vector<std::uint32_t> members(first.back());
    std::vector<std::size_t> next(first);
    for (std::uint32_t t = 0; t < count; ++t)
        grid.each_cell(t, [&](std::size_t cell) { members[next[cell]++] = t; });

    // Slivers side by side share many cells: each pair is looked at once.
    std::vector<std::uint32_t> seen_by(count, count);
    for (std::uint32_t b = 0; b < count; ++b)
        grid.each_cell(b, [&](std::size_t cell) {
            for (std::size_t i = first[cell]; members[i] < b; ++i) {
                const std::uint32_t a = members[i];
                if (seen_by[a] == b) continue;
                seen_by[a] = b;
                const glm::dvec2 *p = &corners[3 * std::size_t{a}],
                                 *q = &corners[3 * std::size_t{b}];
                if (!separated(p, q, slack) && !separated(q, p, slack)) out.emplace_back(a, b);
            }
        });
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace clgi
