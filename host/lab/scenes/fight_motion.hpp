// How the fighting figure stands at a time.
// SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenes/figure.hpp"

namespace clgi::generated::fight {

constexpr double clip_length = 3.2;  // seconds

// Guard, a jab of the left, a cross of the right, guard, a kick of the right foot. Fists and feet
// follow smooth curves; two bones reach for each of them. The clip begins as it ends.
figure::Stance stance_at(double seconds);

}  // namespace clgi::generated::fight
