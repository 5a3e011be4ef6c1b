// A scene in another pose, on the host in double precision. glTF 2.0, sections 3.7.2.2 and 3.7.3.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/scene.hpp>
#include <string>

#include "scene/carried.hpp"
#include "scene/normals.hpp"
#include "scene/range_matrices.hpp"

namespace clgi {
namespace {

const glm::dvec3 up(0.0, 1.0, 0.0);

glm::dvec3 unit_or_up(const glm::dvec3& v) {
    const glm::dvec3 unit = unit_or_zero(v);
    return unit == glm::dvec3(0.0) ? up : unit;
}

// One range at work: the vertex v of it, morphed and placed.
class RangePoser {
public:
    RangePoser(const Animation& animation, const PosedRange& range, const Pose& pose)
        : animation_(animation),
          range_(range),
          weights_(pose.weights.data() + animation.nodes[range.node].first_weight),
          matrices_(range_matrices(animation, range, pose)) {}

    glm::dvec3 position(std::uint32_t v) const {
        const glm::dvec3 at = morphed(animation_.rest_positions[range_.first_rest + v], v, 0);
        return glm::dvec3(matrix(v) * glm::dvec4(at, 1.0));
    }

    glm::dvec3 normal(std::uint32_t v) const {
        glm::dvec3 n = animation_.rest_normals[range_.first_rest + v];
        if (range_.morphs_normals) n = morphed(n, v, range_.target_count);
        return unit_or_up(normal_matrix(glm::dmat3(matrix(v))) * unit_or_zero(n));
    }

private:
    glm::dvec3 morphed(glm::dvec3 value, std::uint32_t v, std::uint32_t first_target) const {
        for (std::uint32_t t = 0; t < range_.target_count; ++t) {
            if (weights_[t] == 0.0) continue;
            const std::uint64_t row = std::uint64_t{first_target} + t;
            value +=
                weights_[t] * glm::dvec3(animation_.differences[range_.first_difference +
                                                                row * range_.vertex_count + v]);
        }
        return value;
    }

    glm::dmat4 matrix(std::uint32_t v) const {
        if (range_.influence_count == 0) return matrices_.back();
        glm::dmat4 sum(0.0);
        for (std::uint32_t i = 0; i < range_.influence_count; ++i) {
            const Influence& influence =
                animation_.influences[range_.first_influence +
                                      std::uint64_t{i} * range_.vertex_count + v];
            if (influence.weight > 0.0f)
                sum += matrices_[influence.joint] * double{influence.weight};
        }
        return sum;
    }

    const Animation& animation_;
    const PosedRange& range_;
    const double* weights_;
    std::vector<glm::dmat4> matrices_;
};

void place(const PosedRange& range, const RangePoser& poser, Scene& scene) {
    for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
        const std::uint32_t vertex = range.first_vertex + v;
        scene.positions[vertex] = poser.position(v);
        if (!(glm::length(scene.positions[vertex]) <= 1e18))
            throw InputError("scene: posed vertex " + std::to_string(vertex) +
                             " is not finite or beyond 1e18 m");
        if (!range.flat) scene.normals[vertex] = glm::vec3(poser.normal(v));
    }
    if (!range.flat) return;
    const Part& part = scene.parts[range.part];
    for (std::uint32_t t = 0; t < part.triangle_count; ++t) {
        const std::uint32_t(&corner)[3] = scene.triangles[part.first_triangle + t].vertex;
        const glm::dvec3 a = scene.positions[corner[0]];
        const glm::vec3 normal(
            unit_or_up(glm::cross(scene.positions[corner[1]] - a, scene.positions[corner[2]] - a)));
        for (const std::uint32_t vertex : corner) scene.normals[vertex] = normal;
    }
}

}  // namespace

Scene posed(const Scene& scene, const Pose& pose) {
    if (!scene.animation) throw Error("animation: the scene has none");
    const Animation& animation = *scene.animation;
    if (pose.matrices.size() != animation.nodes.size() ||
        pose.weights.size() != animation.weights.size())
        throw Error("animation: the pose has " + std::to_string(pose.matrices.size()) +
                    " matrices and " + std::to_string(pose.weights.size()) + " weights, " +
                    std::to_string(animation.nodes.size()) + " and " +
                    std::to_string(animation.weights.size()) + " needed");
    Scene out = scene;
    out.animation.reset();
    for (const PosedRange& range : animation.ranges)
        place(range, RangePoser(animation, range, pose), out);
    for (const Carried& light : animation.lights)
        carry(pose.matrices[light.node], out.lights[light.index]);
    for (const Carried& camera : animation.cameras)
        carry(pose.matrices[camera.node], out.cameras[camera.index]);
    return out;
}

}  // namespace clgi
