// SPDX-License-Identifier: MIT
#include "methods/antiradiance/faces.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <string>
#include <utility>

namespace clgi {
namespace {

constexpr double spacings = 2.0;  // within which vertices are welded (clgi/advanced/adjacency.hpp)

void check_materials(const Scene& scene) {
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        if (scene.triangles[t].material >= scene.materials.size())
            throw InputError("make_elements: triangle " + std::to_string(t) + " has material " +
                             std::to_string(scene.triangles[t].material) + ", there are " +
                             std::to_string(scene.materials.size()));
}

// [pieces] 1: every edge has two triangles, wound alike.
std::vector<std::uint8_t> closed_pieces(const Adjacency& mesh) {
    std::vector<std::uint8_t> out(mesh.piece_count, 1);
    for (const MeshEdge& edge : mesh.edges)
        if (edge.kind != EdgeKind::manifold)
            out[mesh.pieces[mesh.uses[edge.first_use].triangle]] = 0;
    return out;
}

// The least height that floats could tell from none, for corners this far from the scene's middle.
double least_height(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& middle) {
    double size = 0.0;
    for (const glm::dvec3& corner : corners)
        for (int axis = 0; axis < 3; ++axis)
            size = std::max(size, std::abs(corner[axis] - middle[axis]));
    return size > 0.0 ? spacings * std::ldexp(1.0, std::ilogb(size) - 23) : 0.0;
}

}  // namespace

bool is_thin(const std::array<glm::dvec3, 3>& p, const glm::dvec3& middle) {
    const double longest =
        std::max({glm::length(p[1] - p[0]), glm::length(p[2] - p[1]), glm::length(p[0] - p[2])});
    const double twice = glm::length(glm::cross(p[1] - p[0], p[2] - p[0]));
    return !(longest > 0.0 && twice / longest > least_height(p, middle));
}

Faces make_faces(const Scene& scene, bool backs) {
    check_materials(scene);
    Adjacency mesh = adjacency(scene);
    const std::vector<std::uint8_t> closed = closed_pieces(mesh);
    const Bounds box = bounds(scene);
    const glm::dvec3 middle = 0.5 * (box.low + box.high);

    Faces out;
    out.faces.reserve(scene.triangles.size());
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
        std::array<glm::dvec3, 3> p;
        for (int k = 0; k < 3; ++k) p[k] = scene.positions[scene.triangles[t].vertex[k]];
        const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double twice = glm::length(across);
        if (is_thin(p, middle) || mesh.pieces[t] == no_index) {
            ++out.skipped;
            out.skipped_area += 0.5 * twice;
            continue;
        }
        const Face front{p, across / twice, 0.5 * twice, t, false};
        out.faces.push_back(front);
        const bool both = scene.materials[scene.triangles[t].material].double_sided;
        if (backs && (both || !closed[mesh.pieces[t]]))
            out.faces.push_back({{p[0], p[2], p[1]}, -front.normal, front.area, t, true});
    }
    out.mesh = std::move(mesh);
    return out;
}

}  // namespace clgi
