// A scene's triangles where the device has them.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/device_scene.hpp>
#include <clgi/scene.hpp>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// Local units: how far apart two points may be and still lie in the same place, in one plane or
// before it. Coordinates of the local frame are below 1, so floats round each by 2^-25 at most,
// and a point by less than 2^-24. Floats of the scene's file did the same before. A point and a
// plane are both rounded: twice as much.
constexpr double point_rounding = 0x1p-23;
constexpr double same_place = 2.0 * point_rounding;

struct LocalTriangle {
    std::array<glm::dvec3, 3> corners;
    glm::dvec3 normal = glm::dvec3(0.0);  // unit, of the front; zero: not higher than same_place
    double area = 0.0;
    double height = 0.0;  // the smallest of three
    bool double_sided = false;

    bool is_line() const { return height <= same_place; }  // or a point, to within rounding
};

// [triangles of the scene] Corners are rounded as DeviceScene rounds them.
std::vector<LocalTriangle> local_triangles(const Scene& scene, const SceneFrame& frame);

}  // namespace clgi
