// Planes of triangles that leave the whole scene on one side of them.
//
// If the plane of every triangle is such a plane, all surfaces lie on the boundary of a convex
// body, and a segment between two of its points passes through its inside or along one plane.
// [derived: supporting hyperplanes of a convex set]
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scene/local_triangles.hpp"

namespace clgi {

// Points x with dot(normal, x) = offset.
struct Plane {
    glm::dvec3 normal;  // unit
    double offset = 0.0;

    double distance(const glm::dvec3& point) const { return glm::dot(normal, point) - offset; }
};

// Whether some vertex lies strictly on one side: farther from the plane than same_place.
struct Sides {
    bool above = false;  // where the normal points
    bool below = false;
};

class SupportingPlanes {
public:
    // triangles: must outlive it.
    explicit SupportingPlanes(const std::vector<LocalTriangle>& triangles);

    // Whether a few vertices show that no plane through the triangle, within rounding of its
    // corners, has all on one side. False says nothing. The triangle is no line.
    bool crossed(std::size_t triangle) const;

    struct Placed {
        std::size_t plane;
        bool before, behind;  // a vertex lies strictly before the triangle's front, behind it
    };
    // The supporting plane of a triangle that is no line. Nothing if it has none, or if it was not
    // found out within `most_tests`. Found once and kept.
    const std::optional<Placed>& place(std::size_t triangle);

    // Whether two placed triangles cover a common part of one plane, whichever way they face; true
    // also if that was not found out.
    bool overlap();

    // Whether all corners of a triangle lie in one plane of those found so far.
    bool in_a_plane(const LocalTriangle& triangle) const;

    struct Supporting {
        Plane plane;
        Sides sides;  // one at most
        std::vector<std::uint32_t> triangles;
    };
    const std::vector<Supporting>& planes() const { return planes_; }

    // Of a vertex against a plane, or of two triangles in a plane: some tenths of a second.
    static constexpr std::size_t most_tests = 100000000;

private:
    struct Raised;  // a plane, and how well its corners fix it
    std::optional<Placed> find(std::size_t triangle);
    std::optional<Placed> in_known_plane(std::size_t triangle);
    Plane fitted(const LocalTriangle& triangle);
    std::optional<Raised> refit(const Raised& plane);
    Sides sides_of(const Plane& plane);
    bool spend(std::size_t tests);
    void gather();  // what x_, y_ and z_ hold, once

    const std::vector<LocalTriangle>& triangles_;
    std::vector<glm::dvec3> few_;    // corners of some triangles
    std::vector<double> x_, y_, z_;  // corners of all triangles, each place once
    enum class State : std::uint8_t { unknown, known };
    std::vector<State> states_;
    std::vector<std::optional<Placed>> placed_;
    std::vector<Supporting> planes_;
    std::size_t tests_left_ = most_tests;
};

}  // namespace clgi
