// What surfaces have around them: shares against form factors, areas of shadows and lengths.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/analysis.hpp>
#include <cmath>
#include <numbers>

#include "convex_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double facing_squares = 0.1998248957;  // form factor of unit squares 1 apart, and
                                                 // of a face of a cube and the one across

void expect_open(const Scene& scene, double open, double backs, const std::string& name) {
    const SceneAnalysis analysis = scene_analysis(scene);
    EXPECT_NEAR(analysis.openness, open, 3.0 * analysis.openness_error) << name;
    EXPECT_NEAR(analysis.backs, backs, 3.0 * analysis.openness_error) << name;
    // Of 1024 rays, a half open: 1/64.
    EXPECT_LE(analysis.openness_error, 0.016) << name;
    EXPECT_GE(analysis.openness_error, 0.0009) << name;
}

TEST(Openness, IsThatOfViewFactors) {
    using test::tiles;
    const SceneAnalysis floor = scene_analysis(tiles({{0, 0}}));
    EXPECT_EQ(floor.openness, 1.0);
    EXPECT_EQ(floor.openness_error, 0.0);
    EXPECT_EQ(scene_analysis(test::both_sided(tiles({{0, 0}}))).openness, 1.0);
    EXPECT_EQ(scene_analysis(test::unit_box(1)).openness, 1.0);
    EXPECT_EQ(scene_analysis(Scene()).openness, 1.0);
    EXPECT_EQ(scene_analysis(test::unit_box(-1)).openness, 0.0);
    EXPECT_EQ(scene_analysis(test::carried_off(test::unit_box(-1), 3.0, {1e5, 0, 0})).openness,
              0.0);
    expect_open(test::unit_box(-1), 0.0, 0.0, "room");
    // Five unit faces see an opening of 1 as often as it sees them.
    expect_open(test::open_box(), 0.2, 0.0, "open box");
    expect_open(test::both_sided(test::open_box()), 0.6, 0.0, "both sides of an open box");
    expect_open(tiles({{0, 0}, {0, 1, -1}}), 1.0 - facing_squares, 0.0, "facing squares");
    expect_open(test::both_sided(tiles({{0, 0}, {0, 1}})), 1.0 - 0.5 * facing_squares, 0.0,
                "both sides of squares");
    expect_open(tiles({{0, 0}, {0, 1}}), 1.0 - 0.5 * facing_squares, 0.5 * facing_squares,
                "squares that face up");
    expect_open(test::masked(tiles({{0, 0}, {0, 1, -1}})), 1.0 - facing_squares, 0.0, "masked");

    // A unit square and one twice its height on a common edge: 0.2328526 and half of it.
    Scene corner = tiles({{0, 0}});
    corner.materials.push_back(corner.materials[0]);
    test::add_quad(corner, {glm::dvec3(0, 0, 0), {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}, 1);
    expect_open(corner, 1.0 - 2.0 / 3.0 * 0.2328526028, 0.0, "corner");
    corner.materials[1].base_color = glm::vec4(0, 0, 0, 1);
    expect_open(corner, 1.0 - 0.2328526028, 0.0, "beside black");
    std::swap(corner.materials[0], corner.materials[1]);
    expect_open(corner, 1.0 - 0.1164263014, 0.0, "black");
    corner.materials[0] = corner.materials[1];
    EXPECT_GT(scene_analysis(corner).openness, 0.5);
    for (Material& material : corner.materials) material.base_color = glm::vec4(0, 0, 0, 1);
    const SceneAnalysis black = scene_analysis(corner);
    EXPECT_EQ(black.openness, 0.0);
    EXPECT_EQ(black.openness_error, 0.0);
}

// 4 x 1 m, of which a black plate above covers the first square metre; light comes from above.
Scene floor_below_plate() {
    Scene scene = test::plain_scene();
    test::add_quad(scene, {glm::dvec3(0, 0, 0), {0, 0, 1}, {4, 0, 1}, {4, 0, 0}});
    Material black;
    black.base_color = glm::vec4(0, 0, 0, 1);
    black.double_sided = true;
    test::add_quad(scene, {glm::dvec3(0, 1, 0), {0, 1, 1}, {1, 1, 1}, {1, 1, 0}},
                   test::add_material(scene, black));
    return scene;
}

constexpr double few_points = 0.05;  // of 256, more even than independent ones

void expect_lit(const Scene& scene, double lit, double twice, const std::string& name) {
    for (const Scene& same : {scene, test::carried_off(scene, 3.0, {100, 20, -50})}) {
        const SceneAnalysis analysis = scene_analysis(same);
        EXPECT_NEAR(analysis.lit, lit, lit > 0.0 && lit < 1.0 ? few_points : 0.0) << name;
        EXPECT_NEAR(analysis.lit_twice, twice, twice > 0.0 && twice < 1.0 ? few_points : 0.0)
            << name;
    }
}

TEST(LitParts, AreWhereNothingIsBetween) {
    const Scene dark = floor_below_plate();
    const Light down = test::directional_light({0, -1, 0});
    const auto with = [&](const Light& light) { return test::with_light(dark, light); };
    expect_lit(dark, 0.0, 0.0, "no light");
    expect_lit(with(down), 0.75, 0.0, "from above");
    expect_lit(with(test::directional_light({0, -1, 0}, 0.0f)), 0.0, 0.0, "without power");
    expect_lit(with(test::directional_light({0, 1, 0})), 0.0, 0.0, "from below");
    // Its shadow is the second square metre.
    const Light aslant = test::directional_light(glm::normalize(glm::vec3(1, -1, 0)));
    expect_lit(test::with_light(with(down), aslant), 1.0, 0.5, "two");
    expect_lit(test::with_light(with(down), down), 0.75, 1.0, "the same twice");
}

TEST(LitParts, AreWithinRangesAndCones) {
    const Scene dark = floor_below_plate();
    const double disc = pi * 0.4 * 0.4 / 4.0;
    Light point = test::point_light({2.5, 1, 0.5});
    expect_lit(test::with_light(dark, point), 1.0, 0.0, "beside the plate");
    point.range = std::sqrt(1.16f);
    expect_lit(test::with_light(dark, point), disc, 0.0, "range");
    const Light spot = test::spot_light({2.5, 1, 0.5}, {0, -1, 0}, std::atan(0.4));
    expect_lit(test::with_light(dark, spot), disc, 0.0, "cone");
    Scene shadowed = dark;
    shadowed.lights = {test::point_light({0.5, 2, 0.5})};  // its shadow is two metres long
    expect_lit(shadowed, 1.0 - 1.5 / 4.0, 0.0, "above the plate");
}

TEST(LitParts, AreThoseOfEmissiveSurfaces) {
    for (const bool up : {false, true}) {
        Scene scene = floor_below_plate();
        Material lamp;
        lamp.base_color = glm::vec4(0, 0, 0, 1);
        lamp.emission = glm::vec3(1.0f);
        std::array<glm::dvec3, 4> corners{
            {glm::dvec3(0, 2, 0), {1, 2, 0}, {1, 2, 1}, {0, 2, 1}}};  // seen from below
        if (up) std::swap(corners[1], corners[3]);
        test::add_quad(scene, corners, test::add_material(scene, lamp));
        const SceneAnalysis analysis = scene_analysis(scene);
        // Below a lamp a plate at half the height, as large: no point under it is lit; to its side
        // up to twice its width is half in the shadow.
        EXPECT_NEAR(analysis.lit, up ? 0.0 : (0.5 + 2.0) / 4.0, up ? 0.0 : few_points);
        EXPECT_EQ(analysis.lit_twice, 0.0);
        scene.lights = {test::directional_light({0, -1, 0})};
        EXPECT_EQ(scene_analysis(scene).lit_twice > 0.5, !up);
    }
}

// Of more lights than a point looks for each has its turn.
TEST(LitParts, OfManyLightsAreEstimates) {
    Scene scene = floor_below_plate();
    scene.lights.assign(40, test::directional_light({0, 1, 0}));
    scene.lights[17].direction = {0, -1, 0};
    EXPECT_NEAR(scene_analysis(scene).lit, 0.75 * 16.0 / 40.0, few_points);
    scene.lights.assign(40, scene.lights[17]);
    expect_lit(scene, 0.75, 1.0, "all");
    // The last eighth of very many from above: each point looks for two of it.
    scene.lights.assign(10000, test::directional_light({0, 1, 0}));
    for (std::size_t k = 8750; k < 10000; ++k) scene.lights[k].direction = {0, -1, 0};
    expect_lit(scene, 0.75, 1.0, "the last");
}

// Light along a wall, and a lamp that is flush with others: rounding does not decide.
TEST(LitParts, AreNotWhatLightGrazes) {
    const int n = 12;
    Scene wall = test::plain_scene();
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y) test::add_tile(wall, x, y);
    wall.lights = {test::directional_light({1, 0, 0})};
    Scene lamp = test::plain_scene();
    lamp.materials[0].emission = glm::vec3(1.0f);
    for (int x = 0; x < n; ++x) test::add_tile(lamp, x, 0);
    for (int turn = 0; turn < 20; ++turn) {
        wall = test::carried_off(wall, 1.0, {0.1 * turn, 0.3, 0.2});
        lamp = test::carried_off(lamp, 1.0, {0.1 * turn, 0.3, 0.2});
        EXPECT_EQ(scene_analysis(wall).lit, 0.0) << turn;
        EXPECT_EQ(scene_analysis(lamp).lit, 0.0) << turn;
    }
}

