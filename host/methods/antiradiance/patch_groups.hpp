// Vertex patches of leaves at vertices in groups of groups, each of which is a point where it is
// seen from far away. [derived]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <cstdint>
#include <span>
#include <vector>

namespace clgi {

struct PatchGroup {
    glm::dvec3 middle{0.0};            // metres, weighted by area
    glm::dvec3 vector_area{0.0};       // m^2, of fronts
    double square_radius = 0.0;        // m^2, of a sphere around the middle that holds all of it
    std::uint32_t next = 0;            // of its leaf: the first group that is no part of this one
    std::uint32_t first = 0, end = 0;  // in vertex patches(); equal: it is made of groups
};

class PatchGroups {
public:
    PatchGroups() = default;  // of a tree without leaves at vertices
    // threads: 0: one for each core. Groups are the same for all of them.
    explicit PatchGroups(const ElementTree& tree, int threads = 1);

    // Of a leaf at a vertex, depth-first: the first one is all of it. The last ones have up to four
    // vertex patches each.
    std::span<const PatchGroup> of(std::size_t leaf) const {
        return {groups_.data() + first_[leaf], groups_.data() + first_[leaf + 1]};
    }

    // Numbers of vertex patches of the tree, those of a group next to each other.
    const std::vector<std::uint32_t>& vertex_patches() const { return vertex_patches_; }

    // Vector area over area of a leaf at a vertex: from afar it is as large as that.
    double flatness(std::size_t leaf) const { return flatness_[leaf]; }

private:
    std::vector<PatchGroup> groups_;
    std::vector<std::uint32_t> vertex_patches_;
    std::vector<std::size_t> first_;  // [elements + 1]
    std::vector<double> flatness_;    // [elements]
};

}  // namespace clgi
