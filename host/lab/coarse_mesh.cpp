// SPDX-License-Identifier: MIT
#include "lab/coarse_mesh.hpp"

#ifdef CLGI_HAS_MESH
#include <clgi/mesh/simplify.hpp>
#else
#include <clgi/error.hpp>
#endif

namespace clgi::lab {

#ifdef CLGI_HAS_MESH
bool can_simplify() { return true; }

std::vector<glm::uvec3> coarse_mesh(const Scene& scene, std::size_t triangles) {
    return mesh::simplify(scene, triangles);
}
#else
bool can_simplify() { return false; }

std::vector<glm::uvec3> coarse_mesh(const Scene&, std::size_t) {
    throw Error("coarse mesh: this clgi was built without clgi::mesh (CLGI_MESH)");
}
#endif

}  // namespace clgi::lab
