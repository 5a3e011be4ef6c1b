// The matrices that place the vertices of a range.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/animation.hpp>
#include <vector>

namespace clgi {

// From rest positions, which are relative to the range's centre, to the world: one for each joint
// of its skin, the last for what follows no joint.
std::vector<glm::dmat4> range_matrices(const Animation& animation, const PosedRange& range,
                                       const Pose& pose);

}  // namespace clgi
