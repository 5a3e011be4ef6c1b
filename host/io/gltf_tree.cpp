// SPDX-License-Identifier: MIT
#include "io/gltf_tree.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>

namespace clgi::io::gltf {

namespace {

// Far beyond any scene, far below where products of two such numbers overflow a double.
constexpr double largest_entry = 1e100;

std::string node_name(int node) { return "nodes[" + std::to_string(node) + "]"; }

void set_parents(std::vector<Node>& nodes) {
    for (int parent = 0; parent < static_cast<int>(nodes.size()); ++parent) {
        for (const int child : nodes[parent].children) {
            if (nodes[child].parent >= 0) {
                throw InputError(node_name(child) + " is a child twice, of " +
                                 node_name(nodes[child].parent) + " and " + node_name(parent));
            }
            nodes[child].parent = parent;
        }
    }
}

void require_usable(const glm::dmat4& matrix, int node) {
    for (int i = 0; i < 16; ++i) {
        if (!(std::abs(matrix[i / 4][i % 4]) <= largest_entry)) {
            throw InputError(node_name(node) + " has a transform that overflows");
        }
    }
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
    std::vector<Node>& nodes = document.nodes;
    set_parents(nodes);

    std::vector<int> order;
    for (int node = 0; node < static_cast<int>(nodes.size()); ++node) {
        if (nodes[node].parent < 0) order.push_back(node);
    }
    append_descendants(nodes, order, 0);
    // Every node has at most one parent, so what no root reaches lies on or below a cycle.
    if (order.size() != nodes.size()) throw InputError("the nodes form a cycle");

    for (const int node : order) {
        require_usable(nodes[node].matrix, node);
        if (nodes[node].parent < 0) continue;
        nodes[node].matrix = nodes[nodes[node].parent].matrix * nodes[node].matrix;
        require_usable(nodes[node].matrix, node);
    }
}

std::vector<int> scene_nodes(Document& document, int scene) {
    const std::vector<Node>& nodes = document.nodes;
    std::vector<int> order;
    if (document.scenes.empty()) {
        if (scene > 0) throw InputError("has no scene " + std::to_string(scene));
        for (int node = 0; node < static_cast<int>(nodes.size()); ++node) {
            if (nodes[node].parent < 0) order.push_back(node);
        }
        if (!order.empty()) document.warnings.add("the file has no scene, all its nodes are taken");
        append_descendants(nodes, order, 0);
        return order;
    }

    if (scene < 0) scene = std::max(document.default_scene, 0);
    if (scene >= static_cast<int>(document.scenes.size())) {
        throw InputError("has no scene " + std::to_string(scene) + ", it has " +
                         std::to_string(document.scenes.size()));
    }
    std::vector<bool> listed(nodes.size());
    for (const int root : document.scenes[scene].nodes) {
        if (nodes[root].parent >= 0) {
            throw InputError("scenes[" + std::to_string(scene) + "] lists " + node_name(root) +
                             ", which is a child of " + node_name(nodes[root].parent));
        }
        if (!listed[root]) order.push_back(root);
        listed[root] = true;
    }
    append_descendants(nodes, order, 0);
    return order;
}

}  // namespace clgi::io::gltf
