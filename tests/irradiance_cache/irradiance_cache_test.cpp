// Pictures of an irradiance cache against closed forms and the path tracer.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/irradiance_cache.hpp>
#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "apart.hpp"
#include "cache_pictures.hpp"
#include "math_modes.hpp"
#include "refusals.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// A sky of one colour above the horizon, black below.
Environment upper_half(const glm::vec3& radiance) {
    Environment out;
    out.width = 8;
    out.height = 64;
    out.texels.assign(512, glm::vec3(0.0f));
    for (std::size_t i = 0; i < 256; ++i) out.texels[i] = radiance;
    return out;
}

constexpr glm::vec3 lamp_radiance(3.0f, 2.0f, 1.0f);

// A square metre of lamp, a metre above a small floor that the camera looks at.
Scene below_a_lamp(const glm::vec3& albedo) {
    Scene scene = test::plain_scene(albedo);
    test::add_floor(scene, 0.1);
    Material lamp;
    lamp.base_color = glm::vec4(0, 0, 0, 1);
    lamp.emission = lamp_radiance;
    const std::uint32_t glows = test::add_material(scene, lamp);
    test::add_quad(
        scene, {glm::dvec3(-0.5, 1, -0.5), {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}}, glows);
    scene.cameras = {test::camera_at({0, 0.8, 0.001}, {0, 0, 0}, 0.1f)};
    return scene;
}

CLGI_IN_BOTH_MATHS(IrradianceCachePictures);

// A plane that is tilted by t sees (1 + cos t) / 2 of the sky.
TEST_P(IrradianceCachePictures, HaveTheSkyOfATiltedPlane) {
    for (const double tilt : {0.0, 0.7, 1.3}) {
        Scene scene = test::plain_scene({0.8f, 0.5f, 0.2f});
        const glm::dvec3 up(std::sin(tilt), std::cos(tilt), 0.0), across(up.y, -up.x, 0.0);
        const glm::dvec3 deep(0, 0, 1);
        test::add_quad(scene, {2.0 * (-across + deep), 2.0 * (across + deep), 2.0 * (across - deep),
                               2.0 * (-across - deep)});
        scene.environment = upper_half({1.0f, 2.0f, 4.0f});
        scene.cameras = {test::camera_at(2.0 * up + 0.1 * deep, {0, 0, 0}, 0.6f)};
        const CachePicture found = pictured(scene, cache_options());
        EXPECT_EQ(found.status.non_finite, 0u);
        EXPECT_EQ(found.status.met, 0u);
        for (int c = 0; c < 3; ++c) {
            const double wanted =
                scene.materials[0].base_color[c] * (1 << c) * (1.0 + std::cos(tilt)) / 2.0;
            for (const glm::vec3& value : found.radiance)
                ASSERT_NEAR(value[c], wanted, 0.03 * wanted) << tilt << " " << c;
            EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted, 0.01 * wanted) << tilt;
        }
    }
}

// How much records differ does not depend on how bright the lamps are, and falls with their number.
TEST_P(IrradianceCachePictures, AreInDoubtWhereRecordsAreFew) {
    Scene scene = cornell();
    const auto doubt = [&](int seen, float power) {
        for (Material& material : scene.materials) material.emission *= power;
        const DeviceScene device = test::on_device(scene);
        IrradianceCacheOptions options = cache_options(seen, 3 * seen);
        options.refined = 0;
        options.face = 16;
        IrradianceCache cache(test::programs(), test::device().queue, device, options);
        cache.render(scene.cameras.at(0)).wait();
        return cache.doubt();
    };
    const double few = doubt(20, 1.0f);
    EXPECT_NEAR(doubt(20, 1000.0f), few, 1e-3 * few);
    EXPECT_LT(doubt(320, 1e-3f), 0.6 * few);
    EXPECT_GT(few, 0.02);
    EXPECT_LT(few, 0.5);
    EXPECT_EQ(doubt(20, 0.0f), 0.0);
}

