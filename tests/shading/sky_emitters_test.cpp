// Emitters that stand for a part of the sky.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/emitters.hpp>
#include <cmath>

#include "device.hpp"
#include "frames.hpp"
#include "scene/environment.hpp"
#include "sources.hpp"

namespace clgi {
namespace {

// Lamps come first, then directions of what is asked for of the environment, then points of
// surfaces, both with maps of their own size.
TEST(Emitters, StandForAPartOfTheSky) {
    Scene world = scene_of_all();
    world.environment = test::picture_sky(
        64, 32, [](int row, int column) { return row == 5 && column == 9 ? 900.0f : 1.0f; });
    world.environment->factor = {4.0f, 2.0f, 1.0f};
    const DeviceScene scene = test::on_device(world);
    EmitterOptions options{.shadow_size = 64, .area_samples = 4, .environment_lights = 3};
    options.environment_size = 16;
    options.area_size = 8;
    const test::SkyBlock block = test::block_of(*world.environment, 5, 1, 9, 1);
    const glm::dvec3 toward = glm::normalize(test::vector_of(block));
    const BrightSky bright = scene.bright_sky();
    for (const SkyPart part : {SkyPart::bright, SkyPart::soft, SkyPart::whole})
        for (options.sample = 0; options.sample < 3; ++options.sample) {
            options.sky_part = part;
            const EmitterSet set = make_emitters(scene, options);
            EXPECT_EQ(set.lamps, 3u);
            EXPECT_EQ(set.directions, 3u);
            std::size_t near = 0;
            double lux = 0.0;
            for (std::size_t i = 0; i < set.emitters.size(); ++i) {
                const Emitter& one = set.emitters[i];
                const bool direction = i >= 3 && i < 3 + set.directions;
                EXPECT_EQ((one.kind & EMITTER_KIND) == EMITTER_AREA, i >= 3 && !direction) << i;
                if (i < 3) continue;
                for (std::uint32_t v = 0; v < one.view_count; ++v)
                    EXPECT_EQ(set.views[one.first_view + v].width, direction ? 16u : 8u);
                if (!direction) continue;
                const glm::dvec3 from(-one.axis.x, -one.axis.y, -one.axis.z);
                near += glm::dot(from, toward) > std::cos(0.08);
                lux += scene.frame().exposure * double{one.intensity.y};
            }
            EXPECT_EQ(set.views[set.emitters[0].first_view].width, 64u);
            if (part == SkyPart::bright) {
                EXPECT_EQ(near, set.directions);
                const double all = environment_fluence(*world.environment).y;
                EXPECT_NEAR(lux, bright.share * all, 1e-4 * all);
            } else if (part == SkyPart::soft) {
                EXPECT_EQ(near, 0u);
            }
        }
}

// The parts of a sky turn with it, in one copy of the scene alone.
TEST(Emitters, OfPartsTurnWithTheSky) {
    Scene world = scene_of_all();
    world.environment = test::picture_sky(
        64, 32, [](int row, int column) { return row == 5 && column == 9 ? 900.0f : 1.0f; });
    world.environment->rotation = 0.3f;
    DeviceScene scene = test::on_device(world);
    const DeviceScene copy = scene;
    const test::SkyBlock block = test::block_of(*world.environment, 5, 1, 9, 1);
    const auto off = [&](const DeviceScene& of, double rotation) {
        const Light light = of.environment_lights(1, SkyPart::bright).at(0);
        const glm::dvec3 toward = glm::normalize(test::vector_of(block, rotation));
        return glm::length(toward + glm::dvec3(light.direction));
    };
    EXPECT_LT(off(scene, 0.3), 1e-3);
    for (const double angle : {0.9, -0.4}) {
        scene.turn_environment(angle);
        EXPECT_LT(off(scene, 0.3 + angle), 1e-3) << angle;
        EXPECT_LT(off(copy, 0.3), 1e-3) << angle;
        EXPECT_EQ(scene.environment_part(SkyPart::soft)->rotation, scene.environment()->rotation);
    }
}

}  // namespace
}  // namespace clgi
