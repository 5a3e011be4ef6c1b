// SPDX-License-Identifier: MIT
#include "lab/scenes/fight_motion.hpp"

#include <vector>

namespace clgi::generated::fight {
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

}  // namespace

figure::Stance stance_at(double seconds) {
    const double share = seconds / clip_length;
    const glm::dvec3 feet = through(foot_turns, share);
    const glm::dvec3 x_axis(1.0, 0.0, 0.0), y_axis(0.0, 1.0, 0.0), forward(0.0, 0.0, 1.0);
    figure::Moment at;
    at.pelvis = through(pelvis_places, share);
    at.twist = through(twists, share);
    at.left_hand = through(left_fists, share);
    at.right_hand = through(right_fists, share);
    at.left_foot = through(left_feet, share);
    at.right_foot = through(right_feet, share);
    // Elbows bend down and out, knees to where the foot points.
    at.left_elbow = {0.75, -1.0, -0.25};
    at.right_elbow = {-0.85, -1.0, -0.25};
    at.left_knee = figure::about(y_axis, feet[0] + 12.0) * forward;
    at.right_knee = figure::about(y_axis, feet[1]) * forward + glm::dvec3(-0.15, 0.35, 0.0);
    at.left_sole = figure::about(y_axis, feet[0]);
    at.right_sole = figure::about(y_axis, feet[1]) * figure::about(x_axis, feet[2]);
    return stance_of(at);
}

}  // namespace clgi::generated::fight
