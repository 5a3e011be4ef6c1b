// Where nothing lies between, shadow maps take no light away: what texels around a corner show is
// another wall, whose plane runs on behind the receiver. What stands before a corner still blocks.
// SPDX-License-Identifier: MIT
#include "frames.hpp"
#include "math_modes.hpp"
#include "slanted_room.hpp"

namespace clgi {
namespace {

// Direct light alone, with shadow maps of so many pixels a side; 0: without.
test::Frame direct_frame(const Scene& scene, const Camera& camera, int side) {
    SecondOrderOptions options;
    options.width = 160;
    options.height = 120;
    options.indirect = false;
    options.emitters.area_samples = 6;
    options.emitters.shadows = side > 0;
    options.emitters.shadow_size = options.emitters.face_size = std::max(side, 1);
    options.build = test::usual_build();
    return test::render(scene, camera, options);
}

CLGI_IN_ALL_MODES(ConvexShadow);

// Pixels that shadow maps change, from two sides.
std::size_t changed(const Scene& scene, int side) {
    std::size_t out = 0;
    for (const Camera& camera : {test::camera_at({0.6, 1.0, 0.6}, {-0.5, 0.6, -0.7}),
                                 test::camera_at({-0.6, 0.4, -0.7}, {0.4, 0.9, 0.8})}) {
        const auto open = direct_frame(scene, camera, 0).radiance;
        const auto shadowed = direct_frame(scene, camera, side).radiance;
        for (std::size_t i = 0; i < open.size(); ++i) {
            EXPECT_GT(open[i].x, 0.0f);
            out += open[i] != shadowed[i];
        }
    }
    return out;
}

TEST_P(ConvexShadow, IsNoneOfLamps) {
    const Scene scene = test::slanted_room();
    for (const int side : {64, 256, 1024}) EXPECT_EQ(changed(scene, side), 0u) << side;
}

// Walls beside a lamp right under the ceiling fall steeply from texel to texel.
TEST_P(ConvexShadow, IsNoneOfALampUnderTheCeiling) {
    Scene scene = test::slanted_room();
    scene.lights = {test::point_light({0.1, 1.9, -0.1}, 2.0f),
                    test::point_light({0.6, 1.85, 0.3}, 2.0f)};
    for (const int side : {64, 256, 1024}) EXPECT_EQ(changed(scene, side), 0u) << side;
}

// A sheet across a room: the floor behind it is dark but for what a texel and the bias let through,
// also beside a wall that texels show at a grazing angle.
TEST_P(ConvexShadow, OfASheetIsDarkUpToItsFoot) {
    Scene scene = test::plain_scene();
    const auto quad = [&](const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c,
                          const glm::dvec3& d) {
        test::add_quad(scene, {a, b, c, d});
    };
    quad({-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1});
    quad({-1, 0, -1}, {1, 0, -1}, {1, 2, -1}, {-1, 2, -1});
    quad({0, 0, 1}, {0, 0, -1}, {0, 2, -1}, {0, 2, 1});
    scene.materials[0].double_sided = true;
    constexpr int side = 256;
    const Camera camera = test::camera_at({0.1, 0.15, -0.8}, {0.02, 0.0, -0.99});
    for (const glm::dvec3& lamp : {glm::dvec3(-0.8, 1, -0.95), glm::dvec3(-0.5, 1, -0.9),
                                   glm::dvec3(-0.5, 0.3, -0.9), glm::dvec3(-0.5, 1, 0)}) {
        scene.lights = {test::point_light(lamp, 2.0f)};
        const test::Frame frame = direct_frame(scene, camera, side);
        // Of a texel: its size where the lamp sees the floor, along the floor.
        const double distance = glm::length(lamp - glm::dvec3(0.0, 0.0, -1.0));
        const double texel = 2.0 / side * distance * distance / lamp.y;
        int dark = 0;
        for (std::size_t i = 0; i < frame.pixels; ++i) {
            const glm::dvec3 at = frame.world(i);
            if (at.y > 1e-4 || at.x < 3.0 * texel) continue;
            ++dark;
            EXPECT_EQ(frame.radiance[i], glm::vec3(0.0f)) << at.x / texel << " texels";
        }
        EXPECT_GT(dark, 300);
    }
}

// Points of a surface are lit by it at grazing angles, where planes are too steep to be followed on
// coarse maps.
TEST_P(ConvexShadow, IsNoneOfWhatShines) {
    Scene scene = test::slanted_room();
    Material ceiling = scene.materials[0];
    ceiling.emission = {0.3f, 0.2f, 0.6f};
    scene.materials.push_back(ceiling);
    scene.triangles[2].material = scene.triangles[3].material = 1;
    EXPECT_EQ(changed(scene, 256), 0u);
}

}  // namespace
}  // namespace clgi
