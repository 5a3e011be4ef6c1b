// SPDX-License-Identifier: MIT
#include "reference/geometry.hpp"

namespace clgi::reference {

Geometry::Geometry(const Scene& scene)
    : normals(scene.normals),
      uvs(scene.uvs),
      colors(scene.colors),
      triangles(scene.triangles),
      materials(scene.materials),
      textures(scene.textures) {
    const Bounds box = bounds(scene);
    origin = 0.5 * (box.low + box.high);
    const double radius = 0.5 * glm::length(box.high - box.low);
    scale = radius > 0.0 ? 1.0 / radius : 1.0;
    positions.reserve(scene.positions.size());
    for (const glm::dvec3& position : scene.positions) positions.push_back(to_local(position));
    for (const SceneTriangle& triangle : triangles)
        blended = blended || materials[triangle.material].alpha_mode == AlphaMode::blend;
}

}  // namespace clgi::reference