// In a closed sphere of albedo p light that arrives as E is E / (1 - p) with all reflections; with
// n of them the sum of p^k up to n.
TEST_P(IrradianceCachePictures, HaveAllReflectionsOfASphere) {
    Scene scene = furnace({.light = LightSource::point, .subdivisions = 3});
    const glm::vec3 albedo(0.6f, 0.3f, 0.75f);
    scene.materials[0].base_color = glm::vec4(albedo, 1.0f);
    scene.lights[0].intensity = {1.0f, 2.0f, 5.0f};
    scene.cameras = {test::camera_at({0, 0, 0.2}, {0.3, 0.2, -1}, 1.2f)};
    for (const int bounces : {0, 1, 3}) {
        IrradianceCacheOptions options = cache_options();
        options.bounces = bounces;
        const CachePicture found = pictured(scene, options);
        EXPECT_TRUE(found.status.converged);
        for (int c = 0; c < 3; ++c) {
            const double p = albedo[c];
            const double gain =
                bounces == 0 ? 1.0 / (1.0 - p) : (1.0 - std::pow(p, bounces + 1)) / (1.0 - p);
            const double wanted = p / pi * scene.lights[0].intensity[c] * gain;
            // Facets are nearer to the light than the sphere.
            EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted, 0.03 * wanted)
                << bounces << " " << c;
        }
    }
}

// Below the middle of a square lamp: E = 4 L (a / A atan(b / A) + b / B atan(a / B)) / 2.
TEST_P(IrradianceCachePictures, HaveALampByHemicubes) {
    Scene scene = below_a_lamp({0.5f, 0.5f, 0.5f});
    IrradianceCacheOptions options = cache_options(20, 0);
    options.emission = true;
    options.face = 64;
    const CachePicture found = pictured(scene, options);
    const double side = std::sqrt(1.25), half = 0.5;
    const double irradiance = 4.0 * (half / side * std::atan(half / side));
    for (int c = 0; c < 3; ++c) {
        const double wanted = 0.5 / pi * irradiance * lamp_radiance[c];
        EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted, 0.02 * wanted) << c;
    }
    // By points with shadow maps it is direct light, and as bright.
    options.emission = false;
    options.picture.emitters.area_samples = 256;
    const CachePicture direct = pictured(scene, options);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean_radiance(direct.radiance)[c], mean_radiance(found.radiance)[c],
                    0.02 * mean_radiance(found.radiance)[c]);
}

// What a lamp sends by way of coloured walls: by sample points that take turns in hemicubes, and by
// hemicubes alone, which know no samples. A spotlight beside it lights every pixel.
TEST_P(IrradianceCachePictures, HaveLampsWhoseSamplesTakeTurns) {
    Scene scene = test::plain_scene({0.7f, 0.4f, 0.2f});
    test::add_box(scene, {-1, 0, -1}, {1, 1.4, 1}, -1);
    Material lamp;
    lamp.base_color = glm::vec4(0, 0, 0, 1);
    lamp.emission = {3.0f, 6.0f, 12.0f};
    const std::uint32_t glows = test::add_material(scene, lamp);
    test::add_quad(
        scene, {glm::dvec3(-0.5, 1.3, -0.4), {0.3, 1.3, -0.4}, {0.3, 1.2, 0.5}, {-0.5, 1.2, 0.5}},
        glows);
    scene.cameras = {test::camera_at({-0.9, 0.5, 0.8}, {0.3, 0.1, -0.4}, 1.0f)};
    IrradianceCacheOptions options = cache_options();
    options.picture.direct = false;
    // Emission by hemicubes is no direct light; so the lamp's own light is taken away.
    options.emission = true;
    options.face = 48;
    const glm::dvec3 by_hemicubes = mean_radiance(pictured(scene, options).radiance);
    SecondOrderOptions direct;
    direct.width = cache_width;
    direct.height = cache_height;
    direct.indirect = false;
    direct.emitters.area_samples = 512;
    const glm::dvec3 alone = mean_radiance(test::render(scene, scene.cameras[0], direct).radiance);
    options.emission = false;
    for (const int samples : {4, 70, 256}) {
        options.picture.emitters.area_samples = samples;
        const glm::dvec3 found = mean_radiance(pictured(scene, options).radiance);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], by_hemicubes[c] - alone[c], 0.04 * by_hemicubes[c])
                << samples << " " << c;
    }
    // A lamp of another kind counts whole beside 256 samples that take turns.
    scene.lights = {test::point_light({0.4, 0.9, 0.2}, 0.5f)};
    const glm::dvec3 both = mean_radiance(pictured(scene, options).radiance);
    scene.materials[glows].emission = glm::vec3(0.0f);
    const glm::dvec3 point = mean_radiance(pictured(scene, options).radiance);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(both[c] - point[c], by_hemicubes[c] - alone[c], 0.04 * by_hemicubes[c]) << c;
}

