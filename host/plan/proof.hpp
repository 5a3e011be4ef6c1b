// What is proven about a scene: between which points nothing lies.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

#include "scene/local_triangles.hpp"

namespace clgi {

// triangles: those of the scene, which stands still. emissive: those of them that emit.
// `lights_open` is for lights that stand still.
OpennessProof prove_openness(const Scene& scene, const std::vector<LocalTriangle>& triangles,
                             const std::vector<std::uint32_t>& emissive);

}  // namespace clgi
