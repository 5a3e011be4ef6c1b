// A figure that boxes and kicks. [Kautz04, figure 4] shows such a figure.
//
// The figure is one closed surface of 1,528 vertices and 3,052 triangles; its belt is a ring, 144
// vertices and 288 triangles, with an end of 1 x 4 squares, 10 vertices and 8 triangles; the mat
// has 9 x 9 tiles of 3 x 3 squares, 1,296 vertices and 1,458 triangles.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include "lab/scenes/deforming.hpp"

#include "lab/scenes/fight_motion.hpp"
#include "lab/scenes/figure.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace fight_scene {
namespace {

using namespace generated::figure;
using generated::fight::clip_length;
using generated::fight::stance_at;

constexpr std::size_t figure_vertices = 1528;
constexpr int belt_sides = 24, belt_around = 6;
constexpr int keys = 97;

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
}  // namespace fight_scene

Scene fight_like(const FightOptions& options) {
    using namespace fight_scene;
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
    const int joints = add_skeleton(rig);

    const generated::Flesh body = figure_flesh(Hands::gloves);
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

    std::vector<Stance> stances;
    for (int key = 0; key < keys; ++key)
        stances.push_back(stance_at(clip_length * key / (keys - 1)));
    play(rig, stances);

    generated::add_daylight(scene, {-0.55f, -1.0f, -0.5f}, 2.2f);
    scene.cameras.push_back(
        generated::look_at("camera", {2.15, 1.40, 2.15}, {0.0, 0.86, 0.16}, 0.58f));
    rig.finish();
    return scene;
}

}  // namespace clgi
