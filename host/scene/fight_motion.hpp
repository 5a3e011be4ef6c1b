// The skeleton of the fighting figure, and how it stands at a time.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace clgi::generated::fight {

constexpr double clip_length = 3.2;  // seconds

enum Joint : std::uint32_t {
    pelvis,
    spine,
    chest,
    head,
    left_arm,
    left_forearm,
    left_hand,
    right_arm,
    right_forearm,
    right_hand,
    left_thigh,
    left_shin,
    left_foot,
    right_thigh,
    right_shin,
    right_foot,
    joint_count
};

// At rest the figure faces +Z, its left is +X; arms are held away from the body.
extern const char* const joint_names[joint_count];
extern const int joint_parents[joint_count];
extern const std::array<glm::dvec3, joint_count> joint_places;  // metres

struct Stance {
    glm::dvec3 pelvis;                          // metres
    std::array<glm::dquat, joint_count> turns;  // of each joint to its parent
};

// Guard, a jab of the left, a cross of the right, guard, a kick of the right foot. Fists and feet
// follow smooth curves; two bones reach for each of them. The clip begins as it ends.
Stance stance_at(double seconds);

}  // namespace clgi::generated::fight
