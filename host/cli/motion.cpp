// What moves over the frames of a render.
// SPDX-License-Identifier: MIT
#include <glm/gtc/matrix_transform.hpp>

#include "cli/render_flags.hpp"

namespace clgi::cli {

Camera orbited(const Camera& camera, const glm::dvec3& centre, double angle) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0));
    const auto turned = [&](const glm::vec3& v) {
        return glm::vec3(turn * glm::dvec4(glm::dvec3(v), 0.0));
    };
    Camera out = camera;
    out.position = centre + glm::dvec3(turn * glm::dvec4(camera.position - centre, 0.0));
    out.right = turned(camera.right);
    out.up = turned(camera.up);
    out.forward = turned(camera.forward);
    return out;
}

void spin_lights(DeviceScene& device, const Scene& scene, double angle) {
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(0, 1, 0));
    for (std::size_t i = 0; i < scene.lights.size(); ++i) {
        Light light = scene.lights[i];
        light.direction = glm::vec3(turn * glm::dvec4(glm::dvec3(light.direction), 0.0));
        device.set_light(i, light);
    }
}

}  // namespace clgi::cli
