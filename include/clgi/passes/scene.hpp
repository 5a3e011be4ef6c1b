// What changes a scene on the device, one method a kernel. Structs: clgi/shared/scene.h.
// Rules for all methods: clgi/passes/gbuffer.hpp. SceneMover calls them in the right order.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/scene.h>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/device_scene.hpp>
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

// What poses are made from and where they go. Vertices: PoseParams.
struct PoseBuffers {
    cl::Buffer ranges;          // [range_count] PoseRange
    cl::Buffer rest_positions;  // [vertex_count] uint4: bits of xyz, range
    cl::Buffer rest_normals;    // [vertex_count] float4
    cl::Buffer influences;      // [influence_count] uint2: joint of the range, bits of its weight
    cl::Buffer differences;     // [difference_count] three floats
    cl::Buffer matrices;        // [matrix_count] PoseMatrix
    cl::Buffer weights;         // [weight_count] float
    cl::Buffer triangles;       // [triangle_count] uint4, of flat ranges
    cl::Buffer positions;       // written: [given_count] float4, metres
    cl::Buffer normals;         // written: [given_count] float4
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

    // Writes scene.clusters() and scene.parts() for the positions as they are. nodes() must follow,
    // from the last level to the first: what has left its boxes would not be drawn.
    cl::Event clusters(const cl::CommandQueue& queue, DeviceScene& scene,
                       const WaitList& wait = {}) const;

    // Writes boxes of scene.nodes() of one level, counted from the root, for the clusters and the
    // levels below as they are. Error for a level that the scene does not have.
    cl::Event nodes(const cl::CommandQueue& queue, DeviceScene& scene, std::size_t level,
                    const WaitList& wait = {}) const;

    // Posed vertices get positions and, unless their range is flat, normals. Indices in the buffers
    // are not checked.
    cl::Event pose(const cl::CommandQueue& queue, const PoseParams& params,
                   const PoseBuffers& buffers, const WaitList& wait = {}) const;

    // Vertices of flat triangles get the normals of their planes, from buffers.positions.
    cl::Event flatten(const cl::CommandQueue& queue, const PoseParams& params,
                      const PoseBuffers& buffers, const WaitList& wait = {}) const;

private:
    PassKernel move_, clusters_, nodes_, pose_, flatten_;
};

}  // namespace clgi
