// A disc of light half hidden behind a smaller disc: what negative VPLs take away, against the
// exact view factors and against the limit of the method itself.
//
//   emitter, radius 1  y = 1     F_s = 1/2                     light of the whole emitter
//   blocker, radius b  y = 1/2   F_n = 4 b^2 / (1 + 4 b^2)     what the blocker hides of it
//   receiver           y = 0     F_c = F_s - F_n               what is left: 0.3 for b = 1/4
//
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <numbers>

#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr int emitter_rings = 64;  // of the emitter, of equal area, as many lights on each
constexpr int samples = 4096;      // negative VPLs
constexpr double border = 1.1;     // half the image, in radii of the blocker

// Facing down.
void add_disc(Scene& scene, double radius, double y) {
    const int corners = 256;  // 0.01 % less area than the circle
    for (int k = 0; k < corners; ++k) {
        const double from = 2 * pi * k / corners, to = 2 * pi * (k + 1) / corners;
        test::add_triangle(scene, {0, y, 0}, {radius * std::cos(from), y, radius * std::sin(from)},
                           {radius * std::cos(to), y, radius * std::sin(to)});
    }
}

Scene discs(double blocker) {
    Scene scene = test::plain_scene();
    add_disc(scene, 1.0, 1.0);
    add_disc(scene, blocker, 0.5);
    return scene;
}

// On the emitter, which sends out 1 lumen a square metre everywhere.
std::vector<Vpl> vpls_of_disc(const SceneFrame& frame) {
    std::vector<Vpl> lights;
    const float flux =
        static_cast<float>(pi / (emitter_rings * emitter_rings) * frame.scale * frame.scale);
    for (int ring = 0; ring < emitter_rings; ++ring)
        for (int k = 0; k < emitter_rings; ++k) {
            const double radius = std::sqrt((ring + 0.5) / emitter_rings);
            const double turn = 2 * pi * (k + 0.5 * (ring % 2)) / emitter_rings;
            const glm::vec3 at =
                frame.to_local({radius * std::cos(turn), 1.0, radius * std::sin(turn)});
            lights.push_back(
                {glm::vec4(at, 0), glm::vec4(0, -1, 0, 0), glm::vec4(glm::vec3(flux), 1)});
        }
    return lights;
}

// What the blocker's back receives at this distance from the axis.
double stopped(double a) {
    const double h = 0.5 / a, r = 1.0 / a, z = 1 + h * h + r * r;
    return 0.5 * (1 - (1 + h * h - r * r) / std::sqrt(z * z - 4 * r * r));
}

// Direction of the light that arrives there, by luminance; in the plane through the axis.
glm::dvec3 arriving(double a) {
    glm::dvec3 mean(0.0);
    const int turns = 32;
    for (int ring = 0; ring < emitter_rings; ++ring)
        for (int k = 0; k < turns; ++k) {
            const double radius = std::sqrt((ring + 0.5) / emitter_rings),
                         turn = 2 * pi * k / turns;
            const glm::dvec3 t(radius * std::cos(turn) - a, 0.5, radius * std::sin(turn));
            mean -= t * std::pow(glm::dot(t, t), -2.5);  // two cosines over d^2, a direction t/d
        }
    return glm::normalize(mean);
}

// The method's own limit: the blocker sends on what it stops as a cosine lobe about the direction
// that it arrives in.
double negative_limit(double blocker) {
    double sum = 0.0;
    const int steps = 50;
    for (int k = 0; k < steps; ++k) {
        const double a = blocker * (k + 0.5) / steps;
        const glm::dvec3 down(-a, -0.5, 0);
        const double square = glm::dot(down, down);
        const double lobe = glm::dot(arriving(a), down), cosine = 0.5;  // times d each
        sum += 2 * pi * a * (blocker / steps) * stopped(a) * lobe * cosine / (pi * square * square);
    }
    return sum;
}

std::vector<Vpl> negative_vpls(const DeviceScene& scene, const Camera& camera,
                               const std::vector<Vpl>& lights) {
    const View view = make_view(camera, scene.frame(), 128, 128);
    const test::Drawing drawing = test::draw(scene, view);
    const NegativeParams params{static_cast<cl_uint>(lights.size()),
                                samples,
                                drawing.stride,
                                16.0f * 5.96e-8f * 2.0f * scene.frame().radius,
                                0.0f,
                                0,
                                0,
                                0};
    const cl::Buffer out = test::empty<Vpl>(samples);
    const cl::Buffer planes = test::upload_planes(drawing.planes, drawing.stride);
    const cl::Buffer vpls = test::upload(lights);
    test::light_passes().negative(test::device().queue, params, view, planes, vpls, out);
    return test::download<Vpl>(out, samples);
}

