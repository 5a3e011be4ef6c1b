// What moved on the device, back on the host.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/scene.hpp>

#include "device.hpp"

namespace clgi::test {

// A scene with the vertices that the device has now, standing still.
inline Scene read_back(Scene scene, const DeviceScene& device) {
    const std::size_t count = device.info().vertex_count;
    const auto positions = download<glm::vec4>(device.positions(), count);
    const auto normals = download<glm::vec4>(device.normals(), count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint32_t vertex = device.vertex_order()[i];
        scene.positions[vertex] =
            device.frame().origin + glm::dvec3(positions[i]) / device.frame().scale;
        scene.normals[vertex] = glm::vec3(normals[i]);
    }
    scene.animation.reset();
    return scene;
}

}  // namespace clgi::test
