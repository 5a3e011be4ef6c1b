// Scenes and frames with nothing in them: black where nothing shines, finite always, and no work
// where nothing can be lit.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>

#include "frames.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Frame;

Scene lit_floor() {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    scene.lights = {test::spot_light({0, 1, 0}, {0, -1, 0}, 0.5)};
    return scene;
}

const Camera above = test::camera_at({0, 2, 0.1}, {0, 0, 0});

Frame render(const Scene& scene, const BuildOptions& build, const Camera& camera = above,
             int lights = 20, int negative = 10) {
    SecondOrderOptions options;
    options.build = build;
    options.width = 19;
    options.height = 13;
    options.emitters.vpls = lights;
    options.negative_vpls = negative;
    return test::render(scene, camera, options);
}

void expect_black(const Frame& frame) {
    for (const glm::vec3& radiance : frame.radiance) EXPECT_EQ(radiance, glm::vec3(0.0f));
    EXPECT_EQ(frame.status.non_finite, 0u);
}

void expect_black_without_work(const Scene& scene, const BuildOptions& build) {
    const Frame frame = render(scene, build);
    expect_black(frame);
    EXPECT_EQ(frame.launches, 0u);
}

void expect_finite(const Frame& frame) {
    for (const glm::vec3& radiance : frame.radiance)
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(radiance[c]) && radiance[c] >= 0.0f);
    EXPECT_EQ(frame.status.non_finite, 0u);
}

CLGI_IN_ALL_MODES(Nothing);
CLGI_IN_ALL_MODES(Hardly);

TEST_P(Nothing, OfAScene) { expect_black_without_work(Scene(), GetParam()); }

TEST_P(Nothing, OfTriangles) {
    Scene scene = lit_floor();
    scene.triangles.clear();
    expect_black_without_work(scene, GetParam());
}

TEST_P(Nothing, OfLights) {
    Scene scene = lit_floor();
    scene.lights.clear();
    expect_black_without_work(scene, GetParam());
}

TEST_P(Nothing, OfPower) {
    Scene scene = lit_floor();
    scene.lights[0].intensity = glm::vec3(0.0f);
    expect_black_without_work(scene, GetParam());
}

TEST_P(Nothing, OfReflectance) {
    Scene scene = lit_floor();
    scene.materials[0].base_color = glm::vec4(0, 0, 0, 1);
    expect_black(render(scene, GetParam()));
}

TEST_P(Nothing, OfIndirectLights) {
    const Frame frame = render(lit_floor(), GetParam(), above, 0);
    expect_finite(frame);
    EXPECT_TRUE(frame.lights.empty());
    EXPECT_GT(frame.radiance[frame.pixels / 2].x, 0.0f);  // direct light is still there
}

TEST_P(Nothing, ThatTheSpotHits) {
    Scene scene = lit_floor();
    scene.lights[0].direction = {0, 1, 0};
    expect_black(render(scene, GetParam()));
}

TEST_P(Nothing, ThatTheCameraSees) {
    expect_black(render(lit_floor(), GetParam(), test::camera_at({0, 2, 0.1}, {0, 4, 0})));
}

TEST_P(Nothing, BetweenCameraAndWall) {
    Scene scene = lit_floor();
    test::add_box(scene, {-0.2, 1.8, -0.2}, {0.2, 2.2, 0.2}, 1);  // the camera is inside of it
    expect_finite(render(scene, GetParam()));
    expect_finite(
        render(scene, GetParam(), test::camera_at({0.2, 2, 0}, {0, 0, 0})));  // and in its face
}

TEST_P(Nothing, BetweenLampAndWall) {
    Scene scene = lit_floor();
    scene.lights[0].position = {0, 0, 0};  // in the floor
    expect_finite(render(scene, GetParam()));
}

TEST_P(Nothing, OfArea) {
    Scene scene = lit_floor();
    for (glm::dvec3& position : scene.positions) position.x = 0.0;
    expect_black(render(scene, GetParam()));
    for (glm::dvec3& position : scene.positions) position = glm::dvec3(1, 2, 3);
    expect_black(render(scene, GetParam()));
}

TEST_P(Nothing, OfNegativeLightsAndFootprint) {
    SecondOrderOptions options;
    options.width = options.height = 1;
    options.emitters.vpls = 1;
    options.negative_vpls = 0;
    options.footprint = 0.0f;
    options.build = GetParam();
    expect_finite(test::render(lit_floor(), above, options));
}

// One part in a million of the scene's size between a corner and the next.
TEST_P(Hardly, AnyAreaInASliver) {
    Scene scene = lit_floor();
    for (int i = 0; i < 50; ++i)
        test::add_triangle(scene, {-1, 0.1 + 0.01 * i, 0}, {1, 0.1 + 0.01 * i, 0},
                           {1, 0.1 + 0.01 * i, -1e-6});
    expect_finite(render(scene, GetParam()));
}

TEST_P(Hardly, AnyLightAndALot) {
    for (const float power : {1e-38f, 1e-20f, 1e20f, 1e38f}) {
        Scene scene = lit_floor();
        scene.lights[0].intensity = glm::vec3(power);
        const Frame frame = render(scene, GetParam());
        expect_finite(frame);
    }
}

TEST(NotANumber, IsRefusedWhereverItStands) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Scene scene = lit_floor();
    scene.positions[2].y = nan;
    EXPECT_THROW(test::on_device(scene), InputError);
    scene = lit_floor();
    scene.lights[0].outer_angle = static_cast<float>(nan);
    EXPECT_THROW(test::on_device(scene), InputError);
    scene = lit_floor();
    scene.lights[0].intensity.y = static_cast<float>(nan);
    EXPECT_THROW(test::on_device(scene), InputError);
}

TEST(Cone, OfNoWidthOrMoreThanHalfTheSphereIsRefused) {
    for (const float angle : {0.0f, -1.0f, 1.6f, 3.1416f, 7.0f}) {
        Scene scene = lit_floor();
        scene.lights[0].outer_angle = angle;
        scene.lights[0].inner_angle = 0.0f;
        EXPECT_THROW(test::on_device(scene), InputError) << angle;
    }
}

}  // namespace
}  // namespace clgi
