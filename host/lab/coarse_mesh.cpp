// SPDX-License-Identifier: MIT
#include "lab/coarse_mesh.hpp"

#include <clgi/mesh/simplify.hpp>

namespace clgi::lab {

bool can_simplify() { return true; }

std::vector<glm::uvec3> coarse_mesh(const Scene& scene, std::size_t triangles) {
    return mesh::simplify(scene, triangles);
}

}  // namespace clgi::lab
