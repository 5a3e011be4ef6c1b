// Small bright parts of the sky: they light pixels as lamps do, and of many hemicubes see what they
// bring.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/emitters.hpp>
#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>
#include <glm/gtc/constants.hpp>

#include "sky_pictures.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

// The bright part of a sky counts as light, and is known beside it, so that what is shown can lack
// it.
TEST(BrightSky, IsKnownBesideAllLight) {
    const DeviceScene scene = test::on_device(furnace({.subdivisions = 1}));
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    TwoRecords two;
    look_up(two.b, 16);
    two.b.sky = test::upload(std::vector<float>{0, 0, 0, 1, 2, 4, 30, 20, 10, 0, 0, 0});
    CacheParams params{};
    params.count = 2;
    params.stride = plane;
    params.row_stride = 16;
    params.size = 16;
    params.sky = {1.0f, 0.5f, 2.0f, 1.0f};
    params.sky_width = 2;
    params.sky_height = 1;
    params.emitter_step = params.thin = params.every = 1;
    const float soft[] = {1, 2, 4}, bright[] = {30, 20, 10}, factor[] = {1.0f, 0.5f, 2.0f};
    for (const std::uint32_t with : {0u, 1u}) {
        params.bright = with;
        passes.link(queue, params, two.tree, scene, no_emitters(), two.b);
        passes.bounce(queue, {2, plane, 0, 16}, two.b);
        const auto base = test::download<float>(two.b.base, 3 * plane),
                   known = test::download<float>(two.b.bright, 3 * plane),
                   next = test::download<float>(two.b.next, 3 * plane),
                   shown = test::download<float>(two.b.shown, 3 * plane);
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t i = c * plane; i < c * plane + 2; ++i) {
                const double half = glm::half_pi<double>() * double{factor[c]};
                const double of_soft = half * double{soft[c]},
                             of_bright = with ? half * double{bright[c]} : 0.0;
                EXPECT_NEAR(known[i], of_bright, 0.02 * of_bright);
                EXPECT_NEAR(base[i], of_soft + of_bright, 0.02 * (of_soft + of_bright));
                EXPECT_NEAR(shown[i], of_soft, 0.02 * of_soft + 1e-5 * of_bright);
                EXPECT_EQ(next[i], base[i]);
            }
    }
}

// Light of lamps in the middle of a sphere, once reflected, is rho I / R^2; of emitters that are
// skipped there is none, and others take turns after them.
TEST(BrightSky, HasEmittersThatLightPixelsAlone) {
    Scene sphere = furnace({.subdivisions = 3});
    sphere.materials[0].base_color = glm::vec4(0.2f, 0.5f, 0.7f, 1.0f);
    sphere.lights = {test::point_light({0, 0, 0}, 1.0f), test::point_light({0, 0, 0}, 1.0f),
                     test::point_light({0, 0, 0}, 1.0f)};
    const glm::dvec3 intensity[] = {{1, 2, 3}, {50, 10, 20}, {7, 4, 1}};
    for (std::size_t i = 0; i < 3; ++i) sphere.lights[i].intensity = glm::vec3(intensity[i]);
    const DeviceScene scene = test::on_device(sphere);
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    constexpr std::uint32_t size = 16;
    TwoRecords two;
    look_up(two.b, size);
    GBufferPasses(test::programs(), test::usual_build())
        .raster_views(queue, {0, 10, size, size, 6 * size * size}, two.b.views, scene,
                      two.b.visibility, Pixels::visibility);
    const EmitterSet set = make_emitters(scene, {.area_samples = 0, .shadows = false});
    ASSERT_EQ(set.emitters.size(), 3u);
    EmitterBuffers emitters = no_emitters();
    emitters.emitters = test::upload(set.emitters);
    CacheParams params{};
    params.count = 2;
    params.stride = params.row_stride = plane;
    params.size = size;
    params.emitter_count = 3;
    params.emitter_step = params.thin = params.every = 1;
    const glm::dvec3 rho(0.2, 0.5, 0.7);
    for (std::uint32_t whole = 0; whole <= 3; ++whole)
        for (std::uint32_t skipped = 0; whole + skipped <= 3; ++skipped) {
            params.whole_emitters = whole;
            params.skipped = skipped;
            passes.link(queue, params, two.tree, scene, emitters, two.b);
            const auto found = test::download<float>(two.b.reflected, 3 * plane);
            glm::dvec3 wanted(0.0);
            for (std::uint32_t i = 0; i < 3; ++i)
                if (i < whole || i >= whole + skipped)
                    wanted += rho * intensity[i] / scene.frame().exposure;
            for (std::size_t c = 0; c < 3; ++c) {
                const double of = wanted[static_cast<int>(c)];
                EXPECT_NEAR(found[c * plane + 1], of, 0.03 * of) << whole << " " << skipped;
            }
        }
    params.skipped = 1;  // of none that is left
    EXPECT_THROW(passes.link(queue, params, two.tree, scene, emitters, two.b), Error);
}

