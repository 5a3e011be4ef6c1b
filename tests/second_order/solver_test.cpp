// Whole frames against closed forms, and what a frame promises about negative VPLs and shadows.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <numbers>

#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Frame;

using std::numbers::pi;
constexpr double degree = pi / 180.0;

SecondOrderOptions options_for(int width, int height, int lights, int negative,
                               const BuildOptions& build = {}) {
    SecondOrderOptions options;
    options.build = build;
    options.width = width;
    options.height = height;
    options.emitters.vpls = lights;
    options.negative_vpls = negative;
    return options;
}

CLGI_IN_ALL_MODES(SecondOrder);
CLGI_IN_ALL_MODES(NegativeLights);
CLGI_IN_ALL_MODES(Shadow);
CLGI_IN_ALL_MODES(DirectLight);

TEST_P(SecondOrder, LightsASphereEvenly) {
    FurnaceOptions furnace_options;
    furnace_options.subdivisions = 5;
    const Scene scene = furnace(furnace_options);
    SecondOrderOptions options = options_for(48, 40, 300, 0, GetParam());
    options.footprint = 0.0f;  // the closed form is that of the pure kernel
    options.direct = false;
    for (const int step : {1, 2, 4}) {
        options.low_resolution_step = step;
        const Frame frame =
            test::render(scene, test::camera_at({0, 0, 0}, {0.1, 1, 0.2}, 1.4f), options);
        // rho/pi times rho Phi/(4 pi R^2); 0.5 %: facets for the sphere. Half storage rounds
        // normals and irradiance to 11 bits: a cosine of each VPL and the sum.
        const double wanted = 0.5 / pi * 0.0334936491;
        const double close = GetParam().storage == Storage::half ? 0.005 + 2.0 / 2048.0 : 0.005;
        for (std::size_t p = 0; p < frame.pixels; ++p)
            EXPECT_NEAR(frame.radiance[p].x, wanted, close * wanted) << p;
    }
}

TEST(SecondOrder, KeepsItsIndirectLightsWhenTheCameraMoves) {
    for (const LightSource lamp : {LightSource::spot, LightSource::area}) {
        const Scene scene = cornell({.light = lamp});
        const SecondOrderOptions options = options_for(40, 30, 200, 20);
        const Frame here = test::render(scene, scene.cameras[0], options);
        const Frame there =
            test::render(scene, test::camera_at({0.1, 0.4, -0.5}, {0.4, 0.2, 0.3}), options);
        EXPECT_TRUE(test::same_bits(here.lights, there.lights));
        EXPECT_FALSE(here.radiance == there.radiance);
    }
}

TEST_P(NegativeLights, AreNoneInAnEmptyConvexBox) {
    Scene room = test::plain_scene();
    test::add_box(room, {-1, -1, -1.5}, {1, 1, 1.5}, -1);
    room.lights = {test::spot_light({0.2, 0.9, 0.3}, {0.1, -1, 0.2}, 40 * degree)};
    const Camera camera = test::camera_at({0, 0, 1.3}, {0.1, -0.1, -1}, 1.2f);
    for (const int step : {1, 2, 4}) {
        SecondOrderOptions options = options_for(61, 43, 150, 100, GetParam());
        options.low_resolution_step = step;
        const Frame with = test::render(room, camera, options);
        options.negative_vpls = 0;
        const Frame without = test::render(room, camera, options);
        for (const Vpl& light : with.negative) EXPECT_EQ(light.flux, glm::vec4(0.0f));
        EXPECT_TRUE(test::same_bits(with.irradiance, without.irradiance));
        EXPECT_TRUE(with.radiance == without.radiance);
    }
}

// A table in the room: what is taken away is never more than was there, nor less than nothing.
TEST_P(NegativeLights, OnlyTakeAwayAndNeverTooMuch) {
    Scene room = test::plain_scene();
    test::add_box(room, glm::dvec3(-1), glm::dvec3(1), -1);
    test::add_box(room, {-0.5, -0.4, -0.5}, {0.5, -0.3, 0.5}, 1);
    room.lights = {test::spot_light({0.2, 0.9, 0.3}, {-0.3, -1, -0.3}, 30 * degree)};
    SecondOrderOptions options = options_for(64, 48, 150, 300, GetParam());
    options.low_resolution_step = 1;
    options.direct = false;
    const Camera camera = test::camera_at({0, 0.1, 0.95}, {0, -0.5, -1}, 1.2f);
    const Frame with = test::render(room, camera, options);
    options.negative_vpls = 0;
    const Frame without = test::render(room, camera, options);
    std::size_t darker = 0;
    for (std::size_t p = 0; p < with.pixels; ++p)
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(with.radiance[p][c], 0.0f);
            EXPECT_LE(with.radiance[p][c], without.radiance[p][c]);
            darker += with.radiance[p][c] < without.radiance[p][c];
        }
    EXPECT_GT(darker, with.pixels / 10);
    for (const Vpl& light : with.negative) {
        EXPECT_TRUE(std::isfinite(glm::dot(light.position, light.flux)));
        EXPECT_GE(light.flux.x, 0.0f);
    }
}

