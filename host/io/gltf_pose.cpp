// SPDX-License-Identifier: MIT
#include "io/gltf_pose.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <optional>

#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

// Vertices times active morph targets, over the whole file: seconds of work, which no real file
// comes near, but which a thousand targets on one large array would exceed by far.
constexpr std::size_t most_differences = std::size_t{1} << 30;

// A transform for positions and what it does to normals and to the sense of triangles.
struct Placement {
    glm::dmat4 matrix;
    glm::dmat3 normal_matrix;  // cofactors: right also where a scale is zero
    bool mirrored;

    explicit Placement(const glm::dmat4& m) : matrix(m) {
        const glm::dmat3 linear(m);
        const double determinant = glm::determinant(linear);
        mirrored = determinant < 0.0;
        normal_matrix =
            glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                       glm::cross(linear[0], linear[1])) *
            (mirrored ? -1.0 : 1.0);
    }

    glm::dvec3 position(const glm::dvec3& p) const { return glm::dvec3(matrix * glm::dvec4(p, 1)); }

    glm::dvec3 normal(const glm::dvec3& n) const {
        // Scaled first, so that a model in nanometres does not underflow.
        const auto unit = [](const glm::dvec3& v) {
            const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
            if (!(largest > 0.0) || !std::isfinite(largest)) return glm::dvec3(0.0);
            return glm::normalize(v / largest);
        };
        return unit(normal_matrix * unit(n));
    }
};

// The joints of one vertex with their weights, added up and made to sum to 1.
class SkinReader {
public:
    SkinReader(const Document& document, const Primitive& primitive,
               const std::vector<glm::dmat4>& joints)
        : joints_(joints) {
        for (int set = 0;; ++set) {
            const std::string number = std::to_string(set);
            const int joint_set = attribute(primitive.attributes, "JOINTS_" + number);
            if (joint_set < 0) return;
            joint_sets_.emplace_back(document, joint_set);
            weight_sets_.emplace_back(document,
                                      attribute(primitive.attributes, "WEIGHTS_" + number));
        }
    }

    // Nothing when no weight is above zero.
    std::optional<glm::dmat4> blended(std::size_t vertex) const {
        glm::dmat4 sum(0.0);
        double total = 0.0;
        for (std::size_t i = 0; i < 4 * joint_sets_.size(); ++i) {
            const double weight = weight_sets_[i / 4].number(vertex, i % 4);
            if (!(weight > 0.0) || !std::isfinite(weight)) continue;
            const std::uint32_t joint = joint_sets_[i / 4].integer(vertex, i % 4);
            if (joint >= joints_.size()) {
                throw InputError("a vertex follows joint " + std::to_string(joint) +
                                 ", its skin has " + std::to_string(joints_.size()));
            }
            sum += joints_[joint] * weight;
            total += weight;
        }
        if (total == 0.0) return std::nullopt;
        return sum / total;
    }

private:
    const std::vector<glm::dmat4>& joints_;
    std::vector<AccessorReader> joint_sets_;
    std::vector<AccessorReader> weight_sets_;
};

}  // namespace

const std::vector<glm::dmat4>& Poser::joint_matrices(int skin) {
    const auto known = joint_matrices_.find(skin);
    if (known != joint_matrices_.end()) return known->second;

    const Skin& source = document_.model.skins[skin];
    std::optional<AccessorReader> inverse_bind;
    if (source.inverseBindMatrices >= 0)
        inverse_bind.emplace(document_, source.inverseBindMatrices);
    std::vector<glm::dmat4> matrices;
    for (std::size_t i = 0; i < source.joints.size(); ++i) {
        const glm::dmat4& joint = document_.matrices[source.joints[i]];
        matrices.push_back(inverse_bind ? joint * inverse_bind->mat4(i) : joint);
    }
    return joint_matrices_[skin] = std::move(matrices);
}

void Poser::morph(const Primitive& primitive, const Node& node,
                  const std::vector<std::uint32_t>& vertices, Pose& pose) {
    const std::vector<double>& weights =
        node.weights.empty() ? document_.model.meshes[node.mesh].weights : node.weights;
    for (std::size_t t = 0; t < weights.size(); ++t) {
        if (weights[t] == 0.0) continue;
        differences_read_ += vertices.size();
        if (differences_read_ > most_differences) throw InputError("too many morph targets");

        const auto add = [&](int accessor, std::vector<glm::dvec3>& values) {
            if (accessor < 0 || values.empty()) return;
            const AccessorReader difference(document_, accessor);
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                values[i] += weights[t] * difference.vec3(vertices[i]);
            }
        };
        add(attribute(primitive.targets[t], "POSITION"), pose.positions);
        add(attribute(primitive.targets[t], "NORMAL"), pose.normals);
    }
}

Pose Poser::pose(const Primitive& primitive, const Node& node, const glm::dmat4& matrix,
                 const std::vector<std::uint32_t>& vertices) {
    Pose pose;
    const AccessorReader positions(document_, attribute(primitive.attributes, "POSITION"));
    for (const std::uint32_t vertex : vertices) pose.positions.push_back(positions.vec3(vertex));
    const int normal = attribute(primitive.attributes, "NORMAL");
    if (normal >= 0) {
        const AccessorReader normals(document_, normal);
        for (const std::uint32_t vertex : vertices) pose.normals.push_back(normals.vec3(vertex));
    }
    morph(primitive, node, vertices, pose);

    pose.mirrored.resize(vertices.size());
    const auto place = [&](std::size_t i, const Placement& placement) {
        pose.positions[i] = placement.position(pose.positions[i]);
        if (!pose.normals.empty()) pose.normals[i] = placement.normal(pose.normals[i]);
        pose.mirrored[i] = placement.mirrored;
    };
    const Placement rigid(matrix);
    if (node.skin < 0 || attribute(primitive.attributes, "JOINTS_0") < 0) {
        for (std::size_t i = 0; i < vertices.size(); ++i) place(i, rigid);
        return pose;
    }
    // The skin alone places its vertices; the node's own matrix has no say.
    const SkinReader skin(document_, primitive, joint_matrices(node.skin));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto blended = skin.blended(vertices[i]);
        if (!blended) document_.warnings.add("a skinned vertex without weights stays in place");
        place(i, blended ? Placement(*blended) : rigid);
    }
    return pose;
}

}  // namespace clgi::io::gltf
