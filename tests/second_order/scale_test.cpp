// Scenes at sizes that are no powers of two apart: everything is rounded anew, and no result may
// move by more than that explains. (Powers of two change no bit:
// tests/second_order/invariance_test.cpp.)
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "frames.hpp"
#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double half_spacing = 0x1p-24;  // half the spacing of floats at 1
constexpr double sizes[] = {1e-4, 0.7, 3.0, 1e6};

// A room without a corner in the picture: the camera sees the floor only, and all walls light it.
Scene room(Light light) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, -0.8, -1.1}, {1, 0.9, 1}, -1);
    scene.lights = {light};
    scene.cameras = {test::camera_at({0.1, 0.7, 0.2}, {0.15, -0.8, 0.1}, 0.6f)};
    return scene;
}

Scene scaled(Scene scene, double size) {
    for (glm::dvec3& position : scene.positions) position *= size;
    for (Camera& camera : scene.cameras) camera.position *= size;
    for (Light& light : scene.lights) {
        light.position *= size;
        light.intensity *= static_cast<float>(size * size);  // the same lux at every place
    }
    return scene;
}

// A place of the local frame in the scene as it was before it was scaled.
glm::dvec3 unscaled(const SceneFrame& frame, const glm::vec3& local, double size) {
    return (glm::dvec3(local) / frame.scale + frame.origin) / size;
}

// What rounding did to a set of lights.
struct Moved {
    double place = 0.0;  // m
    double disc = 0.0;   // share of the squared radius
    double flux = 0.0;   // share
};

Moved moved(const std::vector<Vpl>& lights, const SceneFrame& frame, const std::vector<Vpl>& others,
            const SceneFrame& there, double size) {
    Moved out;
    const double area = std::pow(frame.scale / there.scale / size, 2);
    const double lumen = area * there.exposure / frame.exposure;
    for (std::size_t l = 0; l < lights.size(); ++l) {
        out.place =
            std::max(out.place, glm::length(unscaled(there, glm::vec3(others[l].position), size) -
                                            unscaled(frame, glm::vec3(lights[l].position), 1.0)));
        out.disc =
            std::max(out.disc, std::abs(others[l].position.w * area / lights[l].position.w - 1));
        out.flux = std::max(out.flux, std::abs(others[l].flux.x * lumen / lights[l].flux.x - 1));
    }
    return out;
}

// To first order a light's place moves by 6 u |e1| |e2| (2 t + |e1| + |e2|) / (d.(e1 x e2)) + 6 u,
// u = half_spacing, in the local frame; e1 and e2 the edges of a wall, t the way to its corner, d
// the unit ray. Here edges are 3.0 m at most in a frame of 4 m, sin of the angle between them at
// least 0.67, the way to a corner 2.2 m, and rays meet walls at a cosine of 0.3 or more.
constexpr double place_bound = (6 * (2 * 2.2 + 6.0) / (0.67 * 0.3) + 6 * 4.0) * half_spacing * 2;

void expect_rounding_only(const Moved& rounding) {
    EXPECT_LE(rounding.place, place_bound);
    // A share's disc is dw d^2 / cos, d at least 0.6 m: two distances and a cosine, and the
    // products.
    EXPECT_LE(rounding.disc, 2 * place_bound / 0.6 + place_bound / 0.3 + 16 * half_spacing);
    EXPECT_LE(rounding.flux, 16 * half_spacing);
}

CLGI_IN_ALL_MODES(Scaled);

TEST_P(Scaled, PlacesTheSameLights) {
    for (const Light& light : {test::spot_light({0.2, 0.5, 0.1}, {0.1f, -1, 0.2f}, 0.6),
                               test::point_light({0.2, 0.1, 0.1})}) {
        const Scene scene = room(light);
        const DeviceScene here = test::on_device(scene);
        const auto usual = test::place_lights(here, {.vpls = 300});
        for (const double size : sizes) {
            const DeviceScene there = test::on_device(scaled(scene, size));
            const auto placed = test::place_lights(there, {.vpls = 300});
            EXPECT_EQ(placed.accepted, usual.accepted) << size;
            expect_rounding_only(
                moved(usual.lights, here.frame(), placed.lights, there.frame(), size));
        }
    }
}

// d/dx of I cos / d^2 and of each light's Phi (n.t)(m.t) k(d), k falling with d^-4 at most.
TEST_P(Scaled, IsTheSamePictureButForRounding) {
    const glm::dvec3 lamp(0.2, 0.1, 0.1);
    const Scene scene = room(test::point_light(lamp));
    SecondOrderOptions options;
    options.build = GetParam();
    options.width = 31;
    options.height = 23;
    options.emitters = {.vpls = 100, .shadow_size = 64, .face_size = 64};
    options.low_resolution_step = 1;
    options.negative_vpls = 0;
    const test::Frame usual = test::render(scene, scene.cameras[0], options);
    for (const double size : sizes) {
        const Scene other = scaled(scene, size);
        const test::Frame frame = test::render(other, other.cameras[0], options);
        const Moved lights = moved(usual.lights, usual.place, frame.lights, frame.place, size);
        expect_rounding_only(lights);
        double unlike = 0.0;
        for (std::size_t p = 0; p < usual.pixels; ++p) {
            const glm::dvec3 at = usual.world(p);
            ASSERT_NEAR(at.y, -0.8, 1e-6) << "the camera sees the floor alone";
            const double shift = glm::length(frame.world(p) / size - at);
            EXPECT_LE(shift, place_bound) << p;

            const glm::dvec3 ray = lamp - at;
            const double d = glm::length(ray), direct = ray.y / (d * d * d);
            const double moves =
                shift + 2 * half_spacing * 4.0;  // the lamp's place is rounded once each time
            double bound = direct * (moves * (3 / d + 1 / ray.y) + 16 * half_spacing);
            for (const Vpl& light : usual.lights) {
                const glm::dvec3 t = unscaled(usual.place, glm::vec3(light.position), 1.0) - at;
                const double square = glm::dot(t, t);
                const double radius2 = light.position.w / std::pow(usual.place.scale, 2);
                const double kernel =
                    (square + radius2) / pi / (square * (square + radius2) + radius2 * radius2);
                const double flux =
                    light.flux.x * usual.place.exposure / std::pow(usual.place.scale, 2);
                const double shares = 2 * lights.disc + lights.flux + (16 + 2 * 100) * half_spacing;
                bound += flux * kernel * (6 * (shift + lights.place) / std::sqrt(square) + shares);
            }
            const double difference = std::abs(frame.radiance[p].x - usual.radiance[p].x);
            // Of half storage a step each of albedo, irradiance and the normal in two cosines.
            const double halves = 4 * test::half_error() * usual.radiance[p].x;
            EXPECT_LE(difference, 0.5 / pi * bound + halves) << p << " at " << size;
            unlike = std::max(unlike, difference);
        }
        EXPECT_GT(unlike, 0.0) << "a size that rounds nothing anew shows nothing";
    }
}

}  // namespace
}  // namespace clgi
