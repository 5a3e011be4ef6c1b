// The parts of Scene::animation that kernels read, on the device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/scene.hpp>
#include <clgi/scene.hpp>

namespace clgi {

// Written are the scene's vertices `first` to first + given_count - 1: from the first that moves to
// the last. Those between them that stand still are there from the start.
struct PoseData {
    std::uint32_t first = 0;
    glm::dvec3 origin = glm::dvec3(0.0);  // that positions written are relative to
    PoseParams params{};
    PoseBuffers buffers;
    std::size_t bytes = 0;
};

// Matrices of ranges lie as range_matrices() makes them, one range after the other.
PoseData upload_poses(const cl::CommandQueue& queue, const Scene& scene, const glm::dvec3& origin);

}  // namespace clgi
