// Repairs slivers of a coarse mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>
#include <vector>

namespace clgi::mesh {

// A collapse may leave a triangle that is nearly a line, and such a triangle may face anywhere,
// even backwards. Its edge is then flipped: the two triangles of a quadrilateral take the other
// diagonal. Flips edges between triangles that face away from the surface, as long as the worse of
// the two comes nearer to facing with it. An edge is flipped only if the new one is not there yet,
// so closed meshes stay closed. normals: unit vectors of the fine surface, for every vertex.
void flip_edges(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals,
                std::vector<unsigned int>& indices);

}  // namespace clgi::mesh