// A lamp that lies outside of the focus has no points with shadow maps, and lights by hemicubes.
TEST_P(IrradianceCachePictures, HaveLampsBeyondTheFocusByHemicubes) {
    Scene scene = below_a_lamp({0.5f, 0.6f, 0.7f});
    IrradianceCacheOptions options = cache_options(20, 0);
    options.picture.emitters.area_samples = 256;
    options.face = 64;
    const double side = std::sqrt(1.25), half = 0.5;
    const double irradiance = 4.0 * (half / side * std::atan(half / side));
    for (const double radius : {0.3, 1.1}) {  // the lamp is outside, and inside
        scene.focus = Focus{glm::dvec3(0.0, 0.05, 0.0), radius};
        options.picture.direct = true;
        const glm::dvec3 all = mean_radiance(pictured(scene, options).radiance);
        options.picture.direct = false;
        const glm::dvec3 gathered = mean_radiance(pictured(scene, options).radiance);
        for (int c = 0; c < 3; ++c) {
            const double wanted =
                scene.materials[0].base_color[c] / pi * irradiance * lamp_radiance[c];
            EXPECT_NEAR(all[c], wanted, 0.03 * wanted) << radius << " " << c;
            EXPECT_NEAR(gathered[c], radius < 1.0 ? wanted : 0.0, 0.03 * wanted) << radius;
        }
    }
}

// Where the light changes more records are made, and the picture errs less: below a small block in
// a room that a spotlight lights by way of one wall.
TEST_P(IrradianceCachePictures, ErrLessWithRefinedRecords) {
    Scene scene = test::plain_scene({0.7f, 0.6f, 0.5f});
    test::add_box(scene, {0, 0, 0}, {4, 3, 5}, -1);
    test::add_box(scene, {1.5, 0.15, 1.5}, {2.5, 0.6, 2.5}, 1);
    scene.lights = {test::spot_light({2, 2.5, 4}, {0, -0.1f, 1}, 1.4f, 60.0f)};
    scene.cameras = {test::camera_at({0.4, 1.6, 4.6}, {2.2, 0.3, 1.5}, 0.9f)};
    reference::Options truth;
    truth.width = cache_width;
    truth.height = cache_height;
    truth.samples = 512;
    truth.effects.emission = truth.effects.direct = false;
    static const test::Twice twice = test::render_twice(scene, scene.cameras[0], truth);
    IrradianceCacheOptions options = cache_options(30, 300);
    options.picture.direct = false;
    const auto squared_error = [&](int refined) {
        options.refined = refined;
        const CachePicture found = pictured(scene, options);
        EXPECT_LE(found.status.refined, static_cast<std::size_t>(refined));
        EXPECT_EQ(found.status.refined > 0, refined > 0);
        return std::pow(test::apart(found.radiance, twice).error, 2);
    };
    const double before = squared_error(0), after = squared_error(300);
    EXPECT_GT(after, 0.0);
    EXPECT_LT(after, 0.5 * before) << before;
}

// A block below a sky and a lamp: groups of any size find the light of single work-items.
TEST(IrradianceCache, IsTheSameInGroups) {
    Scene scene = below_a_lamp({0.5f, 0.6f, 0.7f});
    scene.materials[0].metallic = 0.5f;  // with lobes
    scene.materials[0].roughness = 0.4f;
    scene.environment = upper_half({0.2f, 0.5f, 1.0f});
    test::add_box(scene, {-0.05, 0, -0.05}, {0.05, 0.3, 0.05}, 1);
    scene.cameras = {test::camera_at({0.3, 0.4, 0.2}, {0, 0.1, 0}, 0.5f)};
    IrradianceCacheOptions options = cache_options(20, 20);
    options.refined = 5;
    options.picture.build.packet_width = 1;
    options.picture.build.form = Form::packets;
    const std::vector<glm::vec3> alone = pictured(scene, options).radiance;
    EXPECT_GT(mean_radiance(alone).x, 0.0);
    options.picture.build.form = Form::groups;
    for (const std::size_t lanes : {0, 7}) {
        options.picture.build.local_size = lanes;
        EXPECT_TRUE(test::same_bits(pictured(scene, options).radiance, alone)) << lanes;
    }
}

