// The node hierarchy: that it is a forest, where its nodes stand, and which belong to a scene.
// Nothing here recurses; a chain of a million nodes is a loop of a million steps.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/type_ptr.hpp>

#include "io/gltf_accessor.hpp"
#include "scene/node_matrix.hpp"

namespace clgi::io::gltf {

namespace {

// Far beyond any scene, far below where products of two such numbers overflow a double.
constexpr double largest_entry = 1e100;

const glm::dvec4 no_turn(0.0, 0.0, 0.0, 1.0);

glm::dquat quaternion(const glm::dvec4& xyzw) { return {xyzw.w, xyzw.x, xyzw.y, xyzw.z}; }

glm::dmat4 local_transform(const Node& node, Warnings& warnings) {
    const AnimatedNode parts = transform_of(node, warnings);
    if (parts.matrix) return *parts.matrix;
    if (!is_rotation(parts.rotation)) {
        warnings.add("a node rotation that is no quaternion is ignored");
    }
    return node_matrix(parts.translation, parts.rotation, parts.scale);
}

void set_parents(Document& document) {
    const std::vector<Node>& nodes = document.model.nodes;
    std::vector<int>& parents = document.parents;
    parents.assign(nodes.size(), -1);
    for (int parent = 0; parent < static_cast<int>(nodes.size()); ++parent) {
        for (const int child : nodes[parent].children) {
            require(parents[child] < 0, "nodes[", child, "] is a child twice, of nodes[",
                    parents[child], "] and nodes[", parent, "]");
            parents[child] = parent;
        }
    }
}

void require_usable(const glm::dmat4& matrix, int node) {
    for (int i = 0; i < 16; ++i) {
        require(std::abs(matrix[i / 4][i % 4]) <= largest_entry, "nodes[", node,
                "] has a transform that overflows");
    }
}

std::vector<int> roots_of(const Document& document) {
    std::vector<int> roots;
    for (int node = 0; node < static_cast<int>(document.parents.size()); ++node) {
        if (document.parents[node] < 0) roots.push_back(node);
    }
    return roots;
}

// The nodes and what is below them, parents before children.
std::vector<int> with_descendants(const Document& document, std::vector<int> order) {
    for (std::size_t next = 0; next < order.size(); ++next) {
        const std::vector<int>& children = document.model.nodes[order[next]].children;
        order.insert(order.end(), children.begin(), children.end());
    }
    return order;
}

}  // namespace

AnimatedNode transform_of(const Node& node, Warnings& warnings) {
    AnimatedNode parts;
    if (!node.matrix.empty()) {
        const glm::dmat4 transform = glm::make_mat4(node.matrix.data());  // by columns, as in glm
        glm::dmat4 affine = transform;
        for (int column = 0; column < 4; ++column) affine[column][3] = column == 3;
        if (transform != affine) {
            warnings.add("a node matrix with a projective row is read without it");
        }
        parts.matrix = affine;
        return parts;
    }
    if (!node.translation.empty()) parts.translation = glm::make_vec3(node.translation.data());
    if (!node.rotation.empty()) parts.rotation = quaternion(glm::make_vec4(node.rotation.data()));
    if (!node.scale.empty()) parts.scale = glm::make_vec3(node.scale.data());
    return parts;
}

void place_nodes(Document& document) {
    set_parents(document);
    document.order = with_descendants(document, roots_of(document));
    const std::vector<int>& order = document.order;
    // Every node has at most one parent, so what no root reaches lies on or below a cycle.
    require(order.size() == document.parents.size(), "the nodes form a cycle");

    std::vector<glm::dmat4>& matrices = document.matrices;
    for (const Node& node : document.model.nodes) {
        matrices.push_back(local_transform(node, document.warnings));
    }
    for (const int node : order) {
        require_usable(matrices[node], node);
        const int parent = document.parents[node];
        if (parent < 0) continue;
        matrices[node] = matrices[parent] * matrices[node];
        require_usable(matrices[node], node);
    }
}

std::vector<int> scene_nodes(Document& document, int scene) {
    const std::vector<tinygltf::Scene>& scenes = document.model.scenes;
    if (scene < 0) scene = std::max(document.model.defaultScene, 0);
    require(scene < static_cast<int>(std::max<std::size_t>(scenes.size(), 1)), "has no scene ",
            scene, ", it has ", scenes.size());
    if (scenes.empty()) {
        const std::vector<int> roots = roots_of(document);
        if (!roots.empty()) document.warnings.add("the file has no scene, all its nodes are taken");
        return with_descendants(document, roots);
    }
    std::vector<int> roots;
    std::vector<bool> listed(document.parents.size());
    for (const int root : scenes[scene].nodes) {
        require(document.parents[root] < 0, "scenes[", scene, "] lists nodes[", root,
                "], which is a child of nodes[", document.parents[root], "]");
        if (!listed[root]) roots.push_back(root);
        listed[root] = true;
    }
    return with_descendants(document, roots);
}

Attributes copies_of(const Node& node) {
    const tinygltf::Value* copies = extension(node.extensions, "EXT_mesh_gpu_instancing");
    if (!copies || node.mesh < 0) return {};
    Attributes accessors;
    const tinygltf::Value& attributes = copies->Get("attributes");
    for (const std::string& name : attributes.Keys()) {
        accessors[name] = index_in(attributes, name.c_str());
    }
    return accessors;
}

std::size_t copy_count(const Document& document, const Node& node) {
    const Attributes copies = copies_of(node);
    for (const char* name : {"TRANSLATION", "ROTATION", "SCALE"}) {
        const int accessor = attribute(copies, name);
        if (accessor >= 0) return document.model.accessors[accessor].count;
    }
    return 1;
}

std::vector<glm::dmat4> copy_transforms(const Document& document, const Node& node) {
    const Attributes copies = copies_of(node);
    if (copies.empty()) return {glm::dmat4(1.0)};
    const auto translation = reader_of(document, copies, "TRANSLATION");
    const auto rotation = reader_of(document, copies, "ROTATION");
    const auto scale = reader_of(document, copies, "SCALE");
    std::vector<glm::dmat4> transforms(copy_count(document, node));
    for (std::size_t i = 0; i < transforms.size(); ++i) {
        transforms[i] = node_matrix(translation ? translation->vector<3>(i) : glm::dvec3(0.0),
                                    quaternion(rotation ? rotation->vector<4>(i) : no_turn),
                                    scale ? scale->vector<3>(i) : glm::dvec3(1.0));
    }
    return transforms;
}

}  // namespace clgi::io::gltf
