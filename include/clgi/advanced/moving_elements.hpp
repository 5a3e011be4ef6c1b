// Elements of geometry that moves: poses of a scene, and its elements in them.
// [Dachsbacher07, section 3.3]
//
// Elements and links of a motion are made once, for all of its poses. What moves is then brought to
// where it is by MovingElementPasses (clgi/passes/moving_elements.hpp).
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <vector>

namespace clgi {

// The scene's vertices at `count` times, evenly spread over a clip from its start to its end: the
// more, the shorter the ways between them. Empty where the clip moves no vertex. Throws Error if
// there is no such clip, and for a count outside 1 to 1000.
CLGI_API VertexPoses vertex_poses(const Scene& scene, std::size_t clip, int count);

// The tree with its elements where `positions`, of the scene's vertices, put them: triangles cut as
// they were, the same clusters. A patch that has no normal there has a normal and an area of zero.
// scene: what the tree was made from. Throws Error for another number of vertices.
CLGI_API ElementTree posed_elements(const ElementTree& tree, const Scene& scene,
                                    const std::vector<glm::dvec3>& positions);

}  // namespace clgi
