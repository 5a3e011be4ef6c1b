// Small scenes of which it is known between which points something lies.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/analysis.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <string>
#include <vector>

#include "scenes.hpp"

namespace clgi::test {

// What shall be proven.
struct Proven {
    bool surfaces, apart, lights;
};

struct ConvexCase {
    std::string name;
    Scene scene;
    Proven proven;
};

inline Scene with_light(Scene scene, const Light& light) {
    scene.lights.push_back(light);
    return scene;
}

inline Scene both_sided(Scene scene) {
    for (Material& material : scene.materials) material.double_sided = true;
    return scene;
}

inline Scene emitting(Scene scene) {
    scene.materials[0].emission = glm::vec3(1.0f, 2.0f, 3.0f);
    return scene;
}

// From (0,0,0) to (1,1,1); facing +1 outward, -1 inward.
inline Scene unit_box(int facing) {
    Scene scene = plain_scene();
    add_box(scene, {0, 0, 0}, {1, 1, 1}, facing);
    return scene;
}

// A room without a ceiling.
inline Scene open_box() {
    Scene scene = unit_box(-1);
    std::vector<SceneTriangle> kept;
    for (const SceneTriangle& triangle : scene.triangles) {
        bool top = true;
        for (const std::uint32_t v : triangle.vertex) top = top && scene.positions[v].y == 1.0;
        if (!top) kept.push_back(triangle);
    }
    scene.triangles = kept;
    return scene;
}

// A horizontal unit square at a height; facing 1 up, -1 down.
inline void add_tile(Scene& scene, double x, double y, int facing = 1, std::uint32_t material = 0) {
    std::array<glm::dvec3, 4> corners = {
        glm::dvec3(x, y, 1), {x + 1, y, 1}, {x + 1, y, 0}, {x, y, 0}};
    if (facing < 0) std::swap(corners[1], corners[3]);
    add_quad(scene, corners, material);
}

struct Tile {
    double x, y;
    int facing = 1;
};
inline Scene tiles(const std::vector<Tile>& all) {
    Scene scene = plain_scene();
    for (const Tile& tile : all) add_tile(scene, tile.x, tile.y, tile.facing);
    return scene;
}

inline Scene with_triangle(Scene scene, const glm::dvec3& a, const glm::dvec3& b,
                           const glm::dvec3& c) {
    add_triangle(scene, a, b, c);
    return scene;
}

inline Scene two_boxes(int facing) {
    Scene scene = unit_box(facing);
    add_box(scene, {3, 0, 0}, {4, 1, 1}, facing);
    return scene;
}

inline Scene room_with_plate() {
    Scene scene = unit_box(-1);
    add_quad(scene, {glm::dvec3(0.4, 0.5, 0.6), {0.6, 0.5, 0.6}, {0.6, 0.5, 0.4}, {0.4, 0.5, 0.4}});
    return scene;
}

inline Scene masked(Scene scene) {
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].base_color.a = 0.0f;
    return scene;
}

