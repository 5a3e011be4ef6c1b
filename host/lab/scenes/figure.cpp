// SPDX-License-Identifier: MIT
#include "lab/scenes/figure.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace clgi::generated::figure {

const char* const joint_names[joint_count] = {
    "pelvis",    "spine",       "chest",         "head",       "left arm",   "left forearm",
    "left hand", "right arm",   "right forearm", "right hand", "left thigh", "left shin",
    "left foot", "right thigh", "right shin",    "right foot"};

const int joint_parents[joint_count] = {-1, 0, 1, 2, 2, 4, 5, 2, 7, 8, 0, 10, 11, 0, 13, 14};

const std::array<glm::dvec3, joint_count> joint_places = {{{0.0, 0.95, 0.0},
                                                           {0.0, 1.08, 0.0},
                                                           {0.0, 1.22, 0.0},
                                                           {0.0, 1.49, 0.0},
                                                           {0.185, 1.415, -0.01},
                                                           {0.385, 1.215, -0.01},
                                                           {0.575, 1.025, -0.01},
                                                           {-0.185, 1.415, -0.01},
                                                           {-0.385, 1.215, -0.01},
                                                           {-0.575, 1.025, -0.01},
                                                           {0.095, 0.92, 0.0},
                                                           {0.125, 0.50, 0.008},
                                                           {0.150, 0.086, -0.01},
                                                           {-0.095, 0.92, 0.0},
                                                           {-0.125, 0.50, 0.008},
                                                           {-0.150, 0.086, -0.01}}};

Flesh figure_flesh(Hands hands) {
    Flesh out;
    out.blend = 0.016;
    const auto middle = [&](std::uint32_t of, const glm::dvec3& a, const glm::dvec3& b, double p,
                            double q) {
        out.bones.push_back({of, a, b, p, q});
    };
    const auto pair = [&](std::uint32_t left, std::uint32_t right, const glm::dvec3& a,
                          const glm::dvec3& b, double p,
                          double q) { out.add_pair(left, right, a, b, p, q); };
    pair(pelvis, pelvis, {0.0, 0.95, 0.005}, {0.070, 0.935, 0.0}, 0.095, 0.085);
    pair(pelvis, pelvis, {0.070, 0.90, -0.045}, {0.075, 0.88, -0.04}, 0.066, 0.060);
    pair(spine, spine, {0.035, 1.03, 0.010}, {0.045, 1.17, 0.010}, 0.086, 0.088);
    pair(chest, chest, {0.055, 1.24, 0.0}, {0.075, 1.36, -0.005}, 0.092, 0.090);
    pair(chest, chest, {0.075, 1.325, 0.060}, {0.100, 1.345, 0.050}, 0.047, 0.042);
    pair(chest, chest, {0.100, 1.24, -0.035}, {0.125, 1.35, -0.03}, 0.050, 0.055);
    pair(chest, chest, {0.030, 1.455, -0.015}, {0.135, 1.425, -0.012}, 0.042, 0.042);
    middle(head, {0.0, 1.42, -0.01}, {0.0, 1.54, 0.003}, 0.055, 0.052);
    middle(head, {0.0, 1.605, 0.0}, {0.0, 1.648, -0.008}, 0.078, 0.084);
    middle(head, {0.0, 1.545, 0.040}, {0.0, 1.555, 0.045}, 0.042, 0.046);

    const glm::dvec3 along = glm::normalize(joint_places[left_hand] - joint_places[left_arm]);
    const glm::dvec3 shoulder = joint_places[left_arm], elbow = joint_places[left_forearm],
                     hand = joint_places[left_hand];
    pair(left_arm, right_arm, shoulder, shoulder + 0.03 * along, 0.058, 0.056);
    pair(left_arm, right_arm, shoulder, elbow, 0.046, 0.036);
    pair(left_arm, right_arm, shoulder + 0.11 * along + glm::dvec3(0.0, 0.0, 0.012),
         shoulder + 0.17 * along + glm::dvec3(0.0, 0.0, 0.012), 0.042, 0.038);
    pair(left_forearm, right_forearm, elbow, hand, 0.036, 0.026);
    pair(left_forearm, right_forearm, elbow + 0.05 * along, elbow + 0.10 * along, 0.039, 0.036);
    // Bones are summed in this order.
    if (hands == Hands::gloves) {
        pair(left_hand, right_hand, hand + 0.010 * along, hand + 0.03 * along, 0.036, 0.044);
        pair(left_hand, right_hand, hand + 0.055 * along, hand + 0.085 * along, 0.056, 0.052);
        pair(left_hand, right_hand, hand + 0.05 * along + glm::dvec3(0.0, 0.0, 0.042),
             hand + 0.075 * along + glm::dvec3(0.0, 0.0, 0.045), 0.026, 0.022);
    } else {
        pair(left_hand, right_hand, hand + 0.015 * along, hand + 0.065 * along, 0.026, 0.029);
        pair(left_hand, right_hand, hand + 0.065 * along, hand + 0.140 * along, 0.026, 0.017);
        pair(left_hand, right_hand, hand + 0.02 * along + glm::dvec3(0.0, 0.0, 0.02),
             hand + 0.07 * along + glm::dvec3(0.0, 0.0, 0.045), 0.016, 0.013);
    }

    const glm::dvec3 hip = joint_places[left_thigh], knee = joint_places[left_shin],
                     ankle = joint_places[left_foot];
    pair(left_thigh, right_thigh, hip - glm::dvec3(0.0, 0.05, 0.0), knee, 0.080, 0.052);
    pair(left_thigh, right_thigh, hip - glm::dvec3(0.0, 0.14, -0.02),
         hip - glm::dvec3(-0.01, 0.24, -0.02), 0.064, 0.056);
    pair(left_shin, right_shin, knee, ankle, 0.050, 0.036);
    pair(left_shin, right_shin, glm::mix(knee, ankle, 0.2) - glm::dvec3(0.0, 0.0, 0.018),
         glm::mix(knee, ankle, 0.45) - glm::dvec3(0.0, 0.0, 0.016), 0.049, 0.043);
    pair(left_foot, right_foot, ankle - glm::dvec3(0.0, 0.045, 0.03),
         ankle + glm::dvec3(0.012, -0.056, 0.13), 0.040, 0.030);
    pair(left_foot, right_foot, ankle, ankle - glm::dvec3(0.0, 0.03, 0.0), 0.036, 0.038);
    return out;
}

