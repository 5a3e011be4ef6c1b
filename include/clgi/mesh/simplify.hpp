// Coarse meshes on the vertices of fine ones, for blockers that are far away
// (clgi/advanced/blocker_levels.hpp). On meshoptimizer: the component clgi::mesh.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace clgi::mesh {

// About `triangles` triangles with vertices of the scene that stand for all of its triangles, piece
// by piece. Edges are collapsed by their quadric error [Garland97] in the pose that the scene has;
// animation is not looked at. For a mesh that bends much, give the scene in a typical pose
// (clgi::posed): the vertices keep their numbers.
//
// Vertices in one place are welded first, so seams of UVs and normals do not stop a collapse. Every
// connected piece (clgi/advanced/adjacency.hpp) gets a share in proportion to its triangles, but at
// least 4, so the result has more triangles than asked for when there are many small pieces. It
// also has more where every further collapse would turn a triangle over or change how the piece is
// connected, such as closing a hole or opening a border. A piece with no more triangles than its
// share is kept as it is.
//
// Closed pieces stay closed; borders stay borders, and move as little as surfaces. No collapse
// turns a triangle over, and edges of slivers that face away from the surface are flipped.
// Triangles without area are left out, those of the scene as well.
// Throws InputError as validate() does for triangles and positions.
CLGI_API std::vector<glm::uvec3> simplify(const Scene& scene, std::size_t triangles);

}  // namespace clgi::mesh
