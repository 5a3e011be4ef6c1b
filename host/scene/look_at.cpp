// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/scene.hpp>
#include <cmath>

namespace clgi {

Camera look_at(const Camera& camera, const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 way = target - eye;
    const double length = glm::length(way);
    if (!(length > 0.0) || !std::isfinite(length))
        throw Error("look_at: eye and target are the same place, or not finite");
    const glm::dvec3 forward = glm::normalize(way);
    glm::dvec3 side = glm::cross(forward, glm::dvec3(0.0, 1.0, 0.0));
    if (!(glm::length(side) > 1e-9)) {  // straight up or down
        const glm::dvec3 right(camera.right.x, 0.0, camera.right.z);
        side = glm::length(right) > 1e-9 ? right : glm::dvec3(1.0, 0.0, 0.0);
    }
    const glm::dvec3 right = glm::normalize(side);
    Camera out = camera;
    out.position = eye;
    out.forward = glm::vec3(forward);
    out.right = glm::vec3(right);
    out.up = glm::vec3(glm::cross(right, forward));
    return out;
}

}  // namespace clgi
