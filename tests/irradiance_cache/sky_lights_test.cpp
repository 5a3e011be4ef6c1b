// Light of the sky between the records of an irradiance cache.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/irradiance_cache.hpp>
#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>

#include "apart.hpp"
#include "cache_pictures.hpp"
#include "methods/irradiance_cache/correction_totals.hpp"
#include "scenes.hpp"
#include "skies.hpp"
#include "sky_pictures.hpp"

namespace clgi {
namespace {

// Few records stand far apart, so their light is a blur: directions of the sky find the shadows.
TEST(SkyLights, FindShadowsBetweenRecords) {
    const Scene scene = posts();
    const test::Twice twice = truth_of(scene);
    const DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(12, 100);
    options.refined = 0;
    const auto found = [&](int lights, bool direct, std::uint32_t samples = 40) {
        options.sky_lights = lights;
        options.picture.emitters.shadows = direct;  // of the scene's lights, and there is none
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        const test::Apart out = test::apart(sampled(cache, scene.cameras[0], samples), twice);
        EXPECT_EQ(cache.status().non_finite, 0u);
        return out;
    };
    const test::Apart without = found(0, true), with = found(16, true);
    EXPECT_GT(without.error, 0.085);
    EXPECT_LT(with.error, 0.25 * without.error);
    EXPECT_NEAR(with.energy, 1.0, 0.02);
    EXPECT_LT(found(16, false).error, 0.25 * without.error);
    // The first sample has no correction; those after it have four each. With one each the mean of
    // six replicates is 0.093 and 0.073, with four 0.075 and 0.062.
    const auto mean_of_replicates = [&](std::uint32_t samples) {
        constexpr std::uint32_t replicates = 6;
        double sum = 0.0;
        for (std::uint32_t k = 0; k < replicates; ++k) {
            options.picture.emitters.replicate = k;
            sum += found(16, true, samples).error;
        }
        return sum / replicates;
    };
    EXPECT_LT(mean_of_replicates(2), 0.079);
    EXPECT_LT(mean_of_replicates(3), 0.066);
}

// Maps cover what the picture shows, however large the scene is, and its focus where the picture
// shows much more.
TEST(SkyLights, FindShadowsInALargeSceneToo) {
    IrradianceCacheOptions options = cache_options(12, 100);
    options.refined = 0;
    options.picture.emitters.shadow_size = 128;
    const auto found = [&](const Scene& scene) {
        const DeviceScene device = test::on_device(scene);
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        return test::apart(sampled(cache, scene.cameras[0], 40), truth_of(scene));
    };
    Scene behind = posts();
    test::add_box(behind, {-20, -5, 900}, {20, -1, 910}, 1);  // the eye
    Scene before = posts();
    test::add_quad(before,
                   {glm::dvec3(-900, -9, 900), {900, -9, 900}, {900, -9, -900}, {-900, -9, -900}});
    before.focus = Focus{{0.0, 0.3, 0.0}, 5.0};
    for (const Scene& scene : {behind, before}) {
        const test::Apart one = found(scene);
        EXPECT_LT(one.error, 0.05);
        EXPECT_NEAR(one.energy, 1.0, 0.02);
    }
}

// Walls without thickness, seen by directions from behind through maps of few texels: their corners
// stay as dark as they are.
TEST(SkyLights, StayOutsideOfThinWalls) {
    Scene scene = cornell();
    for (Material& material : scene.materials) material.emission = glm::vec3(0.0f);
    scene.environment = test::picture_sky(8, 4, [](int, int) { return 1.0f; });
    const test::Twice twice = truth_of(scene);
    const DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(100, 300);
    options.picture.emitters.shadow_size = 32;
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    const test::Apart found = test::apart(sampled(cache, scene.cameras[0], 24), twice);
    EXPECT_LT(found.error, 0.03);  // 0.04 where texels past the corners count
    EXPECT_NEAR(found.energy, 1.0, 0.004);
}

Scene beside_a_roof() {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_quad(scene, {glm::dvec3(-4, 0, 4), {4, 0, 4}, {4, 0, -4}, {-4, 0, -4}});
    test::add_box(scene, {-4, 0.6, -4}, {-0.5, 0.7, 4}, 1);
    scene.environment = posts().environment;
    scene.cameras = {test::camera_at({0.3, 1.0, 0.01}, {0.0, 0.0, 0.0}, 0.6f)};
    return scene;
}

// Records beside what the picture shows stand in for it too: under a roof whose edge lies just out
// of the picture they are dark.
TEST(SkyLights, KnowRecordsBesideThePicture) {
    const Scene scene = beside_a_roof();
    const test::Twice twice = truth_of(scene);
    const DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(4, 60);
    options.refined = 0;
    options.sky_lights = 16;
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    const test::Apart found = test::apart(sampled(cache, scene.cameras[0], 40), twice);
    EXPECT_LT(found.error, 0.03);
    EXPECT_NEAR(found.energy, 1.0, 0.01);
}

// Later samples look past the outermost pixels of the first, and are corrected there too: towards
// the roof, in whose shadow the picture's left edge lies.
TEST(SkyLights, CorrectThePicturesBorder) {
    const Scene scene = beside_a_roof();
    const DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(4, 0);
    options.refined = 0;
    const auto border = [&](const Camera& camera, const glm::vec2& aside) {
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        const auto picture = sampled(cache, camera, 24, aside);
        double sum = 0.0;
        for (std::size_t y = 0; y < cache_height; ++y) sum += double{picture[y * cache_width].y};
        return sum;
    };
    for (const float aside : {-0.49f, 0.49f}) {
        Camera shifted = scene.cameras[0];
        shifted.offset.x += aside;
        const double wanted = border(shifted, glm::vec2(0.0f));
        EXPECT_NEAR(border(scene.cameras[0], {aside, 0.0f}) / wanted, 1.0, 0.02) << aside;
    }
}

// Where hemicubes know the light, directions of the sky change next to nothing: of a convex ground
// every part of the sky is seen as by the records.
TEST(SkyLights, LeaveAloneWhatRecordsKnow) {
    Scene scene = posts();
    scene.triangles.resize(2);
    const DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(12, 0);
    options.refined = 0;
    const auto found = [&](int lights) {
        options.sky_lights = lights;
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        return sampled(cache, scene.cameras[0], 6);
    };
    const auto without = found(0), with = found(16);
    for (std::size_t i = 0; i < with.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(with[i][c], without[i][c], 0.003f * without[i][c]);
}

// Later samples of a scene of many triangles have their directions in common, four at a time, and
// are as right.
TEST(SkyLights, AreTheSameForSamplesOfFineScenes) {
    Scene scene = posts();
    const test::Twice twice = truth_of(scene);
    constexpr int fine = 72;  // below the ground, 10,368 triangles
    for (int k = 0; k < fine * fine; ++k) {
        const double x = -3.0 + 6.0 * (k % fine) / fine, z = -3.0 + 6.0 * (k / fine) / fine,
                     side = 6.0 / fine;
        test::add_quad(
            scene,
            {glm::dvec3(x, -2, z + side), {x + side, -2, z + side}, {x + side, -2, z}, {x, -2, z}});
    }
    IrradianceCacheOptions options = cache_options(12, 100);
    options.refined = 0;
    options.sky_lights = 16;
    const auto settled = [](const std::vector<PassEvent>& events) {
        return std::any_of(events.begin(), events.end(),
                           [](const PassEvent& pass) { return pass.name == "cache.settle"; });
    };
    for (const bool many : {false, true}) {
        const DeviceScene device = test::on_device(many ? scene : posts());
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        cache.render(scene.cameras[0]).wait();
        for (std::uint32_t sample = 1; sample < 26; ++sample) {
            cache.sample(sample);
            cache.render_again(scene.cameras[0]).wait();
            EXPECT_EQ(settled(cache.events()), !many || sample <= 16 || sample % 4 == 0) << sample;
        }
        EXPECT_LT(test::apart(sampled(cache, scene.cameras[0], 60), twice).error, 0.03) << many;
        cache.sample(2);  // twice, each time in parts
        for (int k = 0; k < 2; ++k) {
            cache.render_again(scene.cameras[0]).wait();
            EXPECT_TRUE(settled(cache.events()));
        }
    }
}

// 3, 3 again, 5, 4, 4 twice more: of sets of 6, 5 and 12.
TEST(SkyLights, CountDirectionsThatComeAgainAsOneSet) {
    CorrectionTotals totals;
    for (const auto& [directions, again] : {std::pair(3.0f, false),
                                            {3.0f, true},
                                            {5.0f, false},
                                            {4.0f, false},
                                            {4.0f, true},
                                            {4.0f, true}})
        totals.add(directions, again);
    EXPECT_EQ(totals.total, 23.0f);
    EXPECT_EQ(totals.squares, 36.0f + 25.0f + 144.0f);
}

// A picture from elsewhere, or under a sky that has turned, has none of the corrections before it.
TEST(SkyLights, BelongToOnePicture) {
    const Scene scene = posts();
    DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(12, 20);
    options.refined = 5;
    options.sky_lights = 4;
    const Camera other = test::camera_at({-1.6, 2.0, 2.0}, {0.3, 0, 0}, 0.9f);
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    const auto fresh = [&](const Camera& camera) {
        IrradianceCache one(test::programs(), test::device().queue, device, options);
        return sampled(one, camera, 7);
    };
    const auto first = sampled(cache, scene.cameras[0], 7);
    EXPECT_TRUE(test::same_bits(sampled(cache, other, 7), fresh(other)));
    EXPECT_TRUE(test::same_bits(sampled(cache, scene.cameras[0], 7), first));
    device.turn_environment(1.0);
    cache.lights_changed();
    const auto turned = sampled(cache, scene.cameras[0], 7);
    EXPECT_TRUE(test::same_bits(turned, fresh(scene.cameras[0])));
    EXPECT_FALSE(test::same_bits(turned, first));
}

TEST(SkyLights, NeedASkyThatIsSeen) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_box(scene, {-1, 0, -1}, {1, 2, 1}, -1);  // closed, from within
    scene.lights = {test::point_light({0.2, 1.5, 0.1}, 4.0f)};
    scene.cameras = {test::camera_at({0.5, 0.8, 0.6}, {-0.4, 0.6, -0.5}, 1.2f)};
    IrradianceCacheOptions options = cache_options(10, 20);
    const auto picture = [&] {
        const DeviceScene device = test::on_device(scene);
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        const auto out = sampled(cache, scene.cameras[0], 3);
        // What records see of it was asked for once, in the second sample.
        for (const PassEvent& pass : cache.events()) EXPECT_NE(pass.name, "cache.sight");
        return out;
    };
    const auto closed = picture();
    scene.environment = test::even_sky({1.0f, 2.0f, 3.0f});
    EXPECT_TRUE(test::same_bits(picture(), closed));
    scene.environment->factor = glm::vec3(0.0f);
    EXPECT_TRUE(test::same_bits(picture(), closed));
}

}  // namespace
}  // namespace clgi
