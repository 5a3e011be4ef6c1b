// What an animation drives: nodes, and the vertices and lights that follow them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

// What some clip moves away from where it rests. A curve that holds the resting value throughout
// moves nothing.
struct MovingParts {
    std::vector<std::uint8_t> nodes;    // [nodes] or one above them
    std::vector<std::uint8_t> weights;  // [nodes] of their morph targets
};
MovingParts moving_parts(const Animation& animation);

// [vertices of the scene] 1: something that moves has a share in it; empty where nothing has.
std::vector<std::uint8_t> moving_vertices(const Scene& scene);

// Whether a vertex of the triangle is one of them.
bool follows(const SceneTriangle& triangle, const std::vector<std::uint8_t>& moving);

}  // namespace clgi
