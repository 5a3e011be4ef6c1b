// The middles of a scene's triangles, in double precision, as places for the path tracer.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <vector>

namespace clgi::test {

// Front sides. A shading normal that faces away from the triangle gives way to the triangle's.
inline std::vector<reference::Place> centroids(const Scene& scene) {
    std::vector<reference::Place> out;
    for (const SceneTriangle& t : scene.triangles) {
        const glm::dvec3 a = scene.positions[t.vertex[0]], b = scene.positions[t.vertex[1]],
                         c = scene.positions[t.vertex[2]];
        const glm::dvec3 wound = glm::normalize(glm::cross(b - a, c - a));
        glm::dvec3 normal(0.0);
        for (const std::uint32_t v : t.vertex) normal += glm::dvec3(scene.normals[v]);
        if (!(glm::dot(normal, wound) > 0.0)) normal = wound;
        out.push_back({(a + b + c) / 3.0, glm::normalize(normal), wound});
    }
    return out;
}

}  // namespace clgi::test
