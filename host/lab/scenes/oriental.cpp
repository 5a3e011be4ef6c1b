// A living room whose light comes through carved windows. [Dachsbacher07, figure 16] shows an
// oriental room.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/hollow.hpp"
#include "lab/scenes/solids.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace oriental_scene {
namespace {

using namespace generated;

constexpr double width = 6.0, height = 3.0, depth = 5.6, thickness = 0.3;
// Windows on the left, from z to z + window_width each.
constexpr double windows[] = {0.85, 3.15}, window_width = 1.6, sill = 0.95, lintel = 2.55;

struct Materials {
    std::uint32_t plaster, blue, floor, ceiling, outside, wood, dark_wood, brass, clay, glaze, rug,
        border;
    std::uint32_t cushions[4];
};

// A field of the lattice; neighbours share its rim.
const std::vector<std::string> star = {"#########", "#..###..#", "#.##.##.#",
                                       "###...###", "##.....##", "###...###",
                                       "#.##.##.#", "#..###..#", "#########"};

std::vector<std::string> lattice(int across, int up) {
    std::vector<std::string> out;
    for (int j = 0; j <= 8 * up; ++j) {
        std::string row;
        for (int i = 0; i <= 8 * across; ++i)
            row += star[static_cast<std::size_t>(j % 8)][static_cast<std::size_t>(i % 8)];
        out.push_back(row);
    }
    return out;
}

// Its lower left corner is the origin.
void add_lattice(Scene& scene, const Placement& at, int across, int up, const glm::dvec2& size,
                 std::uint32_t material) {
    const glm::dvec2 cell = size / glm::dvec2(8 * across + 1, 8 * up + 1);
    add_carved(scene, at, lattice(across, up), cell, 0.04, material);
}

Materials add_materials(Scene& scene) {
    Materials m;
    m.plaster = add_material(scene, "plaster", {0.80f, 0.72f, 0.58f});
    m.blue = add_material(scene, "blue wall", {0.20f, 0.42f, 0.58f});
    m.floor = add_material(scene, "floor", {0.56f, 0.36f, 0.24f});
    m.ceiling = add_material(scene, "ceiling", {0.76f, 0.70f, 0.60f});
    m.outside = add_material(scene, "outside", {0.45f, 0.44f, 0.42f});
    m.wood = add_material(scene, "wood", {0.44f, 0.24f, 0.12f});
    m.dark_wood = add_material(scene, "dark wood", {0.22f, 0.11f, 0.06f});
    m.brass = add_material(scene, "brass", {0.66f, 0.48f, 0.18f});
    m.clay = add_material(scene, "clay", {0.62f, 0.26f, 0.14f});
    m.glaze = add_material(scene, "glaze", {0.12f, 0.44f, 0.46f});
    m.rug = add_material(scene, "rug", {0.48f, 0.08f, 0.08f});
    m.border = add_material(scene, "border of the rug", {0.70f, 0.52f, 0.22f});
    m.cushions[0] = add_material(scene, "red cushion", {0.64f, 0.10f, 0.10f});
    m.cushions[1] = add_material(scene, "orange cushion", {0.78f, 0.40f, 0.10f});
    m.cushions[2] = add_material(scene, "green cushion", {0.16f, 0.42f, 0.24f});
    m.cushions[3] = add_material(scene, "violet cushion", {0.36f, 0.14f, 0.40f});
    return m;
}

void add_walls(Scene& scene, const Materials& m) {
    Hollow room;
    room.cuts = {even_cuts(0.0, width, 5), std::vector<double>{0.0, sill, lintel, height},
                 std::vector<double>{0.0, windows[0], windows[0] + window_width, windows[1],
                                     windows[1] + window_width, depth}};
    room.materials = {m.plaster, m.blue, m.floor, m.ceiling, m.plaster, m.plaster};
    room.outside = m.outside;
    room.thickness = thickness;
    const auto in_window = [](double z) {
        return std::any_of(std::begin(windows), std::end(windows),
                           [&](double first) { return z > first && z < first + window_width; });
    };
    room.open = [&](Wall wall, const glm::dvec3& at) {
        return wall == low_x && at.y > sill && at.y < lintel && in_window(at.z);
    };
    add_hollow(scene, room);
    end_part(scene, "room");
    for (const double first : windows) {
        add_lattice(scene,
                    placed({-0.6 * thickness, sill, first + window_width}, glm::half_pi<double>()),
                    2, 2, {window_width, lintel - sill}, m.wood);
        end_part(scene, "window");
    }
    for (int beam = 0; beam < 5; ++beam) {
        const double z = 0.55 + 1.12 * beam;
        add_block(scene, placed({0.0, height - 0.2, z}), {0.0, 0.0, -0.09}, {width, 0.2, 0.09},
                  m.dark_wood);
    }
    end_part(scene, "beams");
}

// Three leaves that stand at angles to each other, on two feet each.
void add_screen(Scene& scene, const Placement& at, const Materials& m) {
    const glm::dvec2 size(0.62, 1.22);
    glm::dvec3 hinge(0.0, 0.06, 0.0);
    for (int leaf = 0; leaf < 3; ++leaf) {
        const double turn = leaf % 2 == 0 ? 0.42 : -0.42;
        const Placement here = at(placed(hinge, turn));
        add_lattice(scene, here(placed({0.0, 0.52, 0.0})), 1, 2, size, m.wood);
        add_block(scene, here, {0.0, 0.0, 0.0}, {size.x, 0.51, 0.04}, m.dark_wood);
        for (const double x : {0.04, size.x - 0.10})
            add_block(scene, here, {x, -0.06, -0.01}, {x + 0.06, 0.0, 0.05}, m.dark_wood);
        hinge += glm::dvec3(std::cos(turn), 0.0, -std::sin(turn)) * (size.x + 0.03);
    }
    end_part(scene, "screen");
}

void add_lantern(Scene& scene, const Placement& at, double drop, const Materials& m) {
    add_rod(scene, at, {0.0, -drop + 0.235, 0.0}, {0.0, 0.0, 0.0}, 0.008, 6, m.brass);
    const Placement here = at(placed({0.0, -drop, 0.0}));
    add_turned(scene, here,
               {{0.0, -0.25},
                {0.012, -0.235},
                {0.028, -0.205},
                {0.012, -0.175},
                {0.05, -0.16},
                {0.11, -0.11},
                {0.135, -0.04},
                {0.135, 0.05},
                {0.10, 0.11},
                {0.045, 0.15},
                {0.055, 0.165},
                {0.03, 0.185},
                {0.012, 0.235}},
               10, m.brass);
    end_part(scene, "lantern");
}

// Eight-sided, on a foot that is turned.
void add_low_table(Scene& scene, const Placement& at, const Materials& m) {
    add_turned(scene, at, {{0.46, 0.36}, {0.48, 0.375}, {0.48, 0.395}, {0.46, 0.41}}, 8, m.wood);
    add_turned(scene, at,
               {{0.26, 0.0},
                {0.26, 0.03},
                {0.16, 0.06},
                {0.10, 0.14},
                {0.14, 0.22},
                {0.12, 0.28},
                {0.28, 0.36}},
               12, m.dark_wood);
    const Placement top = at(placed({0.0, 0.41, 0.0}));
    // Tray, pot and cups.
    add_turned(scene, top, {{0.27, 0.0}, {0.29, 0.025}, {0.28, 0.025}, {0.26, 0.008}}, 16, m.brass);
    add_turned(scene, top(placed({-0.06, 0.008, 0.02})),
               {{0.05, 0.0},
                {0.085, 0.04},
                {0.09, 0.08},
                {0.06, 0.13},
                {0.035, 0.15},
                {0.045, 0.16},
                {0.02, 0.18},
                {0.012, 0.20},
                {0.0, 0.21}},
               12, m.glaze);
    add_rod(scene, top, {0.025, 0.07, 0.02}, {0.085, 0.135, 0.02}, 0.011, 8, m.glaze);
    for (const double angle : {0.2, 1.3, -0.9})
        add_turned(scene, top(placed({0.18 * std::cos(angle), 0.008, 0.18 * std::sin(angle)})),
                   {{0.022, 0.0}, {0.038, 0.05}, {0.035, 0.05}, {0.019, 0.006}}, 10, m.clay);
    end_part(scene, "low table");
}

void add_divan(Scene& scene, const Placement& at, double half, const Materials& m) {
    add_block(scene, at, {-half, 0.0, -0.42}, {half, 0.20, 0.42}, m.dark_wood);
    add_cushion(scene, at(placed({0.0, 0.29, 0.0})), {half - 0.02, 0.09, 0.41}, 6.0, 20, 8, m.rug);
    for (int k = 0; k < 4; ++k) {
        const double x = -half + 0.36 + k * (2.0 * half - 0.72) / 3.0;
        add_cushion(scene, at(along({x, 0.59, -0.27}, {0.02 * (k - 1), 1.0, -0.35})),
                    {0.27, 0.24, 0.09}, 3.4, 12, 7, m.cushions[(k + 1) % 4]);
    }
    end_part(scene, "divan");
}

void add_vase(Scene& scene, const Placement& at, double scale, std::uint32_t material) {
    std::vector<TurnedRing> outline = {{0.10, 0.0},   {0.17, 0.12}, {0.20, 0.26}, {0.18, 0.40},
                                       {0.10, 0.52},  {0.06, 0.60}, {0.07, 0.68}, {0.10, 0.72},
                                       {0.085, 0.72}, {0.05, 0.62}, {0.0, 0.58}};
    for (TurnedRing& ring : outline) {
        ring.radius *= scale;
        ring.height *= scale;
    }
    add_turned(scene, at, outline, 18, material);
    end_part(scene, "vase");
}

void add_column(Scene& scene, const Placement& at, const Materials& m) {
    add_turned(scene, at,
               {{0.17, 0.0},
                {0.17, 0.12},
                {0.13, 0.18},
                {0.10, 0.26},
                {0.11, 0.9},
                {0.09, 2.2},
                {0.12, 2.28},
                {0.10, 2.34},
                {0.18, 2.62},
                {0.18, 2.8}},
               12, m.plaster);
    end_part(scene, "column");
}

void add_furniture(Scene& scene, const Materials& m) {
    const double right_angle = glm::half_pi<double>();
    add_block(scene, placed({2.9, 0.0, 2.75}), {-1.6, 0.0, -1.25}, {1.6, 0.010, 1.25}, m.border);
    add_block(scene, placed({2.9, 0.010, 2.75}), {-1.42, 0.0, -1.07}, {1.42, 0.006, 1.07}, m.rug);
    end_part(scene, "rug");
    add_divan(scene, placed({2.35, 0.0, 0.44}), 1.45, m);
    add_divan(scene, placed({5.54, 0.0, 2.75}, -right_angle), 1.15, m);
    add_screen(scene, placed({4.02, 0.0, 0.62}), m);
    for (const double z : {0.20, 5.35}) add_column(scene, placed({5.75, 0.0, z}), m);
    add_low_table(scene, placed({2.55, 0.016, 2.55}, 0.2), m);
    add_low_table(scene, placed({3.85, 0.016, 3.25}, 0.5), m);
    const glm::dvec2 seats[] = {{1.75, 2.95}, {2.35, 3.45}, {3.25, 2.2}, {3.1, 3.85}};
    for (int k = 0; k < 4; ++k) {
        add_cushion(scene, placed({seats[k].x, 0.116, seats[k].y}, 0.7 * k), {0.27, 0.10, 0.27},
                    3.2, 12, 7, m.cushions[k]);
        end_part(scene, "cushion");
    }
    add_vase(scene, placed({0.45, 0.0, 0.45}), 1.15, m.glaze);
    add_vase(scene, placed({0.42, 0.0, 2.8}), 0.85, m.clay);
    add_lantern(scene, placed({2.0, height, 1.93}), 0.95, m);
    add_lantern(scene, placed({2.9, height, 2.95}), 0.75, m);
    add_lantern(scene, placed({3.9, height, 2.05}), 1.05, m);
}

}  // namespace
}  // namespace oriental_scene

Scene oriental_like(const OrientalOptions& options) {
    using namespace oriental_scene;
    check_range("oriental-like", "illuminance", options.illuminance, 0.0, 1e20);
    Scene scene;
    scene.name = "oriental-like";
    const Materials materials = add_materials(scene);
    add_walls(scene, materials);
    add_furniture(scene, materials);
    Light sun;
    sun.name = "sun";
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(glm::vec3(1.0f, -0.62f, -0.18f));
    sun.intensity = options.illuminance * glm::vec3(1.0f, 0.92f, 0.76f);
    scene.lights.push_back(sun);
    scene.cameras.push_back(look_at("camera", {3.5, 1.55, 5.45}, {2.75, 0.78, 1.2}, 1.02f));
    return scene;
}

}  // namespace clgi
