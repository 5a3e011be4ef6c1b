// Environments on the device: what is seen behind everything, and the light that comes of it.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

using test::Frame;

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(Background);
CLGI_IN_ALL_MODES(NoBackground);
CLGI_IN_BOTH_MATHS(EnvironmentLights);

SecondOrderOptions options_for(int width, int height,
                               const test::Build& build = test::usual_build()) {
    SecondOrderOptions options;
    options.build = build;
    options.width = width;
    options.height = height;
    options.emitters.shadow_size = 256;
    return options;
}

// Every texel has a value of its own.
Environment numbered_sky() {
    Environment sky = test::picture_sky(
        37, 18, [](int row, int column) { return static_cast<float>(1 + 37 * row + column); });
    sky.factor = {1.0f, 0.5f, 2.0f};
    sky.rotation = 0.7f;
    return sky;
}

// A floor and a box on it; four metres across.
Scene floor_and_box(const Environment& sky) {
    Scene scene = test::plain_scene(glm::vec3(0.6f));
    test::add_floor(scene, 2.0);
    test::add_box(scene, {-0.5, 0, -0.4}, {0.3, 0.8, 0.4}, 1);
    scene.environment = sky;
    return scene;
}

TEST_P(Background, IsTheEnvironmentThatTheReferenceSees) {
    const Scene scene = floor_and_box(numbered_sky());
    const reference::PathTracer tracer(scene);
    Camera parallel = test::camera_at({3, 1, 4}, {0, 0.5, 0});
    parallel.kind = Camera::Kind::orthographic;
    parallel.half_height = 5.0f;
    for (Camera camera : {test::camera_at({1, 1.5, 4}, {0, 0.3, 0}, 1.6f),
                          test::camera_at({0, 1, 0.9}, {0.1, 5, 0}, 2.5f), parallel}) {
        camera.footprint = 1e-9f;  // a point
        reference::Options options;
        options.effects = reference::parse_effects("emission");
        options.samples = 1;
        options.width = 67;
        options.height = 41;
        const reference::Picture wanted = tracer.render(camera, options);
        const Frame frame = test::render(scene, camera, options_for(67, 41, GetParam()));
        std::size_t sky = 0, other = 0;
        for (std::size_t p = 0; p < frame.pixels; ++p) {
            if (wanted.radiance[p].x == 0.0f) continue;
            ++sky;
            // Rounding may choose the neighbour where a ray meets the edge of a texel.
            other += frame.radiance[p] != wanted.radiance[p];
        }
        EXPECT_GT(sky, 500u);
        EXPECT_LE(other, sky / 100);
        EXPECT_EQ(frame.status.non_finite, 0u);
    }
}

// Of a sky whose texels are as large as pixels: sixteen points find the share of a texel in a pixel
// to an eighth or so, in either direction.
TEST_P(Background, IsTheMeanOverAPixel) {
    Scene scene;
    scene.environment = test::picture_sky(200, 100, [](int row, int column) {
        return static_cast<float>(1 + (37 * row + 11 * column) % 7);
    });
    Camera camera = test::camera_at({0, 0, 0}, {0.3, 0.2, -1}, 1.2f);
    reference::Options options;
    options.effects = reference::parse_effects("emission");
    options.samples = 400;
    options.filter = reference::Filter::box;
    options.width = 67;
    options.height = 41;
    const reference::Picture wanted = reference::PathTracer(scene).render(camera, options);
    const auto error = [&](float footprint) {
        camera.footprint = footprint;
        const Frame frame = test::render(scene, camera, options_for(67, 41, GetParam()));
        double square = 0.0, all = 0.0;
        for (std::size_t p = 0; p < frame.pixels; ++p) {
            const double of = double{wanted.radiance[p].y};
            square += std::pow(double{frame.radiance[p].y} - of, 2.0);
            all += of * of;
        }
        return std::sqrt(square / all);
    };
    EXPECT_LT(error(1.0f), 0.06);
    EXPECT_GT(error(1e-9f), 0.2);
}

TEST_P(Background, FillsAPictureOfNothing) {
    Scene scene;
    scene.environment = test::even_sky({1, 2, 3});
    for (const int lights : {0, 16}) {
        SecondOrderOptions options = options_for(19, 13, GetParam());
        options.emitters.environment_lights = lights;
        const Frame frame = test::render(scene, test::camera_at({0, 0, 0}, {0, 0, -1}), options);
        for (const glm::vec3& radiance : frame.radiance) EXPECT_EQ(radiance, glm::vec3(1, 2, 3));
    }
}

TEST(Background, IsTheSameAtEveryPacketWidth) {
    const Scene scene = floor_and_box(numbered_sky());
    const Camera camera = test::camera_at({1, 1.5, 4}, {0, 0.3, 0}, 1.6f);
    std::vector<glm::vec3> first;
    for (const int width : test::widths()) {
        SecondOrderOptions options = options_for(21, 15);
        options.indirect = false;
        options.build.packet_width = width;
        const Frame frame = test::render(scene, camera, options);
        if (first.empty()) first = frame.radiance;
        EXPECT_TRUE(frame.radiance == first) << width;
    }
}