TEST(Walls, AreAsThickAsTheyAre) {
    const auto slab = [](double thickness) {
        Scene scene = test::plain_scene();
        test::add_box(scene, {0, 0, 0}, {4, thickness, 4}, 1);
        test::add_box(scene, {5, 0, 0}, {7, 2, 2}, 1);
        return scene;
    };
    // A hundredth of the diagonal of 7 x 2 x 4 m are 0.083 m.
    const SceneAnalysis analysis = scene_analysis(slab(0.02));
    EXPECT_NEAR(analysis.thin, 32.0 / (32.0 + 4 * 0.08 + 24.0), few_points);
    EXPECT_NEAR(analysis.thinnest, 0.02, 1e-6);
    const SceneAnalysis carried =
        scene_analysis(test::carried_off(slab(0.02), 3.0, {100, 20, -50}));
    EXPECT_NEAR(carried.thin, analysis.thin, few_points);
    EXPECT_NEAR(carried.thinnest, 0.06, 1e-5);
    const SceneAnalysis thicker = scene_analysis(slab(0.1));
    EXPECT_EQ(thicker.thin, 0.0);
    EXPECT_NEAR(thicker.thinnest, 0.1, 1e-6);
}

TEST(Walls, EndAtBacksAlone) {
    for (const Scene& scene :
         {test::unit_box(-1), test::tiles({{0, 0}, {0, 1e-3}}),  // sheets that face one way
          test::both_sided(test::tiles({{0, 0}, {0, 1e-3, -1}}))}) {
        EXPECT_EQ(scene_analysis(scene).thin, 0.0);
        EXPECT_EQ(scene_analysis(scene).thinnest, 0.0);
    }
    EXPECT_EQ(scene_analysis(test::tiles({{0, 1e-3}, {0, 0, -1}})).thin, 1.0);
    EXPECT_NEAR(scene_analysis(test::unit_box(1)).thinnest, 1.0, 1e-6);  // the proof needs no rays
}

}  // namespace
}  // namespace clgi
