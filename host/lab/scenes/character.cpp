// A figure that walks in a circle in the office and waves: 1,262 vertices and 2,520 triangles.
// [Dachsbacher07, figure 1] has a character in the office.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/figure.hpp"
#include "lab/scenes/office_room.hpp"
#include "lab/scenes/solids.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace character_scene {
namespace {

using namespace generated::figure;

constexpr std::size_t figure_vertices = 1262;
constexpr double clip_length = 6.4;  // seconds
constexpr int keys = 129, strides = 5;
constexpr double radius = 0.72;  // metres, of the circle
const glm::dvec3 centre(3.15, 0.0, 2.35);
const glm::dvec3 y_axis(0.0, 1.0, 0.0), x_axis(1.0, 0.0, 0.0);

// Ten moments of a stride: how far a foot is ahead, how high its ankle is, degrees that its toes
// point down. It is on the ground for the first six of them, a stride is 2 pi radius / strides.
const std::vector<glm::dvec3> steps = {
    {0.270, 0.098, -15.0}, {0.180, 0.090, 0.0},   {0.090, 0.090, 0.0},   {0.000, 0.090, 0.0},
    {-0.090, 0.095, 3.0},  {-0.180, 0.115, 14.0}, {-0.270, 0.165, 34.0}, {-0.160, 0.215, 32.0},
    {0.060, 0.200, 8.0},   {0.240, 0.150, -14.0}};

double eased(double from, double to, double x) {
    const double share = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return share * share * (3.0 - 2.0 * share);
}

// In the figure's own world: it faces +Z at the origin, the circle's centre is on its left.
Moment walking(double share) {
    const double full = 2.0 * glm::pi<double>();
    const double phase = strides * share, swing = std::cos(full * phase);
    const auto foot = [&](double aside, double at, glm::dvec3& place, glm::dquat& sole,
                          glm::dvec3& knee) {
        const glm::dvec3 step = generated::through(steps, at);
        const double turn = step.x / radius;
        const glm::dvec3 middle(radius, 0.0, 0.0);
        const glm::dquat on = glm::angleAxis(turn, y_axis);
        place = middle + on * (glm::dvec3(aside, step.y, 0.0) - middle);
        sole = on * about(x_axis, step.z);
        knee = on * glm::dvec3(0.3 * aside, 0.0, 1.0);
    };
    Moment at;
    at.pelvis = {0.0, 0.895 + 0.012 * std::cos(2.0 * full * phase + 2.6), 0.0};
    at.twist = {-6.0 * swing, 8.0 * swing, 4.0};
    foot(0.095, phase, at.left_foot, at.left_sole, at.left_knee);
    foot(-0.095, phase + 0.5, at.right_foot, at.right_sole, at.right_knee);
    at.left_hand = {0.29, 0.86, 0.04 - 0.20 * swing};
    at.left_elbow = {0.5, -0.2, -1.0};
    const double raised = eased(0.04, 0.14, share) - eased(0.56, 0.66, share);
    const double wave = std::sin(full * 10.0 * share);
    at.right_hand = glm::mix(glm::dvec3(-0.29, 0.86, 0.04 + 0.20 * swing),
                             glm::dvec3(-0.40 + 0.13 * wave, 1.70, 0.16), raised) +
                    glm::dvec3(-0.12, 0.0, 0.16) * (4.0 * raised * (1.0 - raised));
    at.right_elbow = glm::mix(glm::dvec3(-0.5, -0.2, -1.0), glm::dvec3(-1.0, -0.7, 0.1), raised);
    return at;
}

Stance stance_at(double share) {
    Stance stance = stance_of(walking(share));
    const glm::dquat on = glm::angleAxis(2.0 * glm::pi<double>() * share, y_axis);
    stance.pelvis = centre + on * (stance.pelvis - glm::dvec3(radius, 0.0, 0.0));
    stance.turns[pelvis] = on * stance.turns[pelvis];
    return stance;
}

// White is what a material's colour is multiplied by, so the material is white.
glm::vec4 color_of(const glm::dvec3& p, std::uint32_t follows) {
    const bool is_foot = follows == left_foot || follows == right_foot;
    const bool is_leg = follows == left_thigh || follows == right_thigh || follows == left_shin ||
                        follows == right_shin || follows == pelvis;
    const bool is_skin = follows == head || follows == left_hand || follows == right_hand;
    glm::vec3 color(0.24f, 0.46f, 0.22f);  // shirt
    if (is_leg) color = {0.14f, 0.17f, 0.26f};
    if (is_foot) color = {0.10f, 0.06f, 0.04f};
    if (is_skin) color = {0.70f, 0.48f, 0.36f};
    if (follows == head && p.y - 0.55 * p.z > 1.635) color = {0.09f, 0.06f, 0.045f};
    return {color, 1.0f};
}

// At rest the figure stands as the clip begins, where it walks.
void set_rest(Animation& animation, const Stance& stance) {
    animation.nodes[pelvis].translation = stance.pelvis;
    for (std::size_t j = 0; j < joint_count; ++j) animation.nodes[j].rotation = stance.turns[j];
}

}  // namespace
}  // namespace character_scene

Scene character(const OfficeOptions& options) {
    using namespace character_scene;
    Scene scene;
    generated::add_office(scene, options);
    scene.name = "character";
    const std::uint32_t figure = generated::add_material(scene, "figure", glm::vec3(1.0f));

    generated::Rig rig(scene, "walk", clip_length);
    const std::vector<int> parents(std::begin(joint_parents), std::end(joint_parents));
    const int joints = add_skeleton(rig);
    const generated::Flesh body = figure_flesh(Hands::bare);
    const generated::FleshMesh mesh = generated::mesh_of(body, figure_vertices);
    const std::vector<std::vector<double>> sharp = generated::weights_of(body, mesh, parents, 0);
    const std::vector<std::vector<double>> weights = generated::weights_of(body, mesh, parents, 3);
    const std::size_t first = scene.positions.size(), first_triangle = scene.triangles.size();
    const auto base = static_cast<std::uint32_t>(first);
    scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& [a, b, c] : mesh.triangles)
        scene.triangles.push_back({{base + a, base + b, base + c}, figure});
    generated::smooth_normals_of(scene, first, first_triangle);
    rig.follow_joints(rig.end_moving_part("figure", pelvis), joints, weights);
    scene.colors.assign(scene.positions.size(), glm::vec4(1.0f));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto most = std::max_element(sharp[v].begin(), sharp[v].end()) - sharp[v].begin();
        scene.colors[first + v] = color_of(mesh.positions[v], static_cast<std::uint32_t>(most));
    }

    std::vector<Stance> stances;
    for (int key = 0; key < keys; ++key)
        stances.push_back(stance_at(static_cast<double>(key) / (keys - 1)));
    play(rig, stances);
    set_rest(rig.animation(), stances.front());
    rig.finish();
    return scene;
}

}  // namespace clgi
