// The rest pose of a primitive's vertices.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/gltf_accessor.hpp"
#include "io/gltf_primitive.hpp"

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
        mirrored = glm::determinant(linear) < 0.0;
        normal_matrix =
            glm::dmat3(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                       glm::cross(linear[0], linear[1])) *
            (mirrored ? -1.0 : 1.0);
    }

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
    SkinReader(const Document& document, const Attributes& attributes,
               const std::vector<glm::dmat4>& joints)
        : joints_(joints) {
        for (int set = 0;; ++set) {
            const std::string number = std::to_string(set);
            const auto joint_set = reader_of(document, attributes, "JOINTS_" + number);
            if (!joint_set) return;
            joint_sets_.push_back(*joint_set);
            weight_sets_.push_back(*reader_of(document, attributes, "WEIGHTS_" + number));
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
            require(joint < joints_.size(), "a vertex follows joint ", joint, ", its skin has ",
                    joints_.size());
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
    const auto [found, fresh] = joint_matrices_.try_emplace(skin);
    std::vector<glm::dmat4>& matrices = found->second;
    if (!fresh) return matrices;
    const tinygltf::Skin& source = document_.model.skins[skin];
    for (const int joint : source.joints) matrices.push_back(document_.matrices[joint]);
    if (source.inverseBindMatrices < 0) return matrices;
    const AccessorReader inverse_bind(document_,
                                      document_.model.accessors[source.inverseBindMatrices]);
    for (std::size_t i = 0; i < matrices.size(); ++i) {
        glm::dmat4 to_joint;
        for (int k = 0; k < 4; ++k) to_joint[k] = inverse_bind.vector<4>(i, 4 * k);
        matrices[i] = matrices[i] * to_joint;
    }
    return matrices;
}

void Poser::morph(const Primitive& primitive, const Node& node,
                  const std::vector<std::uint32_t>& vertices, Pose& pose) {
    const std::vector<double>& weights =
        node.weights.empty() ? document_.model.meshes[node.mesh].weights : node.weights;
    for (std::size_t t = 0; t < weights.size(); ++t) {
        if (weights[t] == 0.0) continue;
        differences_read_ += vertices.size();
        require(differences_read_ <= most_differences, "too many morph targets");
        const auto add = [&](const char* name, std::vector<glm::dvec3>& values) {
            const auto differences = reader_of(document_, primitive.targets[t], name);
            if (!differences || values.empty()) return;
            for (std::size_t i = 0; i < vertices.size(); ++i) {
                values[i] += weights[t] * differences->vector<3>(vertices[i]);
            }
        };
        add("POSITION", pose.positions);
        add("NORMAL", pose.normals);
    }
}

Pose Poser::pose(const Primitive& primitive, const Node& node, const glm::dmat4& matrix,
                 const std::vector<std::uint32_t>& vertices) {
    Pose pose;
    const auto read = [&](const char* name, std::vector<glm::dvec3>& values) {
        const auto reader = reader_of(document_, primitive.attributes, name);
        if (!reader) return;
        values.reserve(vertices.size());
        for (const std::uint32_t vertex : vertices) values.push_back(reader->vector<3>(vertex));
    };
    read("POSITION", pose.positions);
    read("NORMAL", pose.normals);
    morph(primitive, node, vertices, pose);

    pose.mirrored.resize(vertices.size());
    const auto place = [&](std::size_t i, const Placement& placement) {
        pose.positions[i] = glm::dvec3(placement.matrix * glm::dvec4(pose.positions[i], 1.0));
        if (!pose.normals.empty()) pose.normals[i] = placement.normal(pose.normals[i]);
        pose.mirrored[i] = placement.mirrored;
    };
    const Placement rigid(matrix);
    if (node.skin < 0 || attribute(primitive.attributes, "JOINTS_0") < 0) {
        for (std::size_t i = 0; i < vertices.size(); ++i) place(i, rigid);
        return pose;
    }
    // The skin alone places its vertices; the node's own matrix has no say.
    const SkinReader skin(document_, primitive.attributes, joint_matrices(node.skin));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto blended = skin.blended(vertices[i]);
        if (!blended) document_.warnings.add("a skinned vertex without weights stays in place");
        place(i, blended ? Placement(*blended) : rigid);
    }
    return pose;
}

}  // namespace clgi::io::gltf
