// SPDX-License-Identifier: MIT
#include "methods/antiradiance/refine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "methods/antiradiance/motion_refine.hpp"
#include "methods/antiradiance/vertex_cells.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

constexpr double rough = 2e-3;  // flat clusters are by 1e-3, as a share of a distance

}  // namespace

double Refine::seen(std::size_t element, std::size_t from) const {
    if (motion_ && motion_->moves(element, from)) return motion_->seen(element, from);
    const glm::dvec3 way = tree_.positions[from] - tree_.positions[element];
    const double distance = glm::length(way), radius = tree_.radii[element];
    if (distance <= radius + tree_.radii[from]) return std::numeric_limits<double>::infinity();
    const double angle =
        std::min(tree_.areas[element], pi * radius * radius) / (distance * distance);
    if (!tree_.is_flat(element)) return angle;
    const double height = std::abs(glm::dot(tree_.normals[element], way)) + tree_.radii[from];
    return angle * std::min(1.0, height / distance);
}

bool Refine::below(std::size_t leaf, const glm::dvec3& normal, const glm::dvec3& position,
                   double height) const {
    const std::span<const PatchGroup> groups = groups_.of(leaf);
    for (std::size_t g = 0; g < groups.size();) {
        const PatchGroup& group = groups[g++];
        const double least = height - glm::dot(normal, group.middle - position);
        if (least >= 0.0 && group.square_radius <= least * least) {
            g = group.next;
            continue;
        }
        for (std::uint32_t k = group.first; k < group.end; ++k)
            for (const glm::dvec3& corner :
                 outline(tree_.vertex_patches[groups_.vertex_patches()[k]]))
                if (glm::dot(normal, corner - position) > height) return false;
    }
    return true;
}

bool Refine::hidden(std::size_t sender, std::size_t receiver) const {
    if (motion_ && motion_->moves(sender, receiver)) return motion_->hidden(sender, receiver);
    if (!tree_.is_flat(receiver)) return false;
    const glm::dvec3& normal = tree_.normals[receiver];
    const glm::dvec3 way = tree_.positions[sender] - tree_.positions[receiver];
    const double height = glm::dot(normal, way);
    const auto top_of = [&](const auto& corners) {
        double top = -std::numeric_limits<double>::infinity();
        for (const glm::dvec3& corner : corners)
            top = std::max(top, glm::dot(normal, corner - tree_.positions[receiver]));
        return top;
    };
    const double rise = tree_.is_patch(receiver) || tree_.is_leaf(receiver) ? least_rise : rough;
    if (tree_.is_patch(sender)) return top_of(tree_.corners[sender]) <= rise * glm::length(way);
    if (tree_.is_vertex(sender)) {
        // Its position lies between its corners.
        if (height > rise * glm::length(way)) return false;
        if (height + tree_.radii[sender] <= rise * glm::length(way)) return true;
        return below(sender, normal, tree_.positions[receiver], rise * glm::length(way));
    }
    if (!tree_.is_flat(sender)) return height + tree_.radii[sender] <= 0.0;
    const double tilt = glm::length(glm::cross(normal, tree_.normals[sender]));
    return height + tree_.radii[sender] * tilt <= rough * glm::length(way);
}

bool Refine::passes(std::size_t sender, std::size_t receiver) const {
    if (motion_ && motion_->moves(sender, receiver)) return motion_->passes(sender, receiver);
    if (!tree_.is_flat(sender)) return true;
    const glm::dvec3 way = tree_.positions[receiver] - tree_.positions[sender];
    return glm::dot(tree_.normals[sender], way) <= 0.0;
}

double Refine::radius(std::size_t i) const { return motion_ ? motion_->radius(i) : tree_.radii[i]; }

bool Refine::far_apart(std::size_t a, std::size_t b) const {
    if (motion_ && motion_->moves(a, b)) return motion_->far_apart(a, b);
    return glm::distance(tree_.positions[a], tree_.positions[b]) * least_ahead >
           tree_.radii[a] + tree_.radii[b];
}

bool Refine::operator()(ElementPair& pair, std::vector<ElementPair>& children) const {
    const std::uint32_t a = pair.a, b = pair.b;
    if (a == b) {
        if (tree_.is_flat(a)) return false;
        for (std::uint32_t c = a + 1; c < tree_.ends[a]; c = tree_.ends[c]) {
            children.push_back({c, c, true, true});
            for (std::uint32_t d = tree_.ends[c]; d < tree_.ends[a]; d = tree_.ends[d])
                children.push_back({c, d, true, true});
        }
        return false;
    }
    pair.to_a = pair.to_a && !hidden(b, a);
    pair.to_b = pair.to_b && !hidden(a, b);
    if (!pair.to_a && !pair.to_b) return false;

    const bool apart =
        far_apart(a, b) || (!(pair.to_b && passes(a, b)) && !(pair.to_a && passes(b, a)));
    const bool cut_a = !tree_.is_leaf(a) && (!apart || seen(a, b) > limit_);
    const bool cut_b = !tree_.is_leaf(b) && (!apart || seen(b, a) > limit_);
    if (!cut_a && !cut_b) return true;
    if (cut_a && (!cut_b || radius(a) >= radius(b))) {
        for (std::uint32_t c = a + 1; c < tree_.ends[a]; c = tree_.ends[c])
            children.push_back({c, b, pair.to_a, pair.to_b});
    } else {
        for (std::uint32_t c = b + 1; c < tree_.ends[b]; c = tree_.ends[c])
            children.push_back({a, c, pair.to_a, pair.to_b});
    }
    return false;
}

}  // namespace clgi
