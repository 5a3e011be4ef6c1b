// Scenes that are drawn from seeds.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>

#include "lab/scenes/drawn.hpp"
#include "plan/reach.hpp"
#include "scene/validate.hpp"

namespace clgi {
namespace {

// What the scene's first camera reaches.
Reach reached(const Scene& scene) {
    return reach_of(scene, LocalScene(scene), scene.cameras.at(0), 160, 120);
}

TEST(DrawnScenes, AreTheSameTwiceAndDifferBySeed) {
    for (const DrawnKind& kind : drawn_kinds()) {
        const Scene a = drawn(kind.name, {.seed = 3}), b = drawn(kind.name, {.seed = 3}),
                    c = drawn(kind.name, {.seed = 4});
        EXPECT_TRUE(a.positions == b.positions) << kind.name;
        EXPECT_FALSE(a.positions == c.positions) << kind.name;
        EXPECT_EQ(a.name, kind.name);
    }
}

// Each is valid, has something to see before its camera, and light unless the sky is its light.
TEST(DrawnScenes, HaveAViewAndLight) {
    for (const DrawnKind& kind : drawn_kinds())
        for (std::uint32_t seed = 0; seed < 8; ++seed) {
            const Scene scene = drawn(kind.name, {.seed = seed});
            EXPECT_NO_THROW(validate(scene)) << kind.name;
            ASSERT_EQ(scene.cameras.size(), 1u);
            const Reach reach = reached(scene);
            EXPECT_GT(reach.points, 50u) << kind.name << " " << seed;
            bool light = !scene.lights.empty();
            for (const Material& material : scene.materials)
                light = light || material.emission != glm::vec3(0.0f);
            EXPECT_TRUE(light || kind.sky) << kind.name;
        }
}

TEST(DrawnScenes, GrowAroundTheSameRoom) {
    const Scene small = drawn("window", {.seed = 2, .extent = 100.0}),
                large = drawn("window", {.seed = 2, .extent = 10000.0});
    EXPECT_EQ(small.cameras[0].position, large.cameras[0].position);
    const Reach a = reached(small), b = reached(large);
    EXPECT_LT(b.size, 0.05 * a.size);
}

// The camera of the room of some seeds shows what the sun lights, and in no other way is light
// direct.
TEST(DrawnScenes, HaveTheSunThroughTheirWindow) {
    reference::Options options;
    options.effects = reference::parse_effects("direct");
    options.width = 48;
    options.height = 36;
    options.samples = 1;
    int lit = 0;
    for (std::uint32_t seed = 0; seed < 8; ++seed) {
        const Scene scene = drawn("sunlit", {.seed = seed});
        EXPECT_EQ(scene.positions.size(), drawn("window", {.seed = seed}).positions.size());
        const auto picture = reference::PathTracer(scene).render(scene.cameras[0], options);
        int pixels = 0;
        for (const glm::vec3& radiance : picture.radiance) pixels += radiance != glm::vec3(0.0f);
        EXPECT_LT(pixels, 48 * 36 / 2) << seed;
        lit += pixels > 0;
    }
    EXPECT_GE(lit, 4);
}

TEST(DrawnScenes, SayWhatIsWrong) {
    EXPECT_THROW(drawn("castle"), Error);
    EXPECT_THROW(drawn("room", {.extent = -1.0}), Error);
}

}  // namespace
}  // namespace clgi
