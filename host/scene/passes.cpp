// SPDX-License-Identifier: MIT
#include <clgi/passes/scene.hpp>

#include <cmath>
#include <cstring>

#include "opencl/launch.hpp"
#include "opencl/program.hpp"

namespace clgi {

namespace {

// Two words, the lower one first.
void put_double(double value, std::uint32_t* words) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    words[0] = static_cast<std::uint32_t>(bits);
    words[1] = static_cast<std::uint32_t>(bits >> 32);
}

}  // namespace

MoveParams move_params(const DeviceScene& scene, std::uint32_t first, std::uint32_t count,
                       const glm::dvec3& origin) {
    MoveParams out{};
    out.first = first;
    out.count = count;
    out.vertex_count = scene.info().vertex_count;
    out.flags = MOVE_NORMALS;
    out.exponent = std::ilogb(scene.frame().scale);
    for (int axis = 0; axis < 3; ++axis) {
        // A position relative to 0 is itself, with its sign: -0 + -0 is -0, 0 + -0 is not.
        put_double(origin[axis] == 0.0 ? -0.0 : origin[axis], out.given_from + 2 * axis);
        put_double(scene.frame().origin[axis], out.frame_origin + 2 * axis);
    }
    return out;
}

ScenePasses::ScenePasses(const Programs& programs, const BuildOptions& options)
    : move_(programs.kernel("scene", "move", options)),
      clusters_(programs.kernel("scene", "clusters", options)) {}

cl::Event ScenePasses::move(const cl::CommandQueue& queue, const MoveParams& params,
                            DeviceScene& scene, const MoveBuffers& buffers,
                            const WaitList& wait) const {
    const std::size_t vertices = scene.info().vertex_count;
    if (params.vertex_count != vertices)
        throw Error("scene.move: vertex_count is " + std::to_string(params.vertex_count) + ", " +
                    std::to_string(vertices) + " needed");
    const bool normals = (params.flags & MOVE_NORMALS) != 0;
    need(move_, "vertex_order", buffers.vertex_order, vertices * sizeof(std::uint32_t));
    need(move_, "positions", buffers.positions, std::size_t{params.count} * sizeof(glm::vec4));
    if (normals)
        need(move_, "normals", buffers.normals, std::size_t{params.count} * sizeof(glm::vec4));
    need(move_, "status", buffers.status, MOVE_STATUS_WORDS * sizeof(std::uint32_t));
    return launch(move_, queue, params.count == 0 ? 0 : vertices, wait, params,
                  buffers.vertex_order, buffers.positions,
                  normals ? buffers.normals : buffers.positions, scene.positions(), scene.normals(),
                  buffers.status);
}

cl::Event ScenePasses::clusters(const cl::CommandQueue& queue, DeviceScene& scene,
                                const WaitList& wait) const {
    const SceneInfo& info = scene.info();
    return launch(clusters_, queue, info.cluster_count, wait, info.triangle_count,
                  scene.triangles(), scene.positions(), scene.clusters());
}

}  // namespace clgi
