// SPDX-License-Identifier: MIT
#include <clgi/passes/scene.hpp>

#include <cmath>
#include <cstring>

#include "core/opencl/launch.hpp"
#include "core/opencl/program.hpp"
#include "scene/local_frame.hpp"

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
    const Bounds box = reached(scene.frame());
    out.low = glm::vec4(box.low, 0.0f);
    out.high = glm::vec4(box.high, 0.0f);
    return out;
}

ScenePasses::ScenePasses(const Programs& programs, const BuildOptions& options)
    : move_(programs.kernel("scene", "move", options)),
      clusters_(programs.kernel("scene", "clusters", options)),
      nodes_(programs.kernel("scene", "nodes", options)),
      pose_(programs.kernel("scene", "pose", options)),
      flatten_(programs.kernel("scene", "flatten", options)) {}

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
                  scene.triangles(), scene.positions(), scene.clusters(), scene.parts());
}

cl::Event ScenePasses::nodes(const cl::CommandQueue& queue, DeviceScene& scene, std::size_t level,
                             const WaitList& wait) const {
    const std::vector<std::uint32_t>& levels = scene.node_levels();
    if (level + 1 >= levels.size())
        throw Error("scene.nodes: level is " + std::to_string(level) + ", below " +
                    std::to_string(levels.size() - 1) + " needed");
    const std::uint32_t count = levels[level + 1] - levels[level];
    return launch(nodes_, queue, count, wait, levels[level], count, scene.clusters(),
                  scene.nodes());
}

cl::Event ScenePasses::pose(const cl::CommandQueue& queue, const PoseParams& params,
                            const PoseBuffers& buffers, const WaitList& wait) const {
    const auto check = [&](const char* name, const cl::Buffer& buffer, std::size_t count,
                           std::size_t size) { need(pose_, name, buffer, count * size); };
    check("ranges", buffers.ranges, params.range_count, sizeof(PoseRange));
    check("rest_positions", buffers.rest_positions, params.vertex_count, 16);
    check("rest_normals", buffers.rest_normals, params.vertex_count, 16);
    check("influences", buffers.influences, params.influence_count, 8);
    check("differences", buffers.differences, params.difference_count, 12);
    check("matrices", buffers.matrices, params.matrix_count, sizeof(PoseMatrix));
    check("weights", buffers.weights, params.weight_count, sizeof(float));
    check("positions", buffers.positions, params.given_count, 16);
    check("normals", buffers.normals, params.given_count, 16);
    return launch(pose_, queue, params.vertex_count, wait, params, buffers.ranges,
                  buffers.rest_positions, buffers.rest_normals, buffers.influences,
                  buffers.differences, buffers.matrices, buffers.weights, buffers.positions,
                  buffers.normals);
}

cl::Event ScenePasses::flatten(const cl::CommandQueue& queue, const PoseParams& params,
                               const PoseBuffers& buffers, const WaitList& wait) const {
    need(flatten_, "triangles", buffers.triangles, std::size_t{params.triangle_count} * 16);
    need(flatten_, "positions", buffers.positions, std::size_t{params.given_count} * 16);
    need(flatten_, "normals", buffers.normals, std::size_t{params.given_count} * 16);
    return launch(flatten_, queue, params.triangle_count, wait, params.triangle_count,
                  buffers.triangles, buffers.positions, buffers.normals);
}

}  // namespace clgi
