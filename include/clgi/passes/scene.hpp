// What changes a scene on the device, one method a kernel. Structs: clgi/shared/scene.h.
// Rules for all methods: clgi/passes/gbuffer.hpp. SceneMover calls them in the right order.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/scene.h>
#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <clgi/pass.hpp>
#include <clgi/programs.hpp>
#include <cstdint>

namespace clgi {

// What vertices move by.
struct MoveBuffers {
    cl::Buffer vertex_order;  // [vertex_count] uint, DeviceScene::vertex_order()
    cl::Buffer positions;     // [count] float4: xyz metres; w is not read
    cl::Buffer normals;       // [count] float4: xyz unit; none without MOVE_NORMALS
    cl::Buffer status;        // [MOVE_STATUS_WORDS] uint, only added to
};

// For vertices first .. first + count - 1 of the scene's file. origin: the world point, in metres,
// that positions in the buffer are relative to.
CLGI_API MoveParams move_params(const DeviceScene& scene, std::uint32_t first, std::uint32_t count,
                                const glm::dvec3& origin = glm::dvec3(0.0));

class CLGI_API ScenePasses {
public:
    explicit ScenePasses(const Programs& programs, const BuildOptions& options = {});
    ScenePasses(const cl::Context& context, const cl::Device& device,
                const BuildOptions& options = {})
        : ScenePasses(Programs(context, device), options) {}

    // Vertices that a triangle uses get positions and, with MOVE_NORMALS, normals. One whose
    // numbers are not finite, or too large for the local frame, stays as it was and is counted.
    cl::Event move(const cl::CommandQueue& queue, const MoveParams& params, DeviceScene& scene,
                   const MoveBuffers& buffers, const WaitList& wait = {}) const;

    // Writes scene.clusters() for the positions as they are.
    cl::Event clusters(const cl::CommandQueue& queue, DeviceScene& scene,
                       const WaitList& wait = {}) const;

private:
    PassKernel move_, clusters_;
};

}  // namespace clgi
