// Runs of thirds of leaves at vertices, each of which is a point where it is seen from far away.
// [derived]
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/elements.hpp>
#include <cstdint>
#include <span>
#include <vector>

#include "antiradiance/vertex_cells.hpp"

namespace clgi {

struct ThirdGroup {
    glm::dvec3 middle{0.0};            // metres, weighted by area
    glm::dvec3 vector_area{0.0};       // m^2, of fronts
    double square_radius = 0.0;        // m^2, of the sphere around the middle that holds the group
    std::uint32_t first = 0, end = 0;  // thirds of the tree
};

class ThirdGroups {
public:
    explicit ThirdGroups(const ElementTree& tree) {
        if (tree.first_thirds.empty()) return;
        for (std::size_t i = 0; i < tree.count(); ++i) {
            first_.push_back(groups_.size());
            for (std::uint32_t k = tree.first_thirds[i]; k < tree.first_thirds[i + 1]; k += most)
                groups_.push_back(group(tree, k, std::min(k + most, tree.first_thirds[i + 1])));
            glm::dvec3 turned(0.0);
            for (std::size_t g = first_.back(); g < groups_.size(); ++g)
                turned += groups_[g].vector_area;
            flatness_.push_back(glm::length(turned) / tree.areas[i]);
        }
        first_.push_back(groups_.size());
    }

    // Vector area over area of a leaf at a vertex: from afar it is as large as that.
    double flatness(std::size_t leaf) const { return flatness_[leaf]; }

    // Of a leaf at a vertex.
    std::span<const ThirdGroup> of(std::size_t leaf) const {
        return {groups_.data() + first_[leaf], groups_.data() + first_[leaf + 1]};
    }

private:
    static constexpr std::uint32_t most = 12;  // thirds of about two vertices

    static ThirdGroup group(const ElementTree& tree, std::uint32_t first, std::uint32_t end) {
        ThirdGroup out;
        out.first = first;
        out.end = end;
        double area = 0.0;
        for (std::uint32_t k = first; k < end; ++k) {
            const glm::dvec3 turned = vector_area(tree.thirds[k]);
            area += glm::length(turned);
            out.middle += glm::length(turned) * centroid(tree.thirds[k]);
            out.vector_area += turned;
        }
        out.middle /= area;
        for (std::uint32_t k = first; k < end; ++k)
            out.square_radius =
                std::max(out.square_radius, square_reach(tree.thirds[k], out.middle));
        return out;
    }

    std::vector<ThirdGroup> groups_;
    std::vector<std::size_t> first_;  // [elements + 1]
    std::vector<double> flatness_;    // [elements]
};

}  // namespace clgi
