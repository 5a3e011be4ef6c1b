// SPDX-License-Identifier: MIT
#include "io/gltf_primitive.hpp"

#include <algorithm>
#include <cmath>

#include "io/gltf_accessor.hpp"
#include "scene/normals.hpp"

namespace clgi::io::gltf {

namespace {

constexpr std::uint32_t unused = UINT32_MAX;

// Zero for a triangle without area. Its corners are still in the order of the file, which a
// mirroring transform has turned around.
glm::dvec3 front_of(const Corners& corner, const PosedVertices& pose) {
    const glm::dvec3 a = pose.positions[corner[0]];
    const glm::dvec3 normal =
        unit_or_zero(glm::cross(pose.positions[corner[1]] - a, pose.positions[corner[2]] - a));
    return pose.mirrored[corner[0]] ? -normal : normal;
}

// For want of any direction, up.
glm::dvec3 or_up(const glm::dvec3& normal) {
    return normal == glm::dvec3(0.0) ? glm::dvec3(0.0, 1.0, 0.0) : normal;
}

// Vertices times active morph targets, over the whole file: seconds of work, which no real file
// comes near, but which a thousand targets on one large array would exceed by far. The same for
// vertices times the joints of their sets.
constexpr std::size_t most_differences = std::size_t{1} << 30;
constexpr std::size_t most_influences = std::size_t{1} << 29;

// A transform for positions and what it does to normals and to the sense of triangles.
struct Placement {
    glm::dmat4 matrix;
    glm::dmat3 of_normals;
    bool mirrored;

    explicit Placement(const glm::dmat4& m)
        : matrix(m),
          of_normals(normal_matrix(glm::dmat3(m))),
          mirrored(glm::determinant(glm::dmat3(m)) < 0.0) {}

