// Vertices are put into a grid of cells many tolerances wide, of equal ones the first alone, so
// that a vertex looks into one cell and seldom into more.
// SPDX-License-Identifier: MIT
#include "scene/weld.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "scene/disjoint_sets.hpp"

namespace clgi {
namespace {

constexpr double spacings = 2.0;          // within which coordinates are the same
constexpr double cell_tolerances = 16.0;  // width of a cell in tolerances, the largest one

// Between floats of this size.
double float_spacing(double size) {
    return size > 0.0 ? std::ldexp(1.0, std::ilogb(size) - 23) : 0.0;
}

double largest(const glm::dvec3& p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// Vertices in lists, one for every few cells: a grid without bounds. Whoever looks compares the
// vertices themselves, so it does no harm that cells share a list.
class Grid {
public:
    Grid(std::size_t vertices, double cell) : cell_(cell), next_(vertices) {
        std::size_t lists = 1;
        while (lists < vertices) lists *= 2;
        first_.assign(lists, none_);
    }

    struct Cell {
        std::int64_t x, y, z;
    };

    Cell of(const glm::dvec3& p) const { return {along(p.x), along(p.y), along(p.z)}; }

    void add(std::uint32_t vertex, const Cell& cell) {
        std::uint32_t& list = first_[list_of(cell)];
        next_[vertex] = list;
        list = vertex;
    }

    // The first vertex in a cell's list for which found(vertex).
    template <typename Found>
    std::optional<std::uint32_t> find(const Cell& cell, Found&& found) const {
        for (std::uint32_t v = first_[list_of(cell)]; v != none_; v = next_[v])
            if (found(v)) return v;
        return {};
    }

private:
    static constexpr std::uint32_t none_ = 0xffffffffu;

    std::int64_t along(double coordinate) const {
        return static_cast<std::int64_t>(std::floor(coordinate / cell_));
    }

    std::size_t list_of(const Cell& cell) const {
        std::uint64_t hash = 0;
        for (const std::int64_t i : {cell.x, cell.y, cell.z}) {
            hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash) & (first_.size() - 1);
    }

    double cell_;
    std::vector<std::uint32_t> first_;  // [lists] vertex
    std::vector<std::uint32_t> next_;   // [vertices] in the same list
};

// How far a vertex's coordinates may be off, by the largest coordinate of its triangles.
std::vector<double> tolerances(const std::vector<glm::dvec3>& positions,
                               const std::vector<SceneTriangle>& triangles,
                               const glm::dvec3& middle) {
    std::vector<double> size;
    size.reserve(positions.size());
    for (const glm::dvec3& p : positions) size.push_back(largest(p - middle));
    std::vector<double> reach = size;
    for (const SceneTriangle& t : triangles) {
        const double most = std::max({size[t.vertex[0]], size[t.vertex[1]], size[t.vertex[2]]});
        for (const std::uint32_t v : t.vertex) reach[v] = std::max(reach[v], most);
    }
    for (double& r : reach) r = spacings * float_spacing(r);
    return reach;
}

}  // namespace

std::vector<std::uint32_t> weld(const std::vector<glm::dvec3>& positions,
                                const std::vector<SceneTriangle>& triangles) {
    if (positions.empty()) return {};
    glm::dvec3 low = positions[0], high = positions[0];
    for (const glm::dvec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const glm::dvec3 middle = 0.5 * (low + high);
    std::vector<double> tolerance = tolerances(positions, triangles, middle);
    DisjointSets sets(positions.size());

    const double widest = *std::max_element(tolerance.begin(), tolerance.end());
    Grid grid(positions.size(), widest > 0.0 ? cell_tolerances * widest : 1.0);
    // One vertex for each place, with the largest tolerance of those that are there.
    std::vector<std::uint32_t> distinct;
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        const Grid::Cell cell = grid.of(positions[v] - middle);
        const auto first =
            grid.find(cell, [&](std::uint32_t other) { return positions[other] == positions[v]; });
        if (first) {
            sets.join(*first, v);
            tolerance[*first] = std::max(tolerance[*first], tolerance[v]);
        } else {
            grid.add(v, cell);
            distinct.push_back(v);
        }
    }
    for (const std::uint32_t v : distinct) {
        // The larger tolerance of two counts, and the other's may be the widest.
        const glm::dvec3 p = positions[v] - middle;
        const Grid::Cell from = grid.of(p - widest), to = grid.of(p + widest);
        for (std::int64_t x = from.x; x <= to.x; ++x)
            for (std::int64_t y = from.y; y <= to.y; ++y)
                for (std::int64_t z = from.z; z <= to.z; ++z)
                    grid.find({x, y, z}, [&](std::uint32_t other) {
                        if (other < v && largest(positions[v] - positions[other]) <=
                                             std::max(tolerance[v], tolerance[other]))
                            sets.join(v, other);
                        return false;
                    });
    }
    return sets.numbered();
}

}  // namespace clgi
