// A grid of about as many cells as triangles finds the pairs, separating axes decide.
// SPDX-License-Identifier: MIT
#include "atlas/overlap.hpp"

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

struct Box {
    glm::ivec2 low, high;  // cells, both included
};

class Grid {
public:
    Grid(const std::vector<glm::dvec2>& corners, const glm::dvec2& low, const glm::dvec2& extent)
        : low_(low) {
        const double count = std::max(1.0, double(corners.size()) / 3.0);
        cell_ = std::sqrt(std::max(extent.x * extent.y, 1e-300) / count);
        cell_ = std::max(cell_, std::max(extent.x, extent.y) / (count + 1.0));  // slender regions
        size_ = cells(low + extent) + 1;
    }
    glm::ivec2 size() const { return size_; }
    glm::ivec2 cells(const glm::dvec2& p) const { return glm::ivec2((p - low_) / cell_); }
    Box box(const glm::dvec2* corner) const {
        return {cells(glm::min(corner[0], glm::min(corner[1], corner[2]))),
                cells(glm::max(corner[0], glm::max(corner[1], corner[2])))};
    }

private:
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
    const auto cell = [&](int x, int y) {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(grid.size().x) +
               static_cast<std::size_t>(x);
    };

    // Triangles of each cell, one list after the other.
    std::vector<Box> boxes(count);
    std::vector<std::size_t> first(cell(0, grid.size().y) + 1, 0);
    const auto each_cell = [&](const Box& box, auto&& visit) {
        for (int y = box.low.y; y <= box.high.y; ++y)
            for (int x = box.low.x; x <= box.high.x; ++x) visit(cell(x, y));
    };
    for (std::uint32_t t = 0; t < count; ++t) {
        boxes[t] = grid.box(&corners[3 * std::size_t{t}]);
        each_cell(boxes[t], [&](std::size_t c) { ++first[c + 1]; });
    }
    for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
    std::vector<std::uint32_t> members(first.back());
    std::vector<std::size_t> next(first);
    for (std::uint32_t t = 0; t < count; ++t)
        each_cell(boxes[t], [&](std::size_t c) { members[next[c]++] = t; });

    for (int y = 0; y < grid.size().y; ++y)
        for (int x = 0; x < grid.size().x; ++x)
            for (std::size_t i = first[cell(x, y)]; i < first[cell(x, y) + 1]; ++i)
                for (std::size_t j = first[cell(x, y)]; j < i; ++j) {
                    const std::uint32_t a = members[j], b = members[i];
                    // Once, in the first cell that both are in.
                    if (glm::max(boxes[a].low, boxes[b].low) != glm::ivec2(x, y)) continue;
                    const glm::dvec2 *p = &corners[3 * std::size_t{a}],
                                     *q = &corners[3 * std::size_t{b}];
                    if (!separated(p, q, slack) && !separated(q, p, slack)) out.emplace_back(a, b);
                }
    std::sort(out.begin(), out.end());
    return out;
}

}  // namespace clgi