// The angle that the light comes in at, the plane's size: everything in the cone is lit in full.
TEST_P(Shadow, DoesNotDarkenAPlaneByItself) {
    for (const double metres : {1e-3, 1.0, 1e3})
        for (const double slant : {0.0, 30.0, 60.0, 75.0, 85.0, 88.0, 89.0}) {
            if (metres != 1.0 && slant != 60.0 && slant != 89.0) continue;  // size changes little
            Scene world = test::plain_scene();
            test::add_floor(world, metres);
            const glm::dvec3 lamp =
                0.5 * metres * glm::dvec3(std::sin(slant * degree), std::cos(slant * degree), 0.1);
            const double angle = std::min(20.0, 0.5 * (90.0 - slant)) * degree;
            world.lights = {
                test::spot_light(lamp, -lamp, angle, static_cast<float>(metres * metres))};
            Camera camera = test::camera_at({0, metres, 0}, {0, 0, 0});
            camera.kind = Camera::Kind::orthographic;
            camera.half_height = static_cast<float>(0.3 * metres);
            SecondOrderOptions options = options_for(48, 48, 0, 0, GetParam());
            const Frame frame = test::render(world, camera, options);
            std::size_t dark = 0, lit = 0;
            for (std::size_t p = 0; p < frame.pixels; ++p) {
                const glm::dvec3 at = frame.world(p), ray = lamp - at;
                const double cosine = glm::dot(glm::normalize(lamp), glm::normalize(ray));
                if (cosine < std::cos(0.97 * angle)) continue;
                const double square = glm::dot(ray, ray);
                const double wanted =
                    0.5 / pi * metres * metres / square * ray.y / std::sqrt(square);
                ++lit;
                // 1e-3: float positions at grazing incidence; a shadowed texel is a quarter or
                // more.
                dark += std::abs(frame.radiance[p].x / wanted - 1.0) >
                        1e-3 + 1e-5 / std::cos(slant * degree);
            }
            EXPECT_GT(lit, 20u) << slant;
            EXPECT_EQ(dark, 0u) << slant << " degrees, " << metres << " m, of " << lit;
        }
}

TEST_P(Shadow, OfAThinWallDoesNotLeak) {
    for (const double thickness : {0.1, 0.01, 0.001}) {
        Scene world = test::plain_scene();
        test::add_floor(world, 1.0);
        test::add_box(world, {0, 0, -1}, {thickness, 0.6, 1}, 1);
        world.lights = {test::point_light({-0.5, 0.3, 0})};
        Camera camera = test::camera_at({0.5, 1.5, 0}, {0.5, 0, 0});
        camera.kind = Camera::Kind::orthographic;
        camera.half_height = 0.4f;
        const Frame frame = test::render(world, camera, options_for(64, 64, 0, 0, GetParam()));
        std::size_t checked = 0;
        for (std::size_t p = 0; p < frame.pixels; ++p) {
            // Behind the wall, two texels of the cube face and the wall itself away from its foot.
            if (frame.world(p).x < thickness + 0.02 || frame.world(p).y > 1e-3) continue;
            ++checked;
            EXPECT_EQ(frame.radiance[p], glm::vec3(0.0f)) << thickness << ": " << frame.world(p).x;
        }
        EXPECT_GT(checked, 2000u);
    }
}

// Direct light alone, straight down on white paper: E = I / d^2, L = rho E / pi.
TEST_P(DirectLight, IsIntensityOverDistanceSquared) {
    Scene world = test::plain_scene();
    test::add_floor(world, 3.0);
    Camera camera = test::camera_at({0, 1, 0}, {0, 0, 0});
    camera.kind = Camera::Kind::orthographic;
    camera.half_height = 1e-3f;
    world.lights = {test::spot_light({0, 2, 0}, {0, -1, 0}, 0.5, 3.0f)};
    EXPECT_NEAR(test::render(world, camera, options_for(1, 1, 0, 0, GetParam())).radiance[0].x,
                0.75 * 0.5 / pi, 1e-6);
    world.lights = {test::point_light({0, 2, 0}, 3.0f)};
    EXPECT_NEAR(test::render(world, camera, options_for(1, 1, 0, 0, GetParam())).radiance[0].x,
                0.75 * 0.5 / pi, 1e-6);
    world.lights = {test::directional_light({0, -1, 0}, 3.0f)};
    EXPECT_NEAR(test::render(world, camera, options_for(1, 1, 0, 0, GetParam())).radiance[0].x,
                3.0 * 0.5 / pi, 1e-6);
}

TEST(SecondOrder, RefusesOptionsOutOfRange) {
    const DeviceScene scene = test::on_device(cornell());
    for (const auto& break_one : std::initializer_list<void (*)(SecondOrderOptions&)>{
             [](SecondOrderOptions& o) { o.width = 0; },
             [](SecondOrderOptions& o) { o.height = 16385; },
             [](SecondOrderOptions& o) { o.negative_vpls = -1; },
             [](SecondOrderOptions& o) { o.footprint = -1.0f; },
             [](SecondOrderOptions& o) { o.discontinuity_threshold = std::nanf(""); },
             [](SecondOrderOptions& o) { o.emitters.vpls = -1; }}) {
        SecondOrderOptions options;
        break_one(options);
        EXPECT_THROW(SecondOrderSolver(test::device().queue, scene, options), Error);
    }
}

}  // namespace
}  // namespace clgi
