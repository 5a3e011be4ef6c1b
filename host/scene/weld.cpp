// Equal positions are found by sorting; what is left is put into a grid of cells many tolerances
// wide, so that a vertex looks into one cell and seldom into more.
// SPDX-License-Identifier: MIT
#include "scene/weld.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <unordered_map>

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

struct Cell {
    std::int64_t x, y, z;
    bool operator==(const Cell& o) const { return x == o.x && y == o.y && z == o.z; }
};

struct CellHash {
    std::size_t operator()(const Cell& c) const {
        std::uint64_t hash = 0;
        for (const std::int64_t i : {c.x, c.y, c.z}) {
            hash = (hash ^ static_cast<std::uint64_t>(i)) * 0x9e3779b97f4a7c15u;
            hash ^= hash >> 29;
        }
        return static_cast<std::size_t>(hash);
    }
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

bool before(const glm::dvec3& a, const glm::dvec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

// One vertex for each place, with the largest tolerance of those that are there.
std::vector<std::uint32_t> places(const std::vector<glm::dvec3>& positions,
                                  std::vector<double>& tolerance, DisjointSets& sets) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return before(positions[a], positions[b]);
    });
    std::vector<std::uint32_t> out;
    for (const std::uint32_t v : order) {
        if (out.empty() || positions[out.back()] != positions[v]) {
            out.push_back(v);
            continue;
        }
        sets.join(out.back(), v);
        tolerance[out.back()] = std::max(tolerance[out.back()], tolerance[v]);
    }
    return out;
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
    const std::vector<std::uint32_t> distinct = places(positions, tolerance, sets);

    const double widest = *std::max_element(tolerance.begin(), tolerance.end());
    const double cell = widest > 0.0 ? cell_tolerances * widest : 1.0;
    const auto index = [&](double coordinate) {
        return static_cast<std::int64_t>(std::floor(coordinate / cell));
    };
    std::unordered_map<Cell, std::vector<std::uint32_t>, CellHash> grid;
    grid.reserve(distinct.size());
    for (const std::uint32_t v : distinct) {
        const glm::dvec3 p = positions[v] - middle;
        // The larger tolerance of two counts, and the other's may be the widest.
        const glm::dvec3 from = p - widest, to = p + widest;
        for (std::int64_t x = index(from.x); x <= index(to.x); ++x)
            for (std::int64_t y = index(from.y); y <= index(to.y); ++y)
                for (std::int64_t z = index(from.z); z <= index(to.z); ++z) {
                    const auto found = grid.find({x, y, z});
                    if (found == grid.end()) continue;
                    for (const std::uint32_t other : found->second)
                        if (largest(positions[v] - positions[other]) <=
                            std::max(tolerance[v], tolerance[other]))
                            sets.join(v, other);
                }
        grid[{index(p.x), index(p.y), index(p.z)}].push_back(v);
    }
    return sets.numbered();
}

}  // namespace clgi
