// A figure that boxes and kicks. [Kautz04, figure 4] shows such a figure.
//
// The figure is one closed surface of 1,528 vertices and 3,052 triangles; its belt is a ring, 144
// vertices and 288 triangles, with an end of 1 x 4 squares, 10 vertices and 8 triangles; the mat
// has 9 x 9 tiles of 3 x 3 squares, 1,296 vertices and 1,458 triangles.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/deforming.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "scene/fight_motion.hpp"
#include "scene/flesh.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace {

using namespace generated::fight;

constexpr std::size_t figure_vertices = 1528;
constexpr int belt_sides = 24, belt_around = 6;
constexpr int keys = 97;

generated::Flesh flesh() {
    generated::Flesh out;
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
    // Gloves.
    pair(left_hand, right_hand, hand + 0.010 * along, hand + 0.03 * along, 0.036, 0.044);
    pair(left_hand, right_hand, hand + 0.055 * along, hand + 0.085 * along, 0.056, 0.052);
    pair(left_hand, right_hand, hand + 0.05 * along + glm::dvec3(0.0, 0.0, 0.042),
         hand + 0.075 * along + glm::dvec3(0.0, 0.0, 0.045), 0.026, 0.022);

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

// White is what a material's colour is multiplied by, so the material is white.
glm::vec4 color_of(const glm::dvec3& p, std::uint32_t follows, const FightOptions& options) {
    const bool is_glove = follows == left_hand || follows == right_hand;
    const bool is_leg = follows == left_thigh || follows == right_thigh || follows == left_shin ||
                        follows == right_shin;
    glm::vec3 color = options.skin;
    if (is_glove) color = options.gloves;
    if (follows == pelvis || is_leg || (follows == spine && p.y < 1.03)) color = options.trousers;
    if (is_leg && p.y < 0.17) color = options.skin;
    const bool is_hair = follows == head && p.y - 0.55 * p.z > 1.635;
    if (is_hair) color = {0.09f, 0.06f, 0.045f};
    return {color, 1.0f};
}

void add_belt(Scene& scene, const generated::Flesh& body, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int side = 0; side < belt_sides; ++side) {
        const double angle = 2.0 * glm::pi<double>() * side / belt_sides;
        const glm::dvec3 out(std::cos(angle), 0.0, std::sin(angle));
        const double height = 1.03 - 0.012 * std::sin(angle);
        for (int k = 0; k < belt_around; ++k) {
            const double turn = 2.0 * glm::pi<double>() * k / belt_around;
            const double up = height + 0.022 * std::sin(turn);
            const glm::dvec3 bare = body.leave({0.0, up, 0.0}, out, 0.012);
            scene.positions.push_back(bare + 0.009 * std::cos(turn) * out);
        }
    }
    const auto at = [&](int side, int k) {
        return first +
               static_cast<std::uint32_t>(side % belt_sides * belt_around + k % belt_around);
    };
    for (int side = 0; side < belt_sides; ++side)
        for (int k = 0; k < belt_around; ++k) {
            scene.triangles.push_back(
                {{at(side, k), at(side, k + 1), at(side + 1, k + 1)}, material});
            scene.triangles.push_back(
                {{at(side, k), at(side + 1, k + 1), at(side + 1, k)}, material});
        }
}

void add_belt_end(Scene& scene, const generated::Flesh& body, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int row = 0; row < 5; ++row)
        for (int side = 0; side < 2; ++side) {
            const double up = 1.02 - 0.055 * row, x = 0.035 + 0.05 * side + 0.006 * row;
            scene.positions.push_back(
                body.leave({x, up, 0.0}, {0.0, 0.0, 1.0}, 0.022 + 0.003 * row));
        }
    for (std::uint32_t row = 0; row < 4; ++row) {
        const std::uint32_t a = first + 2 * row;
        scene.triangles.push_back({{a, a + 2, a + 3}, material});
        scene.triangles.push_back({{a, a + 3, a + 1}, material});
    }
}

}  // namespace

Scene fight_like(const FightOptions& options) {
    generated::check_color("fight-like", "skin", options.skin, 1.0);
    generated::check_color("fight-like", "trousers", options.trousers, 1.0);
    generated::check_color("fight-like", "gloves", options.gloves, 1.0);

    Scene scene;
    scene.name = "fight-like";
    const std::uint32_t light = generated::add_material(scene, "light tile", {0.60f, 0.55f, 0.42f});
    const std::uint32_t dark = generated::add_material(scene, "dark tile", {0.30f, 0.36f, 0.30f});
    const std::uint32_t figure = generated::add_material(scene, "figure", glm::vec3(1.0f));
    const std::uint32_t belt = generated::add_material(scene, "belt", {0.05f, 0.05f, 0.06f});
    scene.materials[belt].double_sided = true;
    generated::add_tiles(scene, {9, 9}, 3, 0.4, {light, dark});

    generated::Rig rig(scene, "fight", clip_length);
    const std::vector<int> parents(std::begin(joint_parents), std::end(joint_parents));
    for (std::size_t j = 0; j < joint_count; ++j) {
        const int parent = joint_parents[j];
        rig.add_node(
            joint_names[j], parent,
            joint_places[j] -
                (parent < 0 ? glm::dvec3(0.0) : joint_places[static_cast<std::size_t>(parent)]));
    }
    const int joints = rig.add_skin();

    const generated::Flesh body = flesh();
    const generated::FleshMesh mesh = generated::mesh_of(body, figure_vertices);
    const std::vector<std::vector<double>> sharp = generated::weights_of(body, mesh, parents, 0);
    const std::vector<std::vector<double>> weights = generated::weights_of(body, mesh, parents, 3);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& [a, b, c] : mesh.triangles)
        scene.triangles.push_back({{first + a, first + b, first + c}, figure});
    generated::smooth_normals(scene);
    rig.follow_joints(rig.end_moving_part("figure", pelvis), joints, weights);
    scene.colors.assign(scene.positions.size(), glm::vec4(1.0f));
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto most = std::max_element(sharp[v].begin(), sharp[v].end()) - sharp[v].begin();
        scene.colors[first + v] =
            color_of(mesh.positions[v], static_cast<std::uint32_t>(most), options);
    }

    for (const bool end : {false, true}) {
        const std::size_t begin = scene.positions.size();
        end ? add_belt_end(scene, body, belt) : add_belt(scene, body, belt);
        generated::smooth_normals(scene);
        const std::vector<glm::dvec3> points(scene.positions.begin() + begin,
                                             scene.positions.end());
        rig.follow_joints(rig.end_moving_part(end ? "belt end" : "belt", pelvis), joints,
                          generated::weights_near(points, mesh, weights));
    }
    scene.colors.resize(scene.positions.size(), glm::vec4(1.0f));

    std::vector<glm::dvec3> places;
    std::vector<std::vector<glm::dquat>> turns(joint_count);
    for (int key = 0; key < keys; ++key) {
        const Stance stance = stance_at(clip_length * key / (keys - 1));
        places.push_back(stance.pelvis);
        for (std::size_t j = 0; j < joint_count; ++j) turns[j].push_back(stance.turns[j]);
    }
    rig.shift(pelvis, places);
    for (std::uint32_t j = 0; j < joint_count; ++j) rig.turn(j, turns[j]);

    generated::add_daylight(scene, {-0.55f, -1.0f, -0.5f}, 2.2f);
    scene.cameras.push_back(
        generated::look_at("camera", {2.15, 1.40, 2.15}, {0.0, 0.86, 0.16}, 0.58f));
    rig.finish();
    return scene;
}

}  // namespace clgi
