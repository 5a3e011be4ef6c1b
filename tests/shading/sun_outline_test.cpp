// The shadow maps of directional lights: rectangles around what the light sees of the scene's box.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/emitters.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "device.hpp"
#include "patchwork.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// Two triangles between opposite corners of a box of any shape and place, under a sun.
Scene drawn(test::Random& random) {
    Scene scene = test::plain_scene();
    const glm::dvec3 middle(random(-50, 50), random(-50, 50), random(-50, 50));
    const glm::dvec3 half(std::exp2(random(-4, 6)), std::exp2(random(-4, 4)),
                          std::exp2(random(-4, 4)));
    const auto corner = [&](int x, int y, int z) { return middle + half * glm::dvec3(x, y, z); };
    test::add_triangle(scene, corner(-1, -1, -1), corner(1, -1, -1), corner(-1, 1, -1));
    test::add_triangle(scene, corner(1, 1, 1), corner(-1, 1, 1), corner(1, -1, 1));
    glm::dvec3 to(0.0);
    while (!(glm::length(to) > 0.1)) to = {random(-1, 1), random(-1, 1), random(-1, 1)};
    scene.lights = {test::directional_light(glm::vec3(glm::normalize(to)))};
    // With a focus the box lies on one side of the local frame's origin.
    const glm::dvec3 aside(random(-1, 1), random(-1, 1), random(-1, 1));
    if (random.integer(0, 1) == 1)
        scene.focus = Focus{middle + half * aside, 0.1 * glm::length(half)};
    return scene;
}

// The area of the rectangle around the box, turned by an angle, with as much around as maps have.
double turned_area(const SceneFrame& frame, const glm::dvec3& right, const glm::dvec3& up,
                   double angle) {
    const glm::dvec3 along[2] = {right * std::cos(angle) + up * std::sin(angle),
                                 up * std::cos(angle) - right * std::sin(angle)};
    double area = 1.0;
    for (const glm::dvec3& one : along) {
        // Half a box's width along a direction: the sum of what each of its sides gives.
        const glm::dvec3 half = 0.5 * (glm::dvec3(frame.high) - glm::dvec3(frame.low));
        area *= 2.0 * (glm::dot(half, glm::abs(one)) + 1e-3 * frame.radius);
    }
    return area;
}

TEST(SunOutline, HoldsTheSceneAndIsAsSmallAsAnyThatIsTurned) {
    test::Random random(52);
    for (int i = 0; i < 100; ++i) {
        const Scene world = drawn(random);
        const DeviceScene scene = test::on_device(world);
        const SceneFrame& frame = scene.frame();
        for (const std::uint32_t sample : {0u, 3u}) {
            const EmitterSet set = make_emitters(scene, {.shadow_size = 256, .sample = sample});
            ASSERT_EQ(set.views.size(), world.focus ? 2u : 1u);
            const View& view = set.views.back();
            const glm::dvec3 right(view.right), up(view.up), axis(view.forward), eye(view.eye);
            EXPECT_NEAR(glm::dot(glm::cross(right, axis), up), 1.0, 1e-5);
            for (const glm::dvec3& position : world.positions) {
                const glm::dvec3 from = glm::dvec3(frame.to_local(position)) - eye;
                EXPECT_LE(std::abs(glm::dot(from, right) - view.window.x), view.right.w) << i;
                EXPECT_LE(std::abs(glm::dot(from, up) - view.window.y), view.up.w) << i;
                EXPECT_GT(glm::dot(from, axis), 0.0) << i;
                EXPECT_LT(glm::dot(from, axis), view.window.z) << i;
            }
            if (sample > 0) continue;
            double least = std::numeric_limits<double>::infinity();
            for (int turn = 0; turn < 720; ++turn)
                least =
                    std::min(least, turned_area(frame, right, up, turn * std::numbers::pi / 720.0));
            const double area = 4.0 * double{view.right.w} * double{view.up.w};
            EXPECT_LT(area, 1.02 * least) << i;
            EXPECT_GT(area, 0.98 * least) << i;
        }
    }
}

