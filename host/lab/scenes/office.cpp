// An office whose light comes through the window and is reflected by the wall opposite.
// [Dachsbacher07, figure 1] shows such a scene.
// SPDX-License-Identifier: MIT
#include <glm/gtc/constants.hpp>
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/hollow.hpp"
#include "lab/scenes/office_furniture.hpp"
#include "lab/scenes/office_room.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace generated {
namespace office_scene {
namespace {

constexpr double width = 6.0, height = 2.7, depth = 4.6, thickness = 0.25;
constexpr double sill = 1.10, lintel = 2.35, window_near = 1.1, window_far = 3.5;  // on the left

OfficeMaterials add_materials(Scene& scene) {
    OfficeMaterials m;
    m.plaster = add_material(scene, "plaster", {0.78f, 0.76f, 0.71f});
    m.accent = add_material(scene, "ochre", {0.80f, 0.54f, 0.32f});
    m.floor = add_material(scene, "floor", {0.52f, 0.36f, 0.23f});
    m.ceiling = add_material(scene, "ceiling", {0.84f, 0.83f, 0.80f});
    m.outside = add_material(scene, "outside", {0.45f, 0.44f, 0.42f});
    m.wood = add_material(scene, "wood", {0.50f, 0.30f, 0.16f});
    m.pale_wood = add_material(scene, "pale wood", {0.66f, 0.50f, 0.32f});
    m.metal = add_material(scene, "grey metal", {0.42f, 0.44f, 0.47f});
    m.black = add_material(scene, "black", {0.06f, 0.06f, 0.07f});
    m.white = add_material(scene, "white", {0.82f, 0.81f, 0.78f});
    m.fabric = add_material(scene, "blue fabric", {0.12f, 0.20f, 0.42f});
    m.leather = add_material(scene, "red leather", {0.50f, 0.10f, 0.08f});
    m.rug = add_material(scene, "rug", {0.22f, 0.34f, 0.36f});
    m.leaf = add_material(scene, "leaf", {0.14f, 0.36f, 0.10f});
    m.clay = add_material(scene, "clay", {0.60f, 0.28f, 0.16f});
    m.paper = add_material(scene, "paper", {0.85f, 0.84f, 0.80f});
    m.books = {add_material(scene, "red book", {0.58f, 0.10f, 0.09f}),
               add_material(scene, "blue book", {0.13f, 0.24f, 0.50f}),
               add_material(scene, "yellow book", {0.74f, 0.58f, 0.16f}),
               add_material(scene, "green book", {0.14f, 0.36f, 0.20f}),
               add_material(scene, "pale book", {0.72f, 0.68f, 0.58f})};
    return m;
}

void add_walls(Scene& scene, const OfficeMaterials& m) {
    Hollow room;
    room.cuts = {
        even_cuts(0.0, width, 3), std::vector<double>{0.0, sill, lintel, height},
        std::vector<double>{0.0, window_near, 0.5 * (window_near + window_far), window_far, depth}};
    room.materials = {m.plaster, m.accent, m.floor, m.ceiling, m.plaster, m.plaster};
    room.outside = m.outside;
    room.thickness = thickness;
    room.open = [](Wall wall, const glm::dvec3& at) {
        return wall == low_x && at.y > sill && at.y < lintel && at.z > window_near &&
               at.z < window_far;
    };
    add_hollow(scene, room);
    end_part(scene, "room");
    // Bars within the opening, in the middle of the wall.
    const double w = window_far - window_near, h = lintel - sill, bar = 0.05;
    const std::vector<double> across = {0.0, bar, 0.5 * (w - bar), 0.5 * (w + bar), w - bar, w};
    const std::vector<double> up = {0.0, bar, 0.68 * h, 0.68 * h + bar, h - bar, h};
    const Wood wood = [](int i, int j) { return i % 2 == 0 || j % 2 == 0; };
    add_carved(scene, placed({-0.5 * thickness, sill, window_far}, glm::half_pi<double>()), across,
               up, wood, 0.05, [&](int, int) { return m.white; });
    end_part(scene, "window");
}

void add_furniture(Scene& scene, const OfficeMaterials& m) {
    const double right_angle = glm::half_pi<double>();
    const auto part = [&](const char* name) { end_part(scene, name); };
    add_block(scene, placed({3.1, 0.0, 2.6}), {-1.25, 0.0, -0.95}, {1.25, 0.012, 0.95}, m.rug);
    part("rug");

    const Placement left = placed({0.40, 0.0, 2.05}, right_angle), back = placed({1.95, 0.0, 0.40});
    const glm::dvec3 top(0.0, 0.755, 0.0);
    for (const Placement& desk : {left, back}) {
        add_desk(scene, desk, m);
        part("desk");
    }
    add_monitor(scene, back(placed(top + glm::dvec3(-0.12, 0.0, -0.17))), m);
    part("monitor");
    add_desk_lamp(scene, left(placed(top + glm::dvec3(0.62, 0.0, -0.18), -0.7)), m);
    part("desk lamp");
    add_mug(scene, left(placed(top + glm::dvec3(0.36, 0.0, 0.06))), m.accent);
    part("mug");
    add_block(scene, back(placed(top + glm::dvec3(0.50, 0.0, 0.06), 0.3)), {-0.105, 0.0, -0.15},
              {0.105, 0.04, 0.15}, m.paper);
    add_block(scene, left(placed(top + glm::dvec3(-0.35, 0.0, 0.05), -0.2)), {-0.17, 0.0, -0.12},
              {0.17, 0.05, 0.12}, m.books[0]);
    part("papers");
    add_office_chair(scene, placed({1.90, 0.0, 1.18}, glm::pi<double>() + 0.5), m);
    part("chair");
    add_waste_bin(scene, placed({0.32, 0.0, 3.25}), m);
    part("waste bin");

    add_bookcase(scene, placed({4.15, 0.0, 0.0}), m);
    part("bookcase");
    add_plant(scene, placed({5.55, 0.0, 0.48}), m);
    part("plant");
    add_armchair(scene, placed({5.15, 0.0, 2.95}, -right_angle + 0.35), m);
    part("armchair");
    add_floor_lamp(scene, placed({5.68, 0.0, 2.12}), m);
    part("floor lamp");
    for (const double x : {1.9, 4.1}) {
        add_pendant(scene, placed({x, height, 2.3}), m);
        part("pendant");
    }
    add_picture(scene, placed({1.55, 1.70, 0.0}), {0.34, 0.26}, m.black, m.books[2]);
    add_picture(scene, placed({2.45, 1.70, 0.0}), {0.26, 0.26}, m.black, m.fabric);
    part("pictures");
}

}  // namespace
}  // namespace office_scene

void add_office(Scene& scene, const OfficeOptions& options) {
    using namespace office_scene;
    check_range("office", "illuminance", options.illuminance, 0.0, 1e20);
    const OfficeMaterials materials = add_materials(scene);
    add_walls(scene, materials);
    add_furniture(scene, materials);

    Light sun;
    sun.name = "sun";
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(glm::vec3(1.0f, -0.12f, -0.06f));
    sun.intensity = options.illuminance * glm::vec3(1.0f, 0.93f, 0.80f);
    scene.lights.push_back(sun);
    scene.cameras.push_back(look_at("camera", {2.35, 1.62, 4.45}, {3.35, 0.98, 0.9}, 1.02f));
}

}  // namespace generated

Scene office(const OfficeOptions& options) {
    Scene scene;
    scene.name = "office";
    generated::add_office(scene, options);
    return scene;
}

}  // namespace clgi