TEST_P(NoBackground, CostsNothingWhereItIsNotWanted) {
    Scene scene = floor_and_box(test::even_sky(glm::vec3(1.0f)));
    const Camera camera = test::camera_at({1, 1.5, 4}, {0, 0.3, 0}, 1.6f);
    SecondOrderOptions options = options_for(21, 15);
    const auto drawn = [&] {
        const DeviceScene placed = test::on_device(scene);
        SecondOrderSolver solver(test::programs(), test::device().queue, placed, options);
        solver.render(camera).wait();
        const auto& events = solver.events();
        return std::count_if(events.begin(), events.end(), [](const PassEvent& pass) {
            return pass.name == "image.environment";
        });
    };
    EXPECT_EQ(drawn(), 1);
    options.direct = false;
    EXPECT_EQ(drawn(), 0);
    const Frame indirect = test::render(scene, camera, options);
    EXPECT_EQ(indirect.radiance[0], glm::vec3(0.0f));  // the sky is direct light
    options.direct = true;
    scene.environment.reset();
    scene.lights = {test::directional_light({0, -1, 0})};
    EXPECT_EQ(drawn(), 0);
}

// Rotation takes light and background along: the same as turning scene and camera back.
TEST_P(EnvironmentLights, TurnWithTheEnvironment) {
    const Environment sky = test::picture_sky(
        32, 16, [](int row, int column) { return row == 5 && column == 16 ? 500.0f : 1.0f; });
    const auto brightness = [&](const glm::dvec3& toward, double rotation) {
        Scene scene = test::plain_scene(glm::vec3(1.0f));
        // A wall that faces `toward`.
        const glm::dvec3 aside = glm::cross(glm::dvec3(0, 1, 0), toward);
        test::add_quad(scene,
                       {-aside, aside, aside + glm::dvec3(0, 1, 0), glm::dvec3(0, 1, 0) - aside});
        scene.environment = sky;
        scene.environment->rotation = static_cast<float>(rotation);
        SecondOrderOptions options = options_for(4, 4, GetParam());
        options.indirect = false;
        return test::render(scene, test::camera_at(3.0 * toward, {0, 0.5, 0}, 0.05f), options)
            .radiance[5]
            .x;
    };
    const float ahead = brightness({0, 0, -1}, 0.0), left = brightness({-1, 0, 0}, 0.0);
    EXPECT_GT(ahead, 2 * left);
    EXPECT_NEAR(brightness({-1, 0, 0}, 0.5 * pi), ahead, 1e-3f * ahead);
    EXPECT_NEAR(brightness({0, 0, -1}, -0.5 * pi), left, 1e-3f * left);
}

TEST_P(EnvironmentLights, BringAllOfTheLight) {
    const Scene scene = floor_and_box(test::even_sky({1, 2, 3}));
    const DeviceScene placed = test::on_device(scene);
    for (const int count : {1, 16, 50}) {
        EmitterOptions options;
        options.environment_lights = count;
        const EmitterSet set = make_emitters(placed, options);
        EXPECT_EQ(set.emitters.size(), static_cast<std::size_t>(count));
        glm::dvec3 lux(0.0);
        for (const Emitter& emitter : set.emitters) lux += glm::dvec3(emitter.intensity);
        lux *= placed.frame().exposure;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(lux[c], 4 * pi * (c + 1), 1e-6 * 4 * pi * (c + 1)) << count;
    }
}

// An unoccluded floor under a gradient: E = pi/2 + pi/3.
TEST_P(EnvironmentLights, LightAFloorNearlyAsTheSkyWould) {
    Scene scene = test::plain_scene(glm::vec3(0.6f));
    test::add_floor(scene, 2.0);
    scene.environment = test::gradient_sky();
    const double wanted = 0.6 / pi * (pi / 2 + pi / 3);
    for (const auto& [count, most] : {std::pair(16, 0.08), {256, 0.02}}) {
        SecondOrderOptions options = options_for(16, 12, GetParam());
        options.emitters.environment_lights = count;
        options.emitters.shadow_size = 64;
        options.indirect = false;
        const Frame frame =
            test::render(scene, test::camera_at({0, 3, 0.1}, {0, 0, 0}, 0.5f), options);
        for (const glm::vec3& radiance : frame.radiance)
            EXPECT_NEAR(radiance.x, wanted, most * wanted) << count;
    }
}

// Floor and box under a gradient sky: direct light and one bounce, shadows of both.
TEST(EnvironmentLights, ComeCloseToTheReference) {
    const Scene scene = floor_and_box(test::gradient_sky());
    const Camera camera = test::camera_at({2, 2, 3.5}, {0, 0.3, 0}, 0.8f);
    reference::Options truth;
    truth.effects = reference::parse_effects("emission,direct,one-bounce");
    truth.samples = 256;
    truth.width = 80;
    truth.height = 60;
    const reference::Picture wanted = reference::PathTracer(scene).render(camera, truth);
    for (const auto& [count, most] : {std::pair(16, 0.085), {64, 0.04}, {256, 0.033}}) {
        SecondOrderOptions options = options_for(80, 60);
        options.emitters.environment_lights = count;
        options.emitters.vpls = 2048;
        options.negative_vpls = 0;
        options.low_resolution_step = 1;
        const Frame frame = test::render(scene, camera, options);
        double square = 0.0, mean = 0.0, signed_sum = 0.0;
        std::size_t surface = 0;
        for (std::size_t p = 0; p < frame.pixels; ++p) {
            const double off = double{frame.radiance[p].x} - double{wanted.radiance[p].x};
            if (frame.position[p] == glm::vec3(0.0f)) continue;  // the sky itself is exact
            ++surface;
            square += off * off;
            signed_sum += off;
            mean += double{wanted.radiance[p].x};
        }
        const auto n = static_cast<double>(surface);
        const double error = std::sqrt(square / n) / (mean / n);
        RecordProperty("error_of_" + std::to_string(count), std::to_string(error));
        RecordProperty("mean_of_" + std::to_string(count), std::to_string(signed_sum / mean));
        EXPECT_LT(error, most) << count;
    }
}

}  // namespace
}  // namespace clgi