CLGI_IN_ALL_MODES(BlockerDisc);

TEST_P(BlockerDisc, ReceivesOnItsBackWhatTheViewFactorSays) {
    EXPECT_NEAR(stopped(1e-4), 0.8, 1e-6);
    // r = h = 1 and a = 1/2, 1 of the table, at half its scale.
    EXPECT_NEAR(0.5 * (1 - (1 + 4 - 4.0) / std::sqrt(81 - 16.0)), 0.4379826327, 1e-10);
    const DeviceScene scene = test::on_device(discs(0.25));
    const auto lights = vpls_of_disc(scene.frame());
    for (const double a : {0.05, 0.15, 0.25})
        // The midpoint rule misses f'(0) / 24 / emitter_rings^2 = 3.3e-4 on the axis, less beside
        // it, of f(r^2) = h^2 / (r^2 + h^2)^2 with h = 1/2.
        EXPECT_NEAR(test::lux_at(scene, lights, {a, 0.5, 0}, {0, 1, 0}, GetParam()), stopped(a),
                    3.3e-4 + test::half_error());
}

TEST_P(BlockerDisc, IsTakenAwayAsFarAsACosineLobeCan) {
    for (const auto& [blocker, left] :
         {std::pair(0.1, .4615384615), {0.25, .3}, {0.4, .1097560976}}) {
        const double hidden = 4 * blocker * blocker / (1 + 4 * blocker * blocker);
        EXPECT_NEAR(0.5 - hidden, left, 1e-10);
        const DeviceScene scene = test::on_device(discs(blocker));
        const auto lights = vpls_of_disc(scene.frame());
        const test::Receiver receiver{scene.frame().to_local({0, 0, 0}), {0, 1, 0}};
        const double all = test::gather({receiver}, lights, {})[0].x;
        EXPECT_NEAR(all, 0.5,
                    1e-4 + test::half_error());  // 2e-5 for h = 1, and a sum of 4096 floats

        const double limit = negative_limit(blocker);
        Camera camera = test::camera_at({0, 0, 0}, {0, 1, 0});
        camera.vertical_fov = static_cast<float>(2 * std::atan(2 * border * blocker));
        camera.half_height = static_cast<float>(border * blocker);
        for (const Camera::Kind kind : {Camera::Kind::perspective, Camera::Kind::orthographic}) {
            camera.kind = kind;
            const auto negative = negative_vpls(scene, camera, lights);
            const double less = test::gather({receiver}, lights, negative)[0].x;
            // Of so many points that many lie on the disc, were they random; Halton points must
            // do better than one standard deviation of those.
            const double share = pi / (4 * border * border);
            const double chance = std::sqrt((1 - share) / (share * samples));
            EXPECT_NEAR(all - less, limit, chance * limit) << blocker;
            // Never more than the blocker hides, and most of it: its back gets at most 0.8 of the
            // emitter's radiosity, which a cosine lobe spreads over more than the cone it came in.
            EXPECT_GE(less, left - test::half_error());
            EXPECT_LE(less - left, 0.3 * hidden) << blocker;
        }
    }
}

// The emitter itself is seen beside the blocker; it hides nothing.
TEST_P(BlockerDisc, IsTheOnlyOneThatHidesAnything) {
    const DeviceScene scene = test::on_device(discs(0.25));
    Camera camera = test::camera_at({0, 0, 0}, {0, 1, 0});
    camera.kind = Camera::Kind::orthographic;
    camera.half_height = 1.0f;
    int hiding = 0;
    for (const Vpl& light : negative_vpls(scene, camera, vpls_of_disc(scene.frame()))) {
        if (light.flux.x == 0.0f) continue;
        ++hiding;
        const glm::dvec3 at =
            glm::dvec3(light.position) / scene.frame().scale + scene.frame().origin;
        EXPECT_NEAR(at.y, 0.5, 1e-6);
        EXPECT_LT(std::hypot(at.x, at.z), 0.25 + 1e-6);
    }
    EXPECT_GT(hiding, samples / 40);  // pi/64 of the image
}

}  // namespace
}  // namespace clgi
