// SPDX-License-Identifier: MIT
#include "scene/pose_buffers.hpp"

#include <clgi/error.hpp>
#include <cstring>
#include <limits>
#include <string>

#include "core/opencl/error_text.hpp"

namespace clgi {
namespace {

std::uint32_t bits_of(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
}

std::uint32_t number(std::uint64_t value, const char* what) {
    if (value > std::numeric_limits<std::uint32_t>::max())
        throw DeviceError("scene animator: there are " + std::to_string(value) + " " + what +
                          ", at most 2^32 - 1 needed");
    return static_cast<std::uint32_t>(value);
}

// Never empty: kernels take all of them.
template <typename T>
cl::Buffer upload(const cl::CommandQueue& queue, std::vector<T> values, std::size_t& bytes) {
    if (values.empty()) values.resize(1);
    const std::size_t size = values.size() * sizeof(T);
    bytes += size;
    try {
        return cl::Buffer(queue.getInfo<CL_QUEUE_CONTEXT>(),
                          CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR, size, values.data());
    } catch (const cl::Error& error) {
        throw DeviceError("scene animator: no room for " + std::to_string(size) +
                          " bytes: " + error_text(error.err()));
    }
}

// What vertices, influences and targets of all ranges become.
struct Tables {
    std::vector<PoseRange> ranges;
    std::vector<glm::uvec4> rest_positions;
    std::vector<glm::vec4> rest_normals;
    std::vector<glm::uvec4> triangles;
    std::uint32_t matrices = 0;
};

void add(const Scene& scene, const PosedRange& range, std::uint32_t first, Tables& out) {
    const Animation& animation = *scene.animation;
    const auto index = static_cast<std::uint32_t>(out.ranges.size());
    PoseRange& made = out.ranges.emplace_back();
    made = {};
    made.first = static_cast<std::uint32_t>(out.rest_positions.size());
    made.count = range.vertex_count;
    made.given = range.first_vertex - first;
    if (range.morphs_normals) made.flags |= POSE_MORPHS_NORMALS;
    if (range.flat) made.flags |= POSE_FLAT;
    made.influences = range.influence_count;
    made.first_influence = static_cast<std::uint32_t>(range.first_influence);
    made.targets = range.target_count;
    made.first_weight = animation.nodes[range.node].first_weight;
    made.first_difference = static_cast<std::uint32_t>(range.first_difference);
    const std::size_t joints =
        range.skin < 0 ? 0 : animation.skins[static_cast<std::size_t>(range.skin)].joints.size();
    // Without influences the matrix of the node is the only one that is read.
    made.matrix = out.matrices;
    if (range.influence_count == 0)
        made.matrix = number(std::uint64_t{out.matrices} + joints, "matrices");
    out.matrices = number(std::uint64_t{out.matrices} + joints + 1, "matrices");

    for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
        const glm::vec3& rest = animation.rest_positions[range.first_rest + v];
        out.rest_positions.emplace_back(bits_of(rest.x), bits_of(rest.y), bits_of(rest.z), index);
        out.rest_normals.emplace_back(animation.rest_normals[range.first_rest + v], 0.0f);
    }
    if (!range.flat) return;
    const Part& part = scene.parts[range.part];
    for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
        const std::uint32_t(&corner)[3] = scene.triangles[part.first_triangle + t].vertex;
        out.triangles.emplace_back(corner[0] - first, corner[1] - first, corner[2] - first, 0u);
    }
}

}  // namespace

PoseData upload_poses(const cl::CommandQueue& queue, const Scene& scene, const glm::dvec3& origin) {
    const Animation& animation = *scene.animation;
    PoseData out;
    out.origin = origin;
    if (animation.ranges.empty()) return out;
    out.first = animation.ranges.front().first_vertex;
    const PosedRange& end = animation.ranges.back();
    Tables tables;
    for (const PosedRange& range : animation.ranges) add(scene, range, out.first, tables);

    PoseParams& params = out.params;
    params.vertex_count = number(tables.rest_positions.size(), "vertices");
    params.given_count = end.first_vertex + end.vertex_count - out.first;
    params.range_count = static_cast<std::uint32_t>(tables.ranges.size());
    params.influence_count = number(animation.influences.size(), "influences");
    params.difference_count = number(animation.differences.size(), "differences of morph targets");
    params.matrix_count = tables.matrices;
    params.weight_count = number(animation.weights.size(), "weights of morph targets");
    params.triangle_count = number(tables.triangles.size(), "triangles");

    std::vector<glm::vec4> positions, normals;  // of what stands still
    for (std::uint32_t v = out.first; v < out.first + params.given_count; ++v) {
        positions.emplace_back(glm::vec3(scene.positions[v] - origin), 0.0f);
        normals.emplace_back(scene.normals[v], 0.0f);
    }
    std::vector<glm::uvec2> influences;
    for (const Influence& influence : animation.influences)
        influences.emplace_back(influence.joint, bits_of(influence.weight));
    PoseBuffers& buffers = out.buffers;
    const auto put = [&](auto values) { return upload(queue, std::move(values), out.bytes); };
    buffers.ranges = put(std::move(tables.ranges));
    buffers.rest_positions = put(std::move(tables.rest_positions));
    buffers.rest_normals = put(std::move(tables.rest_normals));
    buffers.influences = put(std::move(influences));
    buffers.differences = put(animation.differences);  // three floats each
    buffers.matrices = put(std::vector<PoseMatrix>(params.matrix_count));
    buffers.weights = put(std::vector<float>(params.weight_count));
    buffers.triangles = put(std::move(tables.triangles));
    buffers.positions = put(std::move(positions));
    buffers.normals = put(std::move(normals));
    return out;
}

}  // namespace clgi