glm::dquat about(const glm::dvec3& axis, double degrees) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

namespace {

const glm::dvec3 x_axis(1.0, 0.0, 0.0), y_axis(0.0, 1.0, 0.0);

// Axes: along a bone, towards the side that its joint bends out to, across.
glm::dmat3 frame(const glm::dvec3& along, const glm::dvec3& out) {
    const glm::dvec3 d = glm::normalize(along);
    const glm::dvec3 m = glm::normalize(out - d * glm::dot(d, out));
    return glm::dmat3(d, m, glm::cross(d, m));
}

// Turns two bones to the world so that their end reaches for a target and the joint between them
// bends towards `out`.
void reach(Joint upper, const glm::dvec3& root, const glm::dvec3& target, const glm::dvec3& out,
           const glm::dvec3& out_at_rest, std::array<glm::dquat, joint_count>& world) {
    const glm::dvec3 first = joint_places[upper + 1] - joint_places[upper];
    const glm::dvec3 second = joint_places[upper + 2] - joint_places[upper + 1];
    const double a = glm::length(first), b = glm::length(second);
    const glm::dvec3 way = target - root;
    const double far = std::clamp(glm::length(way), 1.05 * std::abs(a - b) + 0.05, 0.992 * (a + b));
    const double cosine = std::clamp((a * a + far * far - b * b) / (2.0 * a * far), -1.0, 1.0);
    const glm::dmat3 axes = frame(way, out);
    const glm::dvec3 bend = a * (cosine * axes[0] + std::sqrt(1.0 - cosine * cosine) * axes[1]);
    const glm::dvec3 rest = far * axes[0] - bend;
    const auto turn = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::normalize(
            glm::quat_cast(frame(to, out) * glm::transpose(frame(from, out_at_rest))));
    };
    world[upper] = turn(first, bend);
    world[upper + 1] = turn(second, rest);
}

}  // namespace

Stance stance_of(const Moment& at) {
    const glm::dvec3& twist = at.twist;
    Stance stance;
    stance.pelvis = at.pelvis;

    std::array<glm::dquat, joint_count> world;
    world[pelvis] = about(y_axis, twist[0]) * about(x_axis, 0.25 * twist[2]);
    world[chest] = about(y_axis, twist[1]) * about(x_axis, twist[2]);
    world[spine] = glm::slerp(world[pelvis], world[chest], 0.5);
    world[head] = about(y_axis, 0.15 * twist[1]) * about(x_axis, 0.3 * twist[2] + 4.0);
    const auto offset = [](Joint from, Joint to) { return joint_places[to] - joint_places[from]; };
    const glm::dvec3 waist = stance.pelvis + world[pelvis] * offset(pelvis, spine);
    const glm::dvec3 ribs = waist + world[spine] * offset(spine, chest);

    reach(left_arm, ribs + world[chest] * offset(chest, left_arm), at.left_hand, at.left_elbow,
          {0.0, 0.0, -1.0}, world);
    reach(right_arm, ribs + world[chest] * offset(chest, right_arm), at.right_hand, at.right_elbow,
          {0.0, 0.0, -1.0}, world);
    world[left_hand] = world[left_forearm];
    world[right_hand] = world[right_forearm];
    const glm::dvec3 forward(0.0, 0.0, 1.0);
    reach(left_thigh, stance.pelvis + world[pelvis] * offset(pelvis, left_thigh), at.left_foot,
          at.left_knee, forward, world);
    reach(right_thigh, stance.pelvis + world[pelvis] * offset(pelvis, right_thigh), at.right_foot,
          at.right_knee, forward, world);
    world[left_foot] = at.left_sole;
    world[right_foot] = at.right_sole;

    for (std::size_t j = 0; j < joint_count; ++j) {
        const int parent = joint_parents[j];
        stance.turns[j] = parent < 0
                              ? world[j]
                              : glm::inverse(world[static_cast<std::size_t>(parent)]) * world[j];
    }
    return stance;
}

int add_skeleton(Rig& rig) {
    for (std::size_t j = 0; j < joint_count; ++j) {
        const int parent = joint_parents[j];
        rig.add_node(
            joint_names[j], parent,
            joint_places[j] -
                (parent < 0 ? glm::dvec3(0.0) : joint_places[static_cast<std::size_t>(parent)]));
    }
    return rig.add_skin();
}

void play(Rig& rig, const std::vector<Stance>& stances) {
    std::vector<glm::dvec3> places;
    std::vector<std::vector<glm::dquat>> turns(joint_count);
    for (const Stance& stance : stances) {
        places.push_back(stance.pelvis);
        for (std::size_t j = 0; j < joint_count; ++j) turns[j].push_back(stance.turns[j]);
    }
    rig.shift(pelvis, places);
    for (std::uint32_t j = 0; j < joint_count; ++j) rig.turn(j, turns[j]);
}

}  // namespace clgi::generated::figure
