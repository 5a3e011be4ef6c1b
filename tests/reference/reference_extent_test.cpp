// The path tracer in scenes that are far larger than what is looked at.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// Two small tiles, albedo 1/2, 0.2 and 0.3 m below a lamp of 0.1 by 0.1 m; a black plain far below
// them, of so many metres. The lamp's light by its view factor from a corner on the normal, four
// times: F = 2/pi (x / r atan(y / r)), x = y = a / h, r^2 = 1 + x^2.     [parallel planes, Howell's
// B-3]
Scene tiles(double extent) {
    Scene scene = test::plain_scene();
    Material glowing, black;
    glowing.base_color = black.base_color = glm::vec4(0, 0, 0, 1);
    glowing.emission = glm::vec3(3.0f, 5.0f, 2.0f);
    const std::uint32_t lamp = test::add_material(scene, glowing),
                        plain = test::add_material(scene, black);
    const auto square = [&](double x, double y, double half, bool down, std::uint32_t material) {
        const double z = down ? -half : half;
        test::add_quad(
            scene,
            {glm::dvec3(x - half, y, z), {x + half, y, z}, {x + half, y, -z}, {x - half, y, -z}},
            material);
    };
    for (const int side : {-1, 1}) {
        square(side, 0.0, 0.002, false, 0);
        square(side, side < 0 ? 0.2 : 0.3, 0.05, true, lamp);
    }
    square(0.0, -5.0, 0.5 * extent, false, plain);
    return scene;
}

TEST(ReferenceExtent, LeavesSurfacesByWhatIsThere) {
    for (const double extent : {10.0, 1e4, 1e5}) {
        const Scene scene = tiles(extent);
        const reference::PathTracer tracer(scene);
        for (const int side : {-1, 1}) {
            Camera camera = test::camera_at({side + 0.2, 0.1, 0.0}, {side, 0.0, 0.0}, 0.005f);
            camera.near = 0.01f;
            reference::Options options;
            options.effects = reference::parse_effects("direct");
            options.width = options.height = 4;
            options.samples = 400;
            const reference::Picture found = tracer.render(camera, options);
            const double x = 0.05 / (side < 0 ? 0.2 : 0.3), r = std::sqrt(1.0 + x * x);
            const double factor = 4.0 * x / (pi * r) * std::atan(x / r);
            glm::dvec3 mean(0.0);
            for (const glm::vec3& radiance : found.radiance) mean += glm::dvec3(radiance) / 16.0;
            const glm::dvec3 wanted = 0.5 * factor * glm::dvec3(3.0, 5.0, 2.0);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(mean[c] / wanted[c], 1.0, 0.01) << extent << " m, tile " << side;
        }
    }
}

}  // namespace
}  // namespace clgi
