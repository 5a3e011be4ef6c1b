// Windows of transfer vectors, of every degree: directional lights have all of them.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "math_modes.hpp"
#include "transfer_scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(TransferWindow);

// What a window leaves of a degree, of so many bands.
double factor(sh::Window window, int l, int bands) {
    const double angle = pi * l / bands;
    if (window == sh::Window::hann) return (1 + std::cos(angle)) / 2;
    if (window == sh::Window::lanczos && l > 0) return std::sin(angle) / angle;
    return 1.0;
}

// Irradiance of a light of 1 lux whose direction has this cosine with the normal: the sum of
// (2 l + 1) / (4 pi) A_l P_l(cosine) w_l, with A_l of the clamped cosine (pi, 2 pi / 3, pi / 4, 0,
// -pi / 24).
double irradiance(double cosine, sh::Window window, int bands) {
    const double c = cosine, a[] = {pi, 2 * pi / 3, pi / 4, 0, -pi / 24};
    const double p[] = {1, c, (3 * c * c - 1) / 2, (5 * c * c - 3) * c / 2,
                        (35 * c * c * c * c - 30 * c * c + 3) / 8};
    double out = 0.0;
    for (int l = 0; l < bands; ++l)
        out += (2 * l + 1) / (4 * pi) * a[l] * p[l] * factor(window, l, bands);
    return out;
}

// On a tilted sheet, from the zenith of the sheet, from its side and from below the horizon of half
// of the directions: with masks and without.
TEST_P(TransferWindow, LessensEveryDegreeByItsOwnFactor) {
    const glm::vec3 lux(2.0f, 3.0f, 0.5f);
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.3, 1, -0.2));
    const glm::dvec3 u = glm::normalize(glm::cross(n, glm::dvec3(0, 0, 1))), v = glm::cross(n, u);
    for (const bool shadowed : {true, false})
        for (const sh::Window window : {sh::Window::none, sh::Window::hann, sh::Window::lanczos})
            for (const int bands : {3, 5}) {
                Scene scene = test::plain_scene();
                test::add_quad(scene, {-u - v, u - v, u + v, v - u});
                scene.lights = {test::directional_light({0, -1, 0})};
                scene.lights[0].intensity = lux;
                DeviceScene device = test::on_device(scene);
                DynamicTransferOptions options;
                options.directional = true;
                options.occlusion = shadowed ? Occlusion::automatic : Occlusion::none;
                options.window = window;
                options.masks.bands = bands;
                options.build.math = GetParam();
                DynamicTransferSolver solver(test::programs(), test::device().queue, scene, device,
                                             options);
                ASSERT_TRUE(solver.run());
                for (const double cosine : {1.0, 0.8, 0.5, 0.2}) {
                    Light light = scene.lights[0];
                    const double sine = std::sqrt(1 - cosine * cosine);
                    light.direction = -glm::vec3(cosine * n + sine * (0.6 * u + 0.8 * v));
                    device.set_light(0, light);
                    solver.lights_changed();
                    solver.light().wait();
                    const double wanted = irradiance(cosine, window, bands);
                    ASSERT_GT(wanted, 0.05);
                    for (const glm::dvec3& e : test::irradiance_of(solver, device))
                        for (int c = 0; c < 3; ++c)
                            // 25 products of floats, whose sum is a twentieth of the largest at
                            // least.
                            EXPECT_NEAR(e[c], lux[c] * wanted, 2e-5 * lux[c])
                                << shadowed << ", window " << int(window) << ", bands " << bands
                                << ", cosine " << cosine << ", channel " << c;
                }
            }
}

}  // namespace
}  // namespace clgi
