// SPDX-License-Identifier: MIT
#include "methods/antiradiance/moving_triangles.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <string>

#include "methods/antiradiance/patch_weights.hpp"

namespace clgi {
namespace {

// Of the scene's size: where floats of the local frame have their last bit. An animator writes all
// vertices of what it moves, and rounds those that stay as well.
constexpr double least_move = 1.0 / (1 << 22);

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

std::vector<std::uint8_t> moving_triangles(const Scene& scene, const VertexPoses& poses) {
    const Bounds box = bounds(scene);
    const double least = least_move * glm::length(box.high - box.low);
    std::vector<std::uint8_t> vertices(scene.positions.size(), 0);
    for (std::size_t pose = 0; pose < poses.size(); ++pose) {
        if (poses[pose].size() != scene.positions.size())
            throw Error("make_elements: pose " + std::to_string(pose) + " has " +
                        std::to_string(poses[pose].size()) + " vertices, the scene has " +
                        std::to_string(scene.positions.size()));
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            if (!is_finite(poses[pose][v]))
                throw InputError("make_elements: vertex " + std::to_string(v) + " of pose " +
                                 std::to_string(pose) + " is not finite");
            if (glm::distance(poses[pose][v], scene.positions[v]) > least) vertices[v] = 1;
        }
    }
    std::vector<std::uint8_t> out;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (const std::uint32_t vertex : scene.triangles[t].vertex)
            if (vertices[vertex] != 0) {
                if (out.empty()) out.assign(scene.triangles.size(), 0);
                out[t] = 1;
            }
    return out;
}

std::vector<glm::dvec3> centroids(const std::vector<Face>& faces, const Scene& scene,
                                  const std::vector<glm::dvec3>& positions) {
    std::vector<glm::dvec3> out;
    out.reserve(faces.size());
    for (const Face& face : faces)
        out.push_back(centroid(triangle_corners(scene.triangles[face.triangle], positions)));
    return out;
}

}  // namespace clgi
