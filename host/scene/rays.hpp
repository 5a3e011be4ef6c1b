// Many rays against all triangles of a scene, on the host and with boxes but no tree: for the few
// thousand rays of an analysis or of a default camera.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "scene/local_triangles.hpp"

namespace clgi {

// Triangles in boxes, and these boxes in larger ones, as they follow each other in a scene.
class Blockers {
public:
    // triangles: must outlive it.
    explicit Blockers(const std::vector<LocalTriangle>& triangles);

    static constexpr std::size_t block = 32;  // triangles of a box, and boxes of a larger one

    struct Box {
        glm::dvec3 low, high;
    };
    const std::vector<LocalTriangle>& triangles() const { return triangles_; }
    const std::vector<Box>& boxes() const { return boxes_; }
    const std::vector<Box>& larger() const { return larger_; }

private:
    const std::vector<LocalTriangle>& triangles_;
    std::vector<Box> boxes_, larger_;
};

class Rays {
public:
    // What a ray looks for: the nearest triangle, or whether there is any.
    enum Search : std::uint8_t { nearest, any };

    // along: unit. longest: what is met farther away does not count.
    void add(const glm::dvec3& from, const glm::dvec3& along, double longest,
             Search search = nearest);

    // A ray does not meet what lies in the place of its start, such as its own triangle.
    void trace(const Blockers& blockers);

    bool met(std::size_t i) const { return met_[i] != 0; }
    // Of the nearest triangle, if that was looked for.
    double distance(std::size_t i) const { return nearest_[i]; }
    std::uint32_t triangle(std::size_t i) const { return triangle_[i]; }

private:
    using Chosen = std::vector<std::uint32_t>;
    void choose(const Blockers::Box& box, const Chosen& of, Chosen& out) const;
    void meet(const LocalTriangle& triangle, std::uint32_t index, const Chosen& rays);

    // Planes of rays, so that one triangle is compared with many.
    std::vector<double> from_[3], along_[3], per_along_[3];
    std::vector<double> nearest_;
    std::vector<std::uint8_t> met_, search_;
    std::vector<std::uint32_t> triangle_;
};

}  // namespace clgi
