// How much of what surfaces send leaves a scene, against form factors.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/analysis.hpp>
#include <cmath>

#include "convex_scenes.hpp"

namespace clgi {
namespace {

constexpr double facing_squares = 0.1998248957;  // form factor of unit squares 1 apart, and
                                                 // of a face of a cube and the one across

// To three standard errors of 128 independent rays.
void expect_open(const Scene& scene, double open, const std::string& name) {
    const double error = std::sqrt(open * (1.0 - open) / 128.0);
    EXPECT_NEAR(scene_analysis(scene).openness, open, 3.0 * error) << name;
}

TEST(Openness, IsThatOfViewFactors) {
    using test::tiles;
    EXPECT_EQ(scene_analysis(tiles({{0, 0}})).openness, 1.0);
    EXPECT_EQ(scene_analysis(test::both_sided(tiles({{0, 0}}))).openness, 1.0);
    EXPECT_EQ(scene_analysis(test::unit_box(1)).openness, 1.0);
    EXPECT_EQ(scene_analysis(Scene()).openness, 1.0);
    EXPECT_EQ(scene_analysis(test::unit_box(-1)).openness, 0.0);
    EXPECT_EQ(scene_analysis(test::carried_off(test::unit_box(-1), 3.0, {1e5, 0, 0})).openness,
              0.0);
    expect_open(test::unit_box(-1), 0.0, "room");
    // Five unit faces see an opening of 1 as often as it sees them.
    expect_open(test::open_box(), 0.2, "open box");
    expect_open(test::both_sided(test::open_box()), 0.6, "both sides of an open box");
    expect_open(tiles({{0, 0}, {0, 1, -1}}), 1.0 - facing_squares, "facing squares");
    expect_open(test::both_sided(tiles({{0, 0}, {0, 1}})), 1.0 - 0.5 * facing_squares,
                "both sides of squares");
    expect_open(tiles({{0, 0}, {0, 1}}), 1.0 - 0.5 * facing_squares, "squares that face up");
    expect_open(test::masked(tiles({{0, 0}, {0, 1, -1}})), 1.0 - facing_squares, "masked");

    // A unit square and one twice its height on a common edge: 0.2328526 and half of it.
    Scene corner = tiles({{0, 0}});
    corner.materials.push_back(corner.materials[0]);
    test::add_quad(corner, {glm::dvec3(0, 0, 0), {1, 0, 0}, {1, 2, 0}, {0, 2, 0}}, 1);
    expect_open(corner, 1.0 - 2.0 / 3.0 * 0.2328526028, "corner");
    corner.materials[1].base_color = glm::vec4(0, 0, 0, 1);
    expect_open(corner, 1.0 - 0.2328526028, "beside black");
    std::swap(corner.materials[0], corner.materials[1]);
    expect_open(corner, 1.0 - 0.1164263014, "black");
    corner.materials[0] = corner.materials[1];
    EXPECT_GT(scene_analysis(corner).openness, 0.5);
    for (Material& material : corner.materials) material.base_color = glm::vec4(0, 0, 0, 1);
    EXPECT_EQ(scene_analysis(corner).openness, 0.0);
}

// A closed box, in which nothing is open, and a floor above it. The first look takes 128 points
// and cannot tell a share from one nearby that is asked for; the second one takes 1024.
TEST(Openness, IsLookedAtLongerNearSharesThatAreAskedFor) {
    for (const double asked : {0.3, 0.5})
        for (const double share : {asked - 0.025, asked + 0.025}) {
            Scene scene = test::unit_box(-1);
            const double length = 6.0 * share / (1.0 - share);
            test::add_quad(scene, {glm::dvec3(0, 2, 0), {0, 2, 1}, {length, 2, 1}, {length, 2, 0}});
            scene.environment = Environment{1, 1, {glm::vec3(1.0f)}};
            // Points lie in equal parts of the area, so one of them may be on the wrong side.
            EXPECT_NEAR(scene_analysis(scene).openness, share, 0.5 / 1024.0 + 1e-6) << share;
        }
}

}  // namespace
}  // namespace clgi
