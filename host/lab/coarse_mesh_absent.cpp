// Coarse blockers in a build without clgi::mesh.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "lab/coarse_mesh.hpp"

namespace clgi::lab {

bool can_simplify() { return false; }

std::vector<glm::uvec3> coarse_mesh(const Scene&, std::size_t) {
    throw Error("coarse mesh: this clgi was built without clgi::mesh (CLGI_MESH)");
}

}  // namespace clgi::lab
