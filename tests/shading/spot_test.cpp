// Which Halton points a spotlight takes: the counts of an independent program, and what stays put.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/procedural.hpp>
#include <cmath>
#include <numbers>

#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::PlacedLights;

constexpr double one_degree = std::numbers::pi / 180.0;

Scene room(const glm::vec3& direction, double angle) {
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(-1), glm::dvec3(1), -1);
    scene.lights = {test::spot_light({0, 0, 0}, direction, angle)};
    return scene;
}

PlacedLights placed(const glm::vec3& direction, double angle, int lights,
                    Math math = Math::strict) {
    return test::place_lights(test::on_device(room(direction, angle)), {.vpls = lights}, math);
}

CLGI_IN_BOTH_MATHS(Spot);

// Index of the last of N accepted points, found with numpy in double precision.
TEST_P(Spot, TakesTheIndicesOfTheTable) {
    const struct {
        glm::vec3 axis;
        double angle;
        cl_uint last[3];  // for 100, 300 and 450 lights
    } rows[] = {{{0, 0, 1}, 15, {5993, 17711, 26486}}, {{0, 0, 1}, 30, {1511, 4508, 6740}},
                {{0, 0, 1}, 45, {692, 2051, 3086}},    {{0, -1, 0}, 15, {5569, 17473, 26209}},
                {{0, -1, 0}, 30, {1489, 4417, 6718}},  {{0, -1, 0}, 45, {686, 2065, 3097}},
                {{1, 1, 1}, 15, {5540, 17300, 26024}}, {{1, 1, 1}, 30, {1520, 4520, 6740}},
                {{1, 1, 1}, 45, {664, 2050, 3074}}};
    const int counts[] = {100, 300, 450};
    for (const auto& row : rows)
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(
                placed(row.axis, row.angle * one_degree, counts[k], GetParam()).accepted.back(),
                row.last[k])
                << row.angle << " degrees, " << counts[k];
}

TEST(Spot, KeepsTheOrderOfTheSequence) {
    const auto accepted = placed({0.3f, -1, 0.2f}, 40 * one_degree, 1000).accepted;
    EXPECT_TRUE(std::is_sorted(accepted.begin(), accepted.end()));
    EXPECT_EQ(std::adjacent_find(accepted.begin(), accepted.end()), accepted.end());
    EXPECT_GE(accepted.front(), 1u);
}

TEST(Spot, TakesTheSameForEveryWorkGroup) {
    const DeviceScene scene = test::on_device(room({0.3f, -1, 0.2f}, 20 * one_degree));
    const PlacedLights usual = test::place_lights(scene, {.vpls = 333});
    for (const std::size_t size : {1, 7, 64, 256}) {
        const LightPasses passes(test::programs(), {.local_size = size});
        const PlacedLights other = test::place_lights(scene, {.vpls = 333}, passes);
        EXPECT_EQ(other.accepted, usual.accepted) << size;
        for (std::size_t i = 0; i < usual.lights.size(); ++i) {
            EXPECT_EQ(other.lights[i].position, usual.lights[i].position) << size;
            EXPECT_EQ(other.lights[i].flux, usual.lights[i].flux) << size;
        }
    }
}

TEST(Spot, LightsNothingOutsideItsCone) {
    for (const double angle : {0.1, 1.0, 10.0, 30.0, 60.0, 75.0, 90.0}) {
        const glm::vec3 axis = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
        for (const Vpl& light : placed(axis, angle * one_degree, 200).lights) {
            if (light.flux.w == 0.0f) continue;
            const double cosine =
                glm::dot(glm::normalize(glm::dvec3(light.position)), glm::dvec3(axis));
            // 1e-6: a few float spacings of a direction, once in the cone test and once in the hit.
            EXPECT_GE(cosine, std::cos(angle * one_degree) - 1e-6) << angle;
        }
    }
}

// However narrow the cone, it gets all its lights: where too many candidates would have to be
// rejected, the cone is mapped, and the list of accepted ones is not used.
TEST_P(Spot, FillsEveryConeThereIs) {
    for (const double angle : {1e-3, 0.01, 0.1, 0.5, 1.0, 5.0, 89.9, 90.0}) {
        const PlacedLights found = placed({0, -1, 0.01f}, angle * one_degree, 300, GetParam());
        std::size_t lit = 0;
        for (const Vpl& light : found.lights) {
            lit += light.flux.w > 0.0f;
            for (int c = 0; c < 4; ++c)
                EXPECT_TRUE(std::isfinite(light.position[c]) && std::isfinite(light.flux[c]));
        }
        EXPECT_EQ(lit, 300u) << angle;
    }
}

TEST(Spot, KnowsTheShareOfTheSphereInNarrowCones) {
    for (const auto& [angle, share] : {std::pair(0.01, 7.615435475e-09),
                                       {1.0, 7.61524218e-5},
                                       {5.0, .001902650954},
                                       {30.0, .06698729811},
                                       {90.0, .5}}) {
        const EmitterSet set =
            make_emitters(test::on_device(room({0, -1, 0}, angle * one_degree)), {});
        EXPECT_NEAR(set.emitters[0].measure, 4 * std::numbers::pi * share,
                    1e-6 * set.emitters[0].measure);
    }
}

// Points that a turned cone still covers are the same points.
TEST(Spot, KeepsTheLightsItStillCoversWhenItTurns) {
    const PlacedLights before = placed({0, -1, 0}, 30 * one_degree, 300);
    const PlacedLights after = placed({0.0872f, -0.9962f, 0}, 30 * one_degree, 300);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        const auto same =
            std::find(after.accepted.begin(), after.accepted.end(), before.accepted[i]);
        if (same == after.accepted.end()) continue;
        ++kept;
        const Vpl& moved = after.lights[static_cast<std::size_t>(same - after.accepted.begin())];
        // Another image shows the same plane: a few float spacings of a room of size 1.
        EXPECT_LT(glm::length(glm::vec3(moved.position - before.lights[i].position)), 2e-6f);
        EXPECT_EQ(glm::vec3(moved.normal), glm::vec3(before.lights[i].normal));
    }
    EXPECT_GT(kept, 240u);  // two 30 degree caps 5 degrees apart share 0.89 of their area
}

TEST(Spot, RefusesCountsOutOfRange) {
    const DeviceScene scene = test::on_device(room({0, -1, 0}, 1.0));
    EXPECT_THROW(make_emitters(scene, {.vpls = -1}), Error);
    EXPECT_THROW(make_emitters(scene, {.vpls = (1 << 20) + 1}), Error);
    EXPECT_THROW(make_emitters(scene, {.shadow_size = 0}), Error);
    EXPECT_THROW(make_emitters(scene, {.area_samples = -1}), Error);
}

}  // namespace
}  // namespace clgi