// A coloured room with a window, looked at away from it, in a plain that is a thousand times
// larger.
TEST_P(IrradianceCachePictures, OfARoomWithAWindowAreThePathTracers) {
    Scene scene = test::plain_scene({0.7f, 0.6f, 0.5f});
    const auto paint = [&](const glm::vec3& albedo) {
        Material material;
        material.base_color = glm::vec4(albedo, 1.0f);
        return test::add_material(scene, material);
    };
    const std::uint32_t red = paint({0.75f, 0.3f, 0.2f}), green = paint({0.25f, 0.6f, 0.3f});
    test::add_box(scene, {-0.2, -0.2, -0.2}, {4.2, 0, 5.2}, 1);
    test::add_box(scene, {-0.2, 3, -0.2}, {4.2, 3.2, 5.2}, 1);
    test::add_box(scene, {-0.2, 0, -0.2}, {4.2, 3, 0}, 1);
    test::add_box(scene, {-0.2, 0, 0}, {0, 3, 5}, 1, red);
    test::add_box(scene, {4, 0, 0}, {4.2, 3, 5}, 1, green);
    test::add_box(scene, {-0.2, 0, 5}, {1, 3, 5.2}, 1);
    test::add_box(scene, {3, 0, 5}, {4.2, 3, 5.2}, 1);
    test::add_box(scene, {1, 0, 5}, {3, 0.6, 5.2}, 1);
    test::add_box(scene, {1, 2.6, 5}, {3, 3, 5.2}, 1);
    test::add_box(scene, {0.6, 0, 1.0}, {1.6, 0.9, 2.0}, 1, green);
    test::add_floor(scene, 4000.0, -0.3);
    scene.environment = upper_half({1.0f, 1.5f, 2.0f});
    scene.cameras = {test::camera_at({2.2, 1.6, 4.6}, {1.8, 1.2, 0}, 1.0f)};
    const CachePicture found = pictured(scene, cache_options(300, 400));
    EXPECT_TRUE(found.status.converged);
    reference::Options options;
    options.width = cache_width;
    options.height = cache_height;
    options.samples = 256;
    const reference::Picture truth = reference::PathTracer(scene).render(scene.cameras[0], options);
    const glm::dvec3 got = mean_radiance(found.radiance), wanted = mean_radiance(truth.radiance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / wanted[c], 1.0, 0.06) << c;
    // In blocks, which have little of the path tracer's noise.
    double square = 0.0;
    int blocks = 0;
    for (int y = 0; y < cache_height; y += 6)
        for (int x = 0; x < cache_width; x += 6, ++blocks) {
            double apart = 0.0;
            for (int k = 0; k < 36; ++k) {
                const auto pixel = static_cast<std::size_t>((y + k / 6) * cache_width + x + k % 6);
                apart += found.radiance[pixel].y - truth.radiance[pixel].y;
            }
            square += apart * apart / (36.0 * 36.0);
        }
    EXPECT_LT(std::sqrt(square / blocks), 0.12 * wanted.y);
}

TEST(IrradianceCache, IsTheSameTwiceAndFollowsItsLights) {
    Scene scene = furnace({.light = LightSource::point, .albedo = 0.5f, .subdivisions = 2});
    scene.cameras = {test::camera_at({0, 0, 0.2}, {0.3, 0.2, -1}, 1.2f)};
    DeviceScene device = test::on_device(scene);
    IrradianceCache cache(test::programs(), test::device().queue, device, cache_options());
    const auto picture = [&] {
        cache.render(scene.cameras[0]).wait();
        return test::vectors(test::device().queue, cache.picture().radiance(),
                             cache.picture().stride(), std::size_t{cache_width} * cache_height);
    };
    const auto first = picture(), second = picture();
    EXPECT_TRUE(first == second);
    Light light = scene.lights[0];
    light.intensity *= glm::vec3(0.5f, 1.0f, 2.0f);
    device.set_light(0, light);
    cache.lights_changed();
    const glm::dvec3 after = mean_radiance(picture()), before = mean_radiance(first);
    EXPECT_NEAR(after.x / before.x, 0.5, 1e-4);
    EXPECT_NEAR(after.y / before.y, 1.0, 1e-4);
    EXPECT_NEAR(after.z / before.z, 2.0, 1e-3);
}

