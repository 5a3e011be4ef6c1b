// Many rays against all triangles of a scene, on the host and without a tree: for the few thousand
// rays of an analysis.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "plan/local_triangles.hpp"

namespace clgi {

class Rays {
public:
    // What a ray looks for: the nearest triangle, or whether there is any.
    enum Search : std::uint8_t { nearest, any };

    // along: unit. longest: what is met farther away does not count.
    void add(const glm::dvec3& from, const glm::dvec3& along, double longest,
             Search search = nearest);

    // A ray does not meet what lies in the place of its start, such as its own triangle.
    void trace(const std::vector<LocalTriangle>& triangles);

    std::size_t count() const { return nearest_.size(); }
    bool met(std::size_t i) const { return met_[i] != nothing; }
    // Of the nearest triangle.
    bool met_back(std::size_t i) const { return met_[i] == back; }
    double distance(std::size_t i) const { return nearest_[i]; }
    std::uint32_t triangle(std::size_t i) const { return triangle_[i]; }

private:
    enum : std::uint8_t { nothing, front, back };

    void choose(const LocalTriangle* first, const LocalTriangle* last);
    void meet(const LocalTriangle& triangle, std::uint32_t index);

    // Planes of rays, so that one triangle is compared with many.
    std::vector<double> from_[3], along_[3], per_along_[3];
    std::vector<double> nearest_;
    std::vector<std::uint8_t> met_, search_;
    std::vector<std::uint32_t> triangle_;
    std::vector<std::size_t> chosen_;  // that pass through a box before what they have met
};

}  // namespace clgi
