// Boxes around runs of triangles, and their corners side by side, as kernels/scene/clusters.cl
// computes them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/scene.h>
#include <vector>

namespace clgi {

// triangles: three vertices and the fourth word of each. positions: local frame, finite.
std::vector<Cluster> make_clusters(const std::vector<glm::uvec4>& triangles,
                                   const std::vector<glm::vec4>& positions);

// [clusters][CLUSTER_PARTS] of as many clusters.
std::vector<PartCorners> make_parts(const std::vector<glm::uvec4>& triangles,
                                    const std::vector<glm::vec4>& positions);

}  // namespace clgi