// The map around the focus ends with the scene, unless nothing of it is there.
TEST(SunOutline, OfAFocusIsNoLargerThanTheScene) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 10.0);
    test::add_box(scene, {-10.0, 0.0, -10.0}, {10.0, 0.5, 10.0}, 1);
    scene.lights = {test::directional_light({1.0f, 0.0f, 0.0f})};
    scene.focus = Focus{{0.0, 0.25, 0.0}, 2.0};
    const DeviceScene near = test::on_device(scene);
    const EmitterSet set = make_emitters(near, {.shadow_size = 64});
    ASSERT_EQ(set.views.size(), 2u);
    const double scale = near.frame().scale;
    for (const auto& [view, width] : {std::pair(0, 2.0), std::pair(1, 10.0)}) {
        const double x = set.views[static_cast<std::size_t>(view)].right.w / scale;
        const double y = set.views[static_cast<std::size_t>(view)].up.w / scale;
        EXPECT_NEAR(std::max(x, y), width, 0.02) << view;
        EXPECT_NEAR(std::min(x, y), 0.25, 0.02) << view;
    }
    for (const double y : {9.0, -9.0}) {
        scene.focus->centre = {0.0, y, 0.0};
        const DeviceScene beside = test::on_device(scene);
        const EmitterSet two = make_emitters(beside, {.shadow_size = 64});
        ASSERT_EQ(two.views.size(), 2u);
        EXPECT_NEAR(two.views[0].right.w / beside.frame().scale, 2.0, 0.02);
        EXPECT_NEAR(two.views[0].up.w / beside.frame().scale, 2.0, 0.02);
    }
}

// Instead of the scene and its focus: one map, which holds any box that is lit and ends with it,
// and reaches as deep as the scene.
TEST(SunOutline, IsThatOfTheReceivers) {
    test::Random random(53);
    for (int i = 0; i < 40; ++i) {
        const DeviceScene scene = test::on_device(drawn(random));
        const SceneFrame& frame = scene.frame();
        const glm::vec3 middle = test::random_vec3(random, -0.5, 0.5);
        const glm::vec3 half = test::random_vec3(random, 0.01, 0.3);
        EmitterOptions options{.shadow_size = 64};
        options.receivers = LocalBox{middle - half, middle + half};
        const EmitterSet set = make_emitters(scene, options);
        ASSERT_EQ(set.views.size(), 1u);
        const View& view = set.views[0];
        const glm::vec3 right(view.right), up(view.up), eye(view.eye);
        float most[2] = {0.0f, 0.0f};
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 side(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
            const glm::vec3 from = middle + half * side - eye;
            most[0] = std::max(most[0], std::abs(glm::dot(from, right) - view.window.x));
            most[1] = std::max(most[1], std::abs(glm::dot(from, up) - view.window.y));
        }
        const float around = 1.1e-3f * frame.radius;
        for (const auto& [extent, reached] :
             {std::pair(view.right.w, most[0]), std::pair(view.up.w, most[1])}) {
            EXPECT_LT(reached, extent) << i;
            EXPECT_GT(reached, extent - around) << i;
        }
        EXPECT_GT(view.window.z, 2.0f * frame.radius) << i;
    }
}

// A focus that is small beside them has a map of its own; one that is not, or lies elsewhere, has
// none. However large the scene, a small box has a small map.
TEST(SunOutline, OfReceiversHasThatOfTheFocusToo) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 50000.0);
    scene.lights = {test::directional_light({0.3f, 1.0f, 0.2f})};
    scene.focus = Focus{{0.0, 0.0, 0.0}, 2.0};
    const DeviceScene device = test::on_device(scene);
    const float detail = device.frame().detail;
    const auto views = [&](const glm::vec3& low, const glm::vec3& high) {
        EmitterOptions options{.shadow_size = 64};
        options.receivers = LocalBox{low * detail, high * detail};
        return make_emitters(device, options).views;
    };
    const auto wide = views({-40, 0, -30}, {40, 1, 50});
    ASSERT_EQ(wide.size(), 2u);
    EXPECT_LE(std::max(wide[0].right.w, wide[0].up.w), 1.01f * detail);
    EXPECT_GT(std::max(wide[1].right.w, wide[1].up.w), 39.0f * detail);
    const auto narrow = views({-1, 0, -1}, {1, 1, 1});
    ASSERT_EQ(narrow.size(), 1u);
    EXPECT_LT(std::max(narrow[0].right.w, narrow[0].up.w), 1.8f * detail);
    EXPECT_EQ(views({100, 0, 100}, {150, 1, 150}).size(), 1u);
}

}  // namespace
}  // namespace clgi
