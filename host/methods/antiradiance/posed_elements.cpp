// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/animation.hpp>
#include <clgi/advanced/moving_elements.hpp>
#include <clgi/error.hpp>
#include <string>

#include "methods/antiradiance/faces.hpp"
#include "methods/antiradiance/patch_weights.hpp"

namespace clgi {
namespace {

void place_patch(const Scene& scene, const std::vector<glm::dvec3>& positions,
                 const glm::dvec3& middle, const PatchWeights& weights, std::size_t i,
                 ElementTree& out) {
    const auto p = triangle_corners(scene.triangles[out.triangles[i]], positions);
    for (std::size_t k = 0; k < 3; ++k)
        out.corners[i][k] = p[0] + weights[k].x * (p[1] - p[0]) + weights[k].y * (p[2] - p[0]);
    out.positions[i] = centroid(out.corners[i]);
    out.radii[i] = 0.0;
    for (const glm::dvec3& corner : out.corners[i])
        out.radii[i] = std::max(out.radii[i], glm::distance(corner, out.positions[i]));
    out.normals[i] = glm::dvec3(0.0);
    out.areas[i] = 0.0;
    if (is_thin(p, middle)) return;
    const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
    const double share = signed_share(weights);
    out.normals[i] = glm::normalize(share < 0.0 ? -across : across);
    out.areas[i] = 0.5 * glm::length(across) * std::abs(share);
}

// Children come after their parents. Where all have collapsed it is in their middle.
void place_cluster(std::size_t i, ElementTree& out) {
    glm::dvec3 sum(0.0), plain(0.0);
    double area = 0.0, number = 0.0;
    for (std::size_t c = i + 1; c < out.ends[i]; c = out.ends[c]) {
        sum += out.areas[c] * out.positions[c];
        area += out.areas[c];
        plain += out.positions[c];
        number += 1.0;
    }
    out.areas[i] = area;
    out.positions[i] = area > 0.0 ? sum / area : plain / number;
    out.normals[i] = glm::dvec3(0.0);
    out.radii[i] = 0.0;
}

}  // namespace

VertexPoses vertex_poses(const Scene& scene, std::size_t clip, int count) {
    if (count < 1 || count > 1000)
        throw Error("vertex_poses: count is " + std::to_string(count) + ", 1 to 1000 needed");
    if (!scene.animation) throw Error("vertex_poses: the scene has no animation");
    const Animation& animation = *scene.animation;
    if (clip >= animation.clips.size())
        throw Error("vertex_poses: clip is " + std::to_string(clip) + ", there are " +
                    std::to_string(animation.clips.size()));
    VertexPoses out;
    if (animation.ranges.empty()) return out;
    for (int k = 0; k < count; ++k) {
        const double share = count > 1 ? static_cast<double>(k) / (count - 1) : 0.0;
        out.push_back(posed(scene, pose_at(animation, clip, share * animation.clips[clip].duration))
                          .positions);
    }
    return out;
}

ElementTree posed_elements(const ElementTree& tree, const Scene& scene,
                           const std::vector<glm::dvec3>& positions) {
    if (positions.size() != scene.positions.size())
        throw Error("posed_elements: " + std::to_string(positions.size()) +
                    " positions, the scene has " + std::to_string(scene.positions.size()));
    ElementTree out = tree;
    if (tree.moving.empty()) return out;
    const Bounds box = bounds(scene);
    const glm::dvec3 middle = 0.5 * (box.low + box.high);
    for (std::size_t i = tree.count(); i-- > 0;) {
        if (!tree.moves(i)) continue;
        if (tree.is_patch(i))
            place_patch(scene, positions, middle, patch_weights(tree, i, scene), i, out);
        else
            place_cluster(i, out);
    }
    for (std::size_t i = 0; i < tree.count(); ++i) {
        const std::uint32_t parent = tree.parents[i];
        if (!tree.is_patch(i) || (parent != no_index && tree.is_patch(parent))) continue;
        for (std::uint32_t above = parent; above != no_index; above = tree.parents[above])
            for (const glm::dvec3& corner : out.corners[i])
                if (tree.moves(above))
                    out.radii[above] =
                        std::max(out.radii[above], glm::distance(corner, out.positions[above]));
    }
    return out;
}

}  // namespace clgi