// Small bright parts of the sky have shadows of their own: a sun lights what hemicubes see as a
// lamp does, and of many lamps hemicubes see what they bring. Without direct light hemicubes see
// all.
TEST(BrightSky, LightsPixelsWithShadowsOfItsOwn) {
    Scene scene = posts();
    test::add_box(scene, {-2.4, -1.5, -2.0}, {-2.2, 1.6, 2.0}, 1);
    for (const bool many : {false, true}) {
        const auto is_lamp = [&](int row, int column) {
            const bool sun = row == 5 && column == 37;
            return sun || (many && (row == 6 || row == 25) && (column == 20 || column == 50));
        };
        scene.environment = test::picture_sky(64, 32, [&](int row, int column) {
            return is_lamp(row, column) ? (many ? 500.0f : 900.0f) : row < 16 ? 0.7f : 0.0f;
        });
        scene.environment->factor = {1.0f, 0.8f, 0.5f};
        const test::Twice twice = truth_of(scene);
        const DeviceScene device = test::on_device(scene);
        EXPECT_GT(device.bright_sky().share, 0.4);
        IrradianceCacheOptions options = cache_options(60, 200);
        options.picture.emitters.shadows = false;  // of the scene's lights, and there is none
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        EXPECT_EQ(cache.picture().emitters().directions, many ? 16u : 1u);
        const test::Apart found =
            test::apart(sampled(cache, scene.cameras[0], many ? 64 : 24), twice);
        EXPECT_LT(found.high, many ? 0.035 : 0.03);  // maps of many are half as fine
        EXPECT_NEAR(found.energy, 1.0, 0.01);
        // Of those that are below the ground few are drawn.
        const EmitterSet& last = cache.picture().emitters();
        std::size_t above = 0;
        for (const Emitter& one : last.emitters) above += one.axis.y < 0.0f;
        EXPECT_GT(above, many ? 12u : 0u);
        options.picture.direct = false;
        options.sky_lights = 0;
        IrradianceCache whole(test::programs(), test::device().queue, device, options);
        EXPECT_EQ(whole.picture().emitters().directions, 0u);
        const test::Apart coarse = test::apart(sampled(whole, scene.cameras[0], 1), twice);
        EXPECT_GT(coarse.error, 2.5 * found.error);
        EXPECT_NEAR(coarse.energy, 1.0, 0.1);
    }
}

