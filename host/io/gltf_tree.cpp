// SPDX-License-Identifier: MIT
#include "io/gltf_tree.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

// Far beyond any scene, far below where products of two such numbers overflow a double.
constexpr double largest_entry = 1e100;

glm::dvec3 vec3_or(const std::vector<double>& numbers, double fallback) {
    return numbers.empty() ? glm::dvec3(fallback) : glm::dvec3(numbers[0], numbers[1], numbers[2]);
}

glm::dmat4 local_transform(const Node& node, Warnings& warnings) {
    if (!node.matrix.empty()) {
        const std::vector<double>& m = node.matrix;  // by columns, as glm has them
        glm::dmat4 transform = glm::make_mat4(m.data());
        if (m[3] != 0.0 || m[7] != 0.0 || m[11] != 0.0 || m[15] != 1.0) {
            warnings.add("a node matrix with a projective row is read without it");
            for (int column = 0; column < 4; ++column) transform[column][3] = column == 3;
        }
        return transform;
    }
    glm::dquat rotation(1.0, 0.0, 0.0, 0.0);
    if (!node.rotation.empty()) {
        const std::vector<double>& q = node.rotation;
        const glm::dquat read(q[3], q[0], q[1], q[2]);
        const double length = glm::length(read);
        if (length > 1e-6 && length < 1e6) {
            rotation = read / length;
        } else {
            warnings.add("a node rotation that is no quaternion is ignored");
        }
    }
    const glm::dvec3 scale = vec3_or(node.scale, 1.0);
    glm::dmat4 transform = glm::mat4_cast(rotation);
    for (int column = 0; column < 3; ++column) transform[column] *= scale[column];
    transform[3] = glm::dvec4(vec3_or(node.translation, 0.0), 1.0);
    return transform;
}

void set_parents(Document& document) {
    const std::vector<Node>& nodes = document.model.nodes;
    document.parents.assign(nodes.size(), -1);
    for (int parent = 0; parent < static_cast<int>(nodes.size()); ++parent) {
        for (const int child : nodes[parent].children) {
            if (document.parents[child] >= 0) {
                refuse(entry("nodes", child), "is a child twice, of " +
                                                  entry("nodes", document.parents[child]) +
                                                  " and " + entry("nodes", parent));
            }
            document.parents[child] = parent;
        }
    }
}

void require_usable(const glm::dmat4& matrix, int node) {
    for (int i = 0; i < 16; ++i) {
        if (!(std::abs(matrix[i / 4][i % 4]) <= largest_entry)) {
            refuse(entry("nodes", node), "has a transform that overflows");
        }
    }
}

std::vector<int> roots_of(const Document& document) {
    std::vector<int> roots;
    for (int node = 0; node < static_cast<int>(document.parents.size()); ++node) {
        if (document.parents[node] < 0) roots.push_back(node);
    }
    return roots;
}

// Appends the subtrees below the nodes from `first` on, parents before children.
void append_descendants(const std::vector<Node>& nodes, std::vector<int>& order,
                        std::size_t first) {
    for (std::size_t next = first; next < order.size(); ++next) {
        const std::vector<int>& children = nodes[order[next]].children;
        order.insert(order.end(), children.begin(), children.end());
    }
}

}  // namespace

void place_nodes(Document& document) {
    const std::vector<Node>& nodes = document.model.nodes;
    set_parents(document);

    std::vector<int> order = roots_of(document);
    append_descendants(nodes, order, 0);
    // Every node has at most one parent, so what no root reaches lies on or below a cycle.
    if (order.size() != nodes.size()) throw InputError("the nodes form a cycle");

    std::vector<glm::dmat4>& matrices = document.matrices;
    for (const Node& node : nodes) {
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
    const std::vector<Node>& nodes = document.model.nodes;
    const std::vector<tinygltf::Scene>& scenes = document.model.scenes;
    if (scenes.empty()) {
        if (scene > 0) throw InputError("has no scene " + std::to_string(scene));
        std::vector<int> order = roots_of(document);
        if (!order.empty()) document.warnings.add("the file has no scene, all its nodes are taken");
        append_descendants(nodes, order, 0);
        return order;
    }

    if (scene < 0) scene = std::max(document.model.defaultScene, 0);
    if (scene >= static_cast<int>(scenes.size())) {
        throw InputError("has no scene " + std::to_string(scene) + ", it has " +
                         std::to_string(scenes.size()));
    }
    std::vector<int> order;
    std::vector<bool> listed(nodes.size());
    for (const int root : scenes[scene].nodes) {
        if (document.parents[root] >= 0) {
            refuse(entry("scenes", scene), "lists " + entry("nodes", root) +
                                               ", which is a child of " +
                                               entry("nodes", document.parents[root]));
        }
        if (!listed[root]) order.push_back(root);
        listed[root] = true;
    }
    append_descendants(nodes, order, 0);
    return order;
}

}  // namespace clgi::io::gltf
