// No light comes through the walls of a closed room, however it grazes them.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/renderer.hpp>

#include "device.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(CornerShadows);

// Planes of walls run on through the outsides of the corners that they meet, where they are in
// front of what is seen there.
TEST_P(CornerShadows, LeaveAClosedRoomDark) {
    Scene scene = test::plain_scene({0.8f, 0.6f, 0.4f});
    test::add_box(scene, {-0.2, -0.2, -0.2}, {20.2, 8.2, 30.2}, 1);
    test::add_box(scene, {0, 0, 0}, {20, 8, 30}, -1);
    scene.cameras = {test::camera_at({10, 1.5, 2}, {10, 2, 30}, 1.2f)};
    test::Random random(3);
    RendererOptions options;
    options.method = Method::direct;
    options.picture.width = 96;
    options.picture.height = 72;
    options.picture.emitters.shadow_size = 512;  // texels of 7 cm; walls are 20 cm thick
    options.picture.build = test::usual_build();
    int lit = 0;
    for (int draw = 0; draw < 12; ++draw) {
        // Along one of the walls that the camera sees, within three degrees.
        const bool far_wall = draw % 2 == 0;
        const double graze = random(0.005, 0.05), down = -random(0.1, 0.6);
        const double side = draw % 4 < 2 ? 1.0 : -1.0;
        const glm::dvec3 way =
            far_wall ? glm::dvec3(side, down, graze) : glm::dvec3(side * graze, down, 1.0);
        scene.lights = {test::directional_light(glm::vec3(way), 1e5f)};
        Renderer renderer(test::programs(), test::device().queue, scene, options);
        renderer.render(scene.cameras[0]);
        for (const std::vector<float>& channel : renderer.read_radiance())
            for (const float value : channel) lit += value > 0.0f ? 1 : 0;
    }
    EXPECT_EQ(lit, 0);
}

}  // namespace
}  // namespace clgi
