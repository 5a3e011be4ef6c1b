// The far part of a scene needs several bounces, as in figure 10 of [Schaerfig16].
//
// In the corridor a lamp hangs in the first room on the left and shines straight down. Its light
// reaches the corridor with the first bounce, and the first room on the right with the second. The
// wall of that room that has the door faces away from the corridor. It sees nothing but its own
// room, so no light reaches it before the third bounce.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numeric>

#include "lab/scenes/rooms.hpp"
#include "light_baking.hpp"

namespace clgi {
namespace {

using test::Bakery;

Scene lit_from_a_room(double door) {
    CorridorOptions options;
    options.door_angle = static_cast<float>(glm::radians(door));
    Scene scene = corridor(options);
    scene.lights[0].position = {-2.6, 2.3, -2.9};
    scene.lights[0].direction = {0.0, -1.0, 0.0};
    return scene;
}

// Texels on the inner side of the wall with the door, in the first room on the right. Walls are
// 0.12 m thick, the corridor is 2 m wide, rooms are 4 m long.
std::vector<std::size_t> far_texels(const Bakery& bakery) {
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < bakery.atlas.texels.size(); ++i) {
        const AtlasTexel& texel = bakery.atlas.texels[i];
        const glm::dvec3 at = test::position(bakery.scene, texel);
        const glm::dvec3 normal = glm::normalize(test::normal_of(bakery.scene, texel.triangle));
        if (at.z > -4.0 && std::abs(at.x - 1.12) < 1e-4 && normal.x > 0.999) out.push_back(i);
    }
    return out;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Mean irradiance of the far part with so many bounces, lux, all channels summed.
double baked(const Bakery& bakery, const std::vector<std::size_t>& far, std::uint32_t bounces) {
    LightAtlasOptions options;
    options.bounces = bounces;
    const test::Baked made = test::bake(bakery, options);
    std::vector<double> values;
    for (const std::size_t i : far)
        values.push_back(made.texels[i].x + made.texels[i].y + made.texels[i].z);
    return mean(values);
}

double traced(const Bakery& bakery, const std::vector<std::size_t>& far, int bounces, int samples) {
    std::vector<reference::Place> places;
    for (const std::size_t i : far) {
        const AtlasTexel& texel = bakery.atlas.texels[i];
        const glm::vec3 normal(glm::normalize(test::normal_of(bakery.scene, texel.triangle)));
        places.push_back({test::position(bakery.scene, texel), normal, normal});
    }
    reference::Options options;
    options.effects.emission = options.effects.direct = false;
    options.effects.last_bounce = bounces;
    options.samples = samples;
    std::vector<double> values;
    for (const glm::vec3& value :
         reference::PathTracer(bakery.scene).irradiance(places, options).values)
        values.push_back(value.x + value.y + value.z);
    return mean(values);
}

// Dark: at most one part in ten thousand of the light of 20 bounces. Lit: at least one in twenty;
// the scene is so dark there that 20 bounces are about ten times three.
TEST(LightAtlasBounces, TheThirdIsTheFirstThatReachesTheFarPart) {
    for (const double door : {60.0, 90.0}) {
        const Bakery bakery(lit_from_a_room(door),
                            {.vpls = 1600, .atlas = 128, .samples_per_vpl = 48});
        const std::vector<std::size_t> far = far_texels(bakery);
        ASSERT_GT(far.size(), 100u);
        const double many = baked(bakery, far, 20);
        EXPECT_GT(many, 0.0);
        EXPECT_LT(baked(bakery, far, 1), 1e-4 * many) << door;
        EXPECT_LT(baked(bakery, far, 2), 1e-4 * many) << door;
        EXPECT_GT(baked(bakery, far, 3), 0.05 * many) << door;
    }
}

// No path of two bounces exists, so the path tracer finds none. Paths of three are so rare that its
// mean of two million is uncertain; the bake is within a factor of two of it.
TEST(LightAtlasBounces, TheThirdIsTheFirstInThePathTracerToo) {
    const Bakery bakery(lit_from_a_room(60.0), {.vpls = 1600, .atlas = 128, .samples_per_vpl = 48});
    const std::vector<std::size_t> far = far_texels(bakery);
    EXPECT_EQ(traced(bakery, far, 2, 4096), 0.0);
    const double third = traced(bakery, far, 3, 16384);
    EXPECT_GT(third, 0.0);
    const double found = baked(bakery, far, 3);
    EXPECT_GT(found, 0.5 * third);
    EXPECT_LT(found, 2.0 * third);
}

}  // namespace
}  // namespace clgi