inline std::vector<ConvexCase> convex_cases() {
    const Light sun = directional_light({0, -1, 0}), slanted = directional_light({1, -3, 1}),
                from_below = directional_light({0, 1, 0});
    const Light above = point_light({0.4, 3, 0.7}), within = point_light({0.4, 0.9, 0.7}),
                aside = point_light({-2, 0.5, 0.5}), below = point_light({0.4, -3, 0.7}),
                on_ceiling = point_light({0.4, 1, 0.7}),
                off_ceiling = point_light({0.4, 0.999, 0.7}),
                lamp = spot_light({0.4, 0.9, 0.7}, {0, -1, 0}, 0.4);
    Light dark = aside;
    dark.intensity = glm::vec3(0.0f);
    const Scene room = unit_box(-1), cube = unit_box(1), floor = tiles({{0, 0}});
    const Scene steps = tiles({{0, 1}, {0, 0, -1}, {0, -1, -1}});
    Scene upper_emits = steps;
    upper_emits.materials.push_back(upper_emits.materials[0]);
    upper_emits.materials[1].emission = glm::vec3(1.0f);
    Scene middle_emits = upper_emits;
    for (const std::size_t t : {0, 1}) {
        upper_emits.triangles[t].material = 1;
        middle_emits.triangles[t + 2].material = 1;
    }
    return {
        {"nothing", with_light(Scene(), above), {true, true, true}},
        {"triangle",
         with_triangle(plain_scene(), {0, 0, 0}, {1, 0, 0}, {0, 1, 0}),
         {true, true, true}},
        {"floor under the sun", with_light(floor, sun), {true, true, true}},
        {"floor under a slanted sun", with_light(floor, slanted), {true, true, true}},
        {"floor over a light", with_light(floor, below), {true, true, true}},
        {"both sides of a floor", with_light(both_sided(floor), from_below), {true, true, true}},
        {"emitting floor", emitting(floor), {true, true, true}},
        {"two tiles", with_light(tiles({{0, 0}, {1, 0}}), above), {true, true, true}},
        {"tiles shifted along their edge",
         with_light(with_triangle(floor, {1, 0, 0.3}, {1, 0, 0.7}, {2, 0, 0.5}), above),
         {true, true, true}},
        {"tile upon tile", with_light(tiles({{0, 0}, {0, 0}}), above), {false, false, false}},
        {"tile half upon tile",
         with_light(tiles({{0, 0}, {0.5, 0}}), above),
         {false, false, false}},
        {"tile against tile",
         with_light(tiles({{0, 0}, {0, 0, -1}}), above),
         {false, false, false}},
        {"plate of two sides", with_light(tiles({{0, 1}, {0, 0, -1}}), above), {true, true, true}},
        {"plate of two inner sides",
         with_light(tiles({{0, 1, -1}, {0, 0}}), above),
         {true, false, false}},
        {"floor and a higher one",
         with_light(tiles({{0, 0}, {1, 1}}), above),
         {true, false, false}},
        {"floor over what faces down", with_light(steps, sun), {false, false, true}},
        {"the same from below", with_light(steps, from_below), {false, false, false}},
        {"what emits sees nothing", upper_emits, {false, false, true}},
        {"what emits sees others", middle_emits, {false, false, false}},
        {"a higher floor emits", emitting(tiles({{0, 0}, {1, 1}})), {true, false, true}},
        // What lies in the floor's plane and faces down sees nothing.
        {"tiles of both facings below a third",
         with_light(tiles({{0, 0}, {1, 0, -1}, {0, 1}}), below),
         {true, false, true}},
        {"triangle beside a slanted side",
         with_light(with_triangle(with_triangle(plain_scene(), {0, 0, 0}, {2, 0, 0}, {0, 0, -2}),
                                  {1.05, 0, -1.05}, {1.9, 0, -1.1}, {1.3, 0, -1.9}),
                    above),
         {true, true, true}},
        {"sheet just behind a wall",
         with_light(with_triangle(room, {0.3, -3e-5, 0.3}, {0.3, -3e-5, 0.5}, {0.5, -3e-5, 0.3}),
                    within),
         {false, false, false}},
        {"cube", with_light(cube, above), {true, true, true}},
        {"cube under the sun", with_light(cube, sun), {true, true, true}},
        {"cube around a light", with_light(cube, within), {true, true, true}},
        {"emitting cube", emitting(cube), {true, true, true}},
        {"both sides of a cube", with_light(both_sided(cube), above), {true, false, false}},
        {"both sides of a cube around a light",
         with_light(both_sided(cube), within),
         {true, false, true}},
        {"room", with_light(room, within), {true, false, true}},
        {"room with a spot", with_light(room, lamp), {true, false, true}},
        {"room, masked", with_light(masked(room), within), {true, false, true}},
        {"both sides of a room", with_light(both_sided(room), within), {true, false, true}},
        {"emitting room", emitting(room), {true, false, true}},
        {"room, light outside", with_light(room, aside), {true, false, false}},
        {"room, dark light outside", with_light(room, dark), {true, false, true}},
        {"room, sun", with_light(room, sun), {true, false, false}},
        {"room, light on the ceiling", with_light(room, on_ceiling), {true, false, false}},
        {"room, light below the ceiling", with_light(room, off_ceiling), {true, false, true}},
        {"room, one light of two outside",
         with_light(with_light(room, within), aside),
         {true, false, false}},
        {"open box, sun", with_light(open_box(), sun), {true, false, true}},
        {"open box, slanted sun", with_light(open_box(), slanted), {true, false, false}},
        {"open box, light above", with_light(open_box(), above), {true, false, true}},
        {"open box, light aside", with_light(open_box(), aside), {true, false, false}},
        {"two cubes", with_light(two_boxes(1), above), {false, false, false}},
        {"two rooms", with_light(two_boxes(-1), within), {false, false, false}},
        {"plate in a room", with_light(room_with_plate(), within), {false, false, false}},
        {"emitting plate in a room", emitting(room_with_plate()), {false, false, false}},
        {"hair on a wall",
         with_light(with_triangle(room, {0.3, 0, 0.3}, {0.4, 0, 0.3}, {0.35, 1e-3, 0.3}), within),
         {false, false, false}},
        {"hair on a cube",
         with_light(with_triangle(cube, {0.3, 1, 0.3}, {0.4, 1, 0.3}, {0.35, 1.001, 0.3}), above),
         {false, false, false}},
        {"line in a wall",
         with_light(with_triangle(room, {0.3, 0, 0.3}, {0.4, 0, 0.3}, {0.5, 0, 0.3}), within),
         {true, false, true}},
        {"line across a room",
         with_light(with_triangle(room, {0.3, 0, 0.3}, {0.3, 0.5, 0.3}, {0.3, 1, 0.3}), within),
         {false, false, false}},
        {"sheet off a wall by a thousandth",
         with_light(with_triangle(room, {0.3, 1e-3, 0.3}, {0.3, 1e-3, 0.5}, {0.5, 1e-3, 0.3}),
                    within),
         {false, false, false}},
    };
}

// A scene with its lights turned about an odd axis, scaled and then moved.
inline Scene carried_off(Scene scene, double scale, const glm::dvec3& by) {
    const glm::dmat3 turn(glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(0.3, -0.5, 0.81)));
    for (glm::dvec3& p : scene.positions) p = turn * (scale * p) + by;
    for (glm::vec3& n : scene.normals) n = glm::vec3(turn * glm::dvec3(n));
    for (Light& light : scene.lights) {
        light.position = turn * (scale * light.position) + by;
        light.direction = glm::vec3(turn * glm::dvec3(light.direction));
        light.range *= static_cast<float>(scale);
    }
    return scene;
}

}  // namespace clgi::test