// Directions of many are drawn where records see the sky, in the first sample of a picture already,
// and before records read a lamp's shadow map. A picture is the same again after whatever other
// pictures.
TEST(BrightSky, IsAimedAtByTheFirstSample) {
    Scene scene = posts();
    scene.environment = test::picture_sky(64, 32, [](int row, int column) {
        const bool lamp = (row == 6 || row == 25) && (column == 20 || column == 50);
        return lamp ? 500.0f : row < 16 ? 0.7f : 0.0f;
    });
    scene.lights = {test::point_light({0.3f, 1.5f, 0.2f}, 300.0f)};
    const DeviceScene device = test::on_device(scene);
    IrradianceCache cache(test::programs(), test::device().queue, device, cache_options(60, 200));
    const auto above = [&] {
        std::size_t count = 0;
        const EmitterSet& set = cache.picture().emitters();
        for (const Emitter& one : set.emitters)
            count += one.kind == EMITTER_DIRECTIONAL && one.axis.y < 0.0f;
        return count;
    };
    EXPECT_LT(above(), 12u);
    const auto first = sampled(cache, scene.cameras[0], 1);
    EXPECT_GT(above(), 14u);
    EXPECT_EQ(sampled(cache, scene.cameras[0], 1), first);
    Camera aside = scene.cameras[0];
    aside.position.x += 0.4;
    EXPECT_NE(sampled(cache, aside, 3), first);
    EXPECT_EQ(sampled(cache, scene.cameras[0], 1), first);
}

// A sun lies where it is found in the first sample, whatever later ones of a picture before drew.
TEST(BrightSky, OfASunIsTheSameAgain) {
    Scene scene = posts();
    scene.environment = test::picture_sky(64, 32, [](int row, int column) {
        return row == 5 && column == 37 ? 900.0f : row < 16 ? 0.7f : 0.0f;
    });
    const DeviceScene device = test::on_device(scene);
    IrradianceCache cache(test::programs(), test::device().queue, device, cache_options(60, 100));
    ASSERT_EQ(cache.picture().emitters().directions, 1u);
    const auto first = sampled(cache, scene.cameras[0], 1);
    EXPECT_NE(sampled(cache, scene.cameras[0], 3), first);
    EXPECT_EQ(sampled(cache, scene.cameras[0], 1), first);
    sampled(cache, scene.cameras[0], 2);
    cache.lights_changed();
    cache.render(scene.cameras[0]).wait();
    EXPECT_EQ(test::vectors(test::device().queue, cache.picture().radiance(),
                            cache.picture().stride(), first.size()),
              first);
}

// Skies of few texels go round as others do.
TEST(BrightSky, OfFewTexelsIsWeighed) {
    for (const int width : {1, 2, 4, 5}) {
        Scene scene = posts();
        scene.environment =
            test::picture_sky(width, 2, [](int row, int) { return row ? 0.2f : 2.0f; });
        const DeviceScene device = test::on_device(scene);
        IrradianceCache cache(test::programs(), test::device().queue, device,
                              cache_options(60, 100));
        const test::Apart found = test::apart(sampled(cache, scene.cameras[0], 8), truth_of(scene));
        EXPECT_LT(found.error, 0.1) << width;
    }
}

// Of a lit strip of the sky between walls small hemicubes see more from one record and less from
// the next. Many directions know, and correct the light of the records.
TEST(BrightSky, IsKnownBetterByDirectionsThanByHemicubes) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_quad(scene, {glm::dvec3(-2, 0, 2), {2, 0, 2}, {2, 0, -2}, {-2, 0, -2}});
    for (const double x : {-0.75, 0.75})
        test::add_box(scene, {x - 0.05, 0, -2}, {x + 0.05, 2.5, 2}, 1);
    scene.environment = test::picture_sky(64, 32, [](int row, int column) {
        return row < 3 && column % 8 < 2 ? 9.0f : row < 16 ? 0.3f : 0.0f;
    });
    scene.cameras = {test::camera_at({0.3, 1.2, 3.2}, {0, 0.4, 0}, 0.8f)};
    const DeviceScene device = test::on_device(scene);
    IrradianceCacheOptions options = cache_options(60, 100);
    options.face = 8;
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    const test::Apart found = test::apart(sampled(cache, scene.cameras[0], 96), truth_of(scene));
    EXPECT_LT(found.high, 0.045);  // 0.067 as hemicubes have it
}

}  // namespace
}  // namespace clgi