// Records are shadowed also where the picture has no direct light of its own.
TEST(IrradianceCache, LeavesOutDirectLightAlone) {
    Scene scene = test::plain_scene({0.7f, 0.4f, 0.6f});
    test::add_box(scene, {-1, 0, -1}, {1, 1.5, 1}, -1);
    test::add_box(scene, {-0.2, 0.2, -0.8}, {0.8, 0.5, 0.8}, 1);
    scene.lights = {test::point_light({0.3, 1.3, 0.1}, 8.0f)};
    scene.cameras = {test::camera_at({-0.9, 0.3, 0.8}, {0.2, 0.2, -0.4}, 1.2f)};
    const auto all = pictured(scene, cache_options());
    IrradianceCacheOptions options = cache_options();
    options.picture.direct = false;
    const auto indirect = pictured(scene, options);
    SecondOrderOptions direct;
    direct.width = cache_width;
    direct.height = cache_height;
    direct.indirect = false;
    const auto alone = test::render(scene, scene.cameras[0], direct).radiance;
    for (std::size_t i = 0; i < alone.size(); ++i)
        for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(indirect.radiance[i][c] + alone[i][c], all.radiance[i][c],
                        1e-3 * all.radiance[i][c] + 1e-5);
}

// Points of lamps, of which there are many, have smaller shadow maps than lamps that are points,
// and hemicubes of more pixels look at fewer of them in each.
TEST(IrradianceCache, LooksAtPointsOfLampsCoarselyAndInTurns) {
    const DeviceScene scene = test::on_device(cornell());
    IrradianceCacheOptions options = cache_options(12, 100);
    options.picture.emitters.face_size = 33;
    const IrradianceCache cache(test::programs(), test::device().queue, scene, options);
    EXPECT_EQ(cache.options().picture.emitters.area_size, 17);
    EXPECT_EQ(cache.options().picture.emitters.face_size, 33);
    for (const auto& [face, at_once] :
         {std::pair(8, 4), {16, 4}, {24, 2}, {32, 2}, {64, 1}, {256, 1}}) {
        options.face = face;
        EXPECT_EQ(options.samples_at_once(), at_once) << face;
    }
}

TEST(IrradianceCache, ShowsNothingWhereNothingIs) {
    Scene scene;
    scene.cameras = {test::camera_at({0, 0, 1}, {0, 0, 0}, 1.0f)};
    scene.environment = Environment{.factor = {1.0f, 2.0f, 3.0f}};
    const CachePicture found = pictured(scene, cache_options());
    EXPECT_EQ(found.status.seen, 0u);
    for (const glm::vec3& value : found.radiance) ASSERT_EQ(value, glm::vec3(1.0f, 2.0f, 3.0f));
}

TEST(IrradianceCache, SaysWhatItCannotDo) {
    const DeviceScene device = test::on_device(furnace({.subdivisions = 1}));
    const auto refused = [&](auto change) {
        IrradianceCacheOptions options = cache_options();
        change(options);
        return test::refusal<Error>(
            [&] { IrradianceCache(test::programs(), test::device().queue, device, options); });
    };
    IrradianceCache cache(test::programs(), test::device().queue, device, cache_options());
    EXPECT_NE(test::refusal<Error>([&] { cache.render_again(Camera()); }).find("no picture yet"),
              std::string::npos);
    using Options = IrradianceCacheOptions;
    EXPECT_NE(refused([](Options& o) { o.seen = 0; }).find("seen is 0"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.met = 20001; }).find("met"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.face = 36; }).find("multiple of 8"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.face = 264; }).find("face"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.bounces = -1; }).find("bounces"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.picture.build.storage = Storage::half; }).find("storage"),
              std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.picture.width = 0; }).find("width"), std::string::npos);
}

}  // namespace
}  // namespace clgi