    glm::dvec3 normal(const glm::dvec3& n) const {
        return unit_or_zero(of_normals * unit_or_zero(n));
    }
};

// The joints of one vertex, by their weights, which are made to sum to 1. Nothing when no weight is
// above zero.
std::optional<glm::dmat4> blended(const std::vector<AccessorReader>& joint_sets,
                                  const std::vector<AccessorReader>& weight_sets,
                                  const std::vector<glm::dmat4>& joints, std::size_t vertex) {
    glm::dmat4 sum(0.0);
    double total = 0.0;
    for (std::size_t i = 0; i < 4 * joint_sets.size(); ++i) {
        const double weight = weight_sets[i / 4].number(vertex, i % 4);
        if (!(weight > 0.0) || !std::isfinite(weight)) continue;
        const std::uint32_t joint = joint_sets[i / 4].integer(vertex, i % 4);
        require(joint < joints.size(), "a vertex follows joint ", joint, ", its skin has ",
                joints.size());
        sum += joints[joint] * weight;
        total += weight;
    }
    if (total == 0.0) return std::nullopt;
    return sum / total;
}

}  // namespace

std::size_t triangle_count(const Document& document, const Primitive& primitive) {
    const int position = attribute(primitive.attributes, "POSITION");
    if (position < 0 || primitive.mode < TINYGLTF_MODE_TRIANGLES) return 0;
    const int source = primitive.indices >= 0 ? primitive.indices : position;
    const std::size_t corners = document.model.accessors[source].count;
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
    return std::max<std::size_t>(corners, 2) - 2;  // of a strip or a fan
}

std::vector<std::uint32_t> Renumberer::renumber(std::vector<Corners>& triangles) {
    std::vector<std::uint32_t> used;
    for (const Corners& triangle : triangles) {
        for (const std::uint32_t vertex : triangle) {
            if (vertex >= number_.size()) number_.resize(std::size_t{vertex} + 1, unused);
            if (number_[vertex] == unused) used.push_back(vertex);
            number_[vertex] = 0;
        }
    }
    std::sort(used.begin(), used.end());
    for (std::uint32_t i = 0; i < used.size(); ++i) number_[used[i]] = i;
    for (Corners& triangle : triangles) {
        for (std::uint32_t& vertex : triangle) vertex = number_[vertex];
    }
    for (const std::uint32_t vertex : used) number_[vertex] = unused;
    return used;
}

Topology triangles_of(const Document& document, const Primitive& primitive,
                      Renumberer& renumberer) {
    std::optional<AccessorReader> indices;
    if (primitive.indices >= 0)
        indices.emplace(document, document.model.accessors[primitive.indices]);
    const auto corner = [&](std::size_t i) {
        return indices ? indices->integer(i) : static_cast<std::uint32_t>(i);
    };

    Topology topology;
    const std::size_t count = triangle_count(document, primitive);
    topology.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Corners triangle = {corner(i + 1), corner(i + 2), corner(0)};  // of a fan
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            triangle = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
        } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            triangle = {corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)};
        }
        const auto [a, b, c] = triangle;
        if (a != b && b != c && c != a) topology.triangles.push_back(triangle);
    }
    topology.vertices = renumberer.renumber(topology.triangles);
    return topology;
}

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
                  const std::vector<std::uint32_t>& vertices, PosedVertices& pose) {
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

PosedVertices Poser::pose(const Primitive& primitive, const Node& node, const glm::dmat4& matrix,
                          const std::vector<std::uint32_t>& vertices) {
    PosedVertices pose;
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
    std::vector<AccessorReader> joints;
    std::vector<AccessorReader> weights;
    while (const auto set = reader_of(document_, primitive.attributes,
                                      "JOINTS_" + std::to_string(joints.size()))) {
        const std::string name = "WEIGHTS_" + std::to_string(joints.size());
        weights.push_back(*reader_of(document_, primitive.attributes, name));
        joints.push_back(*set);
    }
    if (node.skin < 0 || joints.empty()) {
        for (std::size_t i = 0; i < vertices.size(); ++i) place(i, rigid);
        return pose;
    }
    influences_read_ += 4 * joints.size() * vertices.size();
    require(influences_read_ <= most_influences, "too many sets of joints");
    // The skin alone places its vertices; the node's own matrix has no say.
    const std::vector<glm::dmat4>& matrices = joint_matrices(node.skin);
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        const auto skinned = blended(joints, weights, matrices, vertices[i]);
        if (!skinned) document_.warnings.add("a skinned vertex without weights stays in place");
        place(i, skinned ? Placement(*skinned) : rigid);
    }
    return pose;
}

void make_flat(Topology& topology, PosedVertices& pose) {
    Topology split;
    PosedVertices flat;
    for (const Corners& corner : topology.triangles) {
        const glm::dvec3 normal = or_up(front_of(corner, pose));
        const auto first = static_cast<std::uint32_t>(split.vertices.size());
        split.triangles.push_back({first, first + 1, first + 2});
        for (const std::uint32_t vertex : corner) {
            split.vertices.push_back(topology.vertices[vertex]);
            flat.positions.push_back(pose.positions[vertex]);
            flat.normals.push_back(normal);
            flat.mirrored.push_back(pose.mirrored[corner[0]]);
        }
    }
    topology = std::move(split);
    pose = std::move(flat);
}

bool repair_normals(const Topology& topology, PosedVertices& pose) {
    std::map<std::uint32_t, glm::dvec3> sums;
    for (std::uint32_t i = 0; i < pose.normals.size(); ++i) {
        if (pose.normals[i] == glm::dvec3(0.0)) sums.emplace(i, 0.0);
    }
    if (sums.empty()) return false;
    for (const Corners& corner : topology.triangles) {
        for (const std::uint32_t vertex : corner) {
            const auto sum = sums.find(vertex);
            if (sum != sums.end()) sum->second += front_of(corner, pose);
        }
    }
    for (const auto& [vertex, sum] : sums) pose.normals[vertex] = or_up(unit_or_zero(sum));
    return true;
}

}  // namespace clgi::io::gltf
