// The bust of a woman: a closed surface of 6,472 vertices and 12,940 triangles, as many triangles
// as the bust of [Dachsbacher07].
// SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenes/solids.hpp"

namespace clgi::generated {

// Faces +Z, stands at y = 0, 0.52 m high before it is scaled.
void add_bust(Scene& scene, const Placement& at, double scale, std::uint32_t material);

}  // namespace clgi::generated
