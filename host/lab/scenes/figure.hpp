// A human figure: its skeleton, the body around it, and how it stands.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>
#include <vector>

#include "lab/scenes/flesh.hpp"
#include "lab/scenes/rigging.hpp"

namespace clgi::generated::figure {

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

enum class Hands { gloves, bare };
Flesh figure_flesh(Hands hands);

struct Stance {
    glm::dvec3 pelvis;                          // metres
    std::array<glm::dquat, joint_count> turns;  // of each joint to its parent
};

// Two bones reach for each hand and foot. Vectors are those of the figure's world.
struct Moment {
    glm::dvec3 pelvis;                   // metres
    glm::dvec3 twist;                    // degrees: yaw of the pelvis, of the chest, its lean
    glm::dvec3 left_hand, right_hand;    // metres
    glm::dvec3 left_foot, right_foot;    // of the ankles
    glm::dvec3 left_elbow, right_elbow;  // where they bend out to
    glm::dvec3 left_knee, right_knee;
    glm::dquat left_sole, right_sole;  // turns of the feet
};
Stance stance_of(const Moment& moment);

glm::dquat about(const glm::dvec3& axis, double degrees);

// Nodes in the order of Joint, the first ones of the rig; a skin of them all.
int add_skeleton(Rig& rig);

// The stances as keys at equal steps, from the beginning of the clip to its end.
void play(Rig& rig, const std::vector<Stance>& stances);

}  // namespace clgi::generated::figure
