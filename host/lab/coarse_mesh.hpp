// Coarse blockers for the program: clgi::mesh, which a build may be without.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace clgi::lab {

bool can_simplify();

// mesh::simplify. Throws Error in a build without clgi::mesh.
std::vector<glm::uvec3> coarse_mesh(const Scene& scene, std::size_t triangles);

}  // namespace clgi::lab
