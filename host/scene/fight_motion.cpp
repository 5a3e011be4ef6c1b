// SPDX-License-Identifier: MIT
#include "scene/fight_motion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "scene/rigging.hpp"

namespace clgi::generated::fight {

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

namespace {

using Row = std::vector<glm::dvec3>;

// Sixteen moments, 0.2 s apart, metres and degrees. The left side is in front.
const Row pelvis_places = {
    {0.00, 0.865, 0.00}, {0.00, 0.860, 0.02}, {0.00, 0.870, 0.05}, {0.00, 0.865, 0.03},
    {0.00, 0.865, 0.07}, {0.00, 0.868, 0.06}, {0.00, 0.860, 0.02}, {0.01, 0.870, 0.03},
    {0.05, 0.905, 0.08}, {0.07, 0.925, 0.10}, {0.07, 0.925, 0.10}, {0.06, 0.915, 0.09},
    {0.03, 0.885, 0.06}, {0.00, 0.865, 0.01}, {0.00, 0.858, 0.00}, {0.00, 0.862, 0.00}};
// Yaw of the pelvis, yaw of the chest, how far the chest leans forward.
const Row twists = {{-38, -40, 9}, {-40, -52, 10}, {-46, -68, 12}, {-40, -48, 10},
                    {-14, 12, 14}, {-12, 16, 14},  {-30, -24, 11}, {-34, -36, 8},
                    {-12, -34, 0}, {8, -30, -14},  {10, -28, -20}, {0, -30, -10},
                    {-20, -36, 2}, {-36, -40, 10}, {-40, -42, 11}, {-38, -40, 9}};
const Row left_fists = {
    {0.10, 1.33, 0.36}, {0.11, 1.33, 0.34}, {0.02, 1.40, 0.74}, {0.06, 1.36, 0.50},
    {0.13, 1.33, 0.26}, {0.14, 1.33, 0.25}, {0.12, 1.33, 0.33}, {0.12, 1.33, 0.35},
    {0.15, 1.28, 0.33}, {0.20, 1.22, 0.30}, {0.22, 1.20, 0.28}, {0.18, 1.26, 0.32},
    {0.12, 1.31, 0.35}, {0.10, 1.33, 0.37}, {0.10, 1.32, 0.37}, {0.10, 1.33, 0.36}};
const Row right_fists = {
    {-0.10, 1.32, 0.22}, {-0.11, 1.31, 0.20}, {-0.12, 1.31, 0.17},  {-0.10, 1.33, 0.22},
    {0.00, 1.38, 0.72},  {0.01, 1.39, 0.76},  {-0.06, 1.34, 0.42},  {-0.10, 1.32, 0.24},
    {-0.16, 1.26, 0.18}, {-0.27, 1.10, 0.02}, {-0.30, 1.05, -0.04}, {-0.22, 1.18, 0.08},
    {-0.13, 1.28, 0.20}, {-0.10, 1.32, 0.23}, {-0.10, 1.31, 0.23},  {-0.10, 1.32, 0.22}};
const Row left_feet(16, {0.12, 0.101, 0.20});
const Row right_feet = {
    {-0.15, 0.126, -0.26}, {-0.15, 0.126, -0.26}, {-0.15, 0.137, -0.26}, {-0.15, 0.142, -0.26},
    {-0.14, 0.178, -0.25}, {-0.14, 0.178, -0.25}, {-0.15, 0.138, -0.26}, {-0.14, 0.155, -0.24},
    {-0.10, 0.52, 0.12},   {-0.02, 1.02, 0.74},   {0.00, 1.10, 0.82},    {-0.06, 0.66, 0.36},
    {-0.12, 0.27, -0.04},  {-0.15, 0.145, -0.25}, {-0.15, 0.128, -0.26}, {-0.15, 0.126, -0.26}};
// Yaw and pitch of the feet, in degrees; toes up: below 0. Left pitch is 0.
const Row foot_turns = {{-10, -48, 14}, {-10, -48, 14}, {-10, -46, 18}, {-10, -40, 20},
                        {-10, -14, 34}, {-10, -14, 34}, {-10, -36, 18}, {-10, -36, 22},
                        {-8, -12, 30},  {-4, 6, -34},   {-4, 8, -48},   {-6, -6, 0},
                        {-8, -30, 26},  {-10, -46, 14}, {-10, -48, 14}, {-10, -48, 14}};

glm::dquat about(const glm::dvec3& axis, double degrees) {
    return glm::angleAxis(glm::radians(degrees), axis);
}

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

Stance stance_at(double seconds) {
    const double share = seconds / clip_length;
    const glm::dvec3 twist = through(twists, share), feet = through(foot_turns, share);
    Stance stance;
    stance.pelvis = through(pelvis_places, share);

    std::array<glm::dquat, joint_count> world;
    world[pelvis] = about(y_axis, twist[0]) * about(x_axis, 0.25 * twist[2]);
    world[chest] = about(y_axis, twist[1]) * about(x_axis, twist[2]);
    world[spine] = glm::slerp(world[pelvis], world[chest], 0.5);
    world[head] = about(y_axis, 0.15 * twist[1]) * about(x_axis, 0.3 * twist[2] + 4.0);
    const auto offset = [](Joint from, Joint to) { return joint_places[to] - joint_places[from]; };
    const glm::dvec3 waist = stance.pelvis + world[pelvis] * offset(pelvis, spine);
    const glm::dvec3 ribs = waist + world[spine] * offset(spine, chest);

    // Elbows bend down and out, knees to where the foot points.
    reach(left_arm, ribs + world[chest] * offset(chest, left_arm), through(left_fists, share),
          {0.75, -1.0, -0.25}, {0.0, 0.0, -1.0}, world);
    reach(right_arm, ribs + world[chest] * offset(chest, right_arm), through(right_fists, share),
          {-0.85, -1.0, -0.25}, {0.0, 0.0, -1.0}, world);
    world[left_hand] = world[left_forearm];
    world[right_hand] = world[right_forearm];
    const glm::dvec3 forward(0.0, 0.0, 1.0);
    const glm::dvec3 left_knee = about(y_axis, feet[0] + 12.0) * forward;
    const glm::dvec3 right_knee = about(y_axis, feet[1]) * forward + glm::dvec3(-0.15, 0.35, 0.0);
    reach(left_thigh, stance.pelvis + world[pelvis] * offset(pelvis, left_thigh),
          through(left_feet, share), left_knee, forward, world);
    reach(right_thigh, stance.pelvis + world[pelvis] * offset(pelvis, right_thigh),
          through(right_feet, share), right_knee, forward, world);
    world[left_foot] = about(y_axis, feet[0]);
    world[right_foot] = about(y_axis, feet[1]) * about(x_axis, feet[2]);

    for (std::size_t j = 0; j < joint_count; ++j) {
        const int parent = joint_parents[j];
        stance.turns[j] = parent < 0
                              ? world[j]
                              : glm::inverse(world[static_cast<std::size_t>(parent)]) * world[j];
    }
    return stance;
}

}  // namespace clgi::generated::fight
