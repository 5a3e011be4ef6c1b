// SPDX-License-Identifier: MIT
#include "view/viewpoint.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clgi::view {
namespace {

glm::dvec3 turned(const glm::dvec3& way, double around, double up) {
    const double steepest = glm::radians(89.0), length = glm::length(way);
    if (!(length > 0.0)) return way;
    const double azimuth = std::atan2(way.x, way.z) + around;
    const double elevation =
        std::clamp(std::asin(std::clamp(way.y / length, -1.0, 1.0)) + up, -steepest, steepest);
    return length * glm::dvec3(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                               std::cos(elevation) * std::cos(azimuth));
}

}  // namespace

Viewpoint viewpoint_of(const Camera& camera, const Bounds& box) {
    const glm::dvec3 forward(camera.forward), middle = 0.5 * (box.low + box.high);
    const double radius = std::max(0.5 * glm::length(box.high - box.low), 1e-6);
    const double reach = glm::dot(middle - camera.position, forward);
    return {camera.position,
            camera.position + std::clamp(reach, 0.1 * radius, 1e3 * radius) * forward};
}

void orbit(Viewpoint& viewpoint, double right, double up) {
    viewpoint.eye = viewpoint.target + turned(viewpoint.eye - viewpoint.target, -right, up);
}

void look(Viewpoint& viewpoint, double right, double up) {
    viewpoint.target = viewpoint.eye + turned(viewpoint.target - viewpoint.eye, -right, up);
}

void walk(Viewpoint& viewpoint, const glm::dvec3& by) {
    const glm::dvec3 forward = glm::normalize(viewpoint.target - viewpoint.eye);
    const glm::dvec3 side = glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0));
    const glm::dvec3 right =
        glm::length(side) > 1e-9 ? glm::normalize(side) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 step = by.x * right + by.y * glm::dvec3(0.0, 1.0, 0.0) + by.z * forward;
    viewpoint.eye += step;
    viewpoint.target += step;
}

void approach(Viewpoint& viewpoint, double factor, double radius) {
    const glm::dvec3 way = viewpoint.eye - viewpoint.target;
    const double length = glm::length(way);
    const double wanted = std::clamp(factor * length, 1e-4 * radius, 1e4 * radius);
    viewpoint.eye = viewpoint.target + (wanted / length) * way;
}

}  // namespace clgi::view
