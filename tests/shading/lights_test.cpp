// VPLs against scenes whose one-bounce light has a closed form.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <numbers>

#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::PlacedLights;

using std::numbers::pi;
constexpr double degree = pi / 180.0;

// A sphere of facets is a little smaller than the true one: 0.05 % in radius at this fineness.
constexpr int fine = 5;
constexpr double facets = 0.005;

std::vector<glm::dvec3> around(int count) {
    std::vector<glm::dvec3> out;
    for (int i = 0; i < count; ++i) {
        const double y = 1.0 - (2.0 * i + 1.0) / count, turn = i * pi * (3.0 - std::sqrt(5.0));
        out.emplace_back(std::sqrt(1 - y * y) * std::cos(turn), y,
                         std::sqrt(1 - y * y) * std::sin(turn));
    }
    return out;
}

// rho Phi / (4 pi R^2) at every point of the inside of a sphere.
void expect_even_in_sphere(const DeviceScene& scene, const std::vector<Vpl>& lights, double flux,
                           double albedo, const test::Build& build) {
    for (const glm::dvec3& direction : around(40))
        EXPECT_NEAR(
            test::lux_at(scene, test::bare(lights), direction, glm::vec3(-direction), build),
            albedo * flux / (4 * pi), facets * albedo * flux / (4 * pi))
            << direction.y;
}

CLGI_IN_BOTH_MATHS(SpotInASphere);
CLGI_IN_BOTH_MATHS(PointInASphere);
CLGI_IN_BOTH_MATHS(AreaLightInASphere);
CLGI_IN_ALL_MODES(SpotOverAFloor);
CLGI_IN_BOTH_MATHS(ConvergenceOverAFloor);
CLGI_IN_BOTH_MATHS(IndirectLights);

TEST_P(SpotInASphere, LightsEveryPointAlike) {
    FurnaceOptions options;
    options.subdivisions = fine;
    const Scene world = furnace(options);
    const DeviceScene scene = test::on_device(world);
    const double flux = 2 * pi * (1 - std::cos(30 * degree));
    EXPECT_NEAR(0.5 * flux / (4 * pi), 0.0334936491, 1e-10);
    for (const int n : {1, 7, 300}) {
        const PlacedLights placed = test::place_lights(scene, {.vpls = n}, GetParam());
        expect_even_in_sphere(scene, placed.lights, flux, 0.5, GetParam());
    }
}

TEST_P(PointInASphere, LightsEveryPointAlike) {
    FurnaceOptions options;
    options.subdivisions = fine;
    options.light = LightSource::point;
    const DeviceScene scene = test::on_device(furnace(options));
    expect_even_in_sphere(scene, test::place_lights(scene, {.vpls = 500}, GetParam()).lights,
                          4 * pi, 0.5, GetParam());
}

TEST_P(AreaLightInASphere, LightsEveryPointAlike) {
    FurnaceOptions options;
    options.subdivisions = fine;
    Scene world = furnace(options);
    world.lights.clear();
    Material lamp;
    lamp.emission = glm::vec3(3.0f);
    const auto material = test::add_material(world, lamp);
    const double half = 0.05;
    test::add_quad(
        world, {glm::dvec3(-half, 0, -half), {half, 0, -half}, {half, 0, half}, {-half, 0, half}},
        material);  // facing down
    const DeviceScene scene = test::on_device(world);
    const double flux = pi * 3.0 * 4 * half * half;
    expect_even_in_sphere(scene, test::place_lights(scene, {.vpls = 512}, GetParam()).lights, flux,
                          0.5, GetParam());
}

Scene spot_over_floor(double angle, double half = 12.0) {
    Scene world = test::plain_scene();
    test::add_floor(world, half);
    world.lights.push_back(test::spot_light({0, 1, 0}, {0, -1, 0}, angle));
    return world;
}

// (2 rho I / 5 h^2)(1 - cos^5 a) at the spot itself, looking down.
double floor_seen_from_spot(double angle) { return 0.2 * (1 - std::pow(std::cos(angle), 5)); }

TEST_P(SpotOverAFloor, LightsItsOwnPlaceAsTheIntegralSays) {
    const std::pair<double, double> rows[] = {
        {15, .0318298598}, {30, .1025721421}, {45, .1646446609}, {60, .1937500000}};
    for (const auto& [angle, wanted] : rows) {
        EXPECT_NEAR(floor_seen_from_spot(angle * degree), wanted, 1e-10);
        const DeviceScene scene = test::on_device(spot_over_floor(angle * degree));
        const PlacedLights placed =
            test::place_lights(scene, {.vpls = 10000, .shadow_size = 256}, GetParam());
        // Halton sums of 10,000 points are within 0.01 % here; corners at 1/256 pixel add as much.
        EXPECT_NEAR(test::lux_at(scene, placed.lights, {0, 1, 0}, {0, -1, 0}, GetParam()), wanted,
                    0.005 * wanted)
            << angle;
    }
}

// Slope of log error over log N, by least squares: -1 where doubling N halves the error.
double convergence(const std::vector<glm::dvec3>& places) {
    const DeviceScene scene = test::on_device(spot_over_floor(45 * degree));
    const auto lit = [&](int n) {
        const auto lights = test::bare(test::place_lights(scene, {.vpls = n}).lights);
        std::vector<double> out;
        for (const glm::dvec3& place : places)
            out.push_back(test::lux_at(scene, lights, place, {0, -1, 0}));
        return out;
    };
    const std::vector<double> converged = lit(100000);
    double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0;
    for (int n = 50; n <= 6400; n *= 2) {
        const std::vector<double> found = lit(n);
        double square = 0;
        for (std::size_t i = 0; i < found.size(); ++i)
            square += std::pow(found[i] / converged[i] - 1, 2);
        const double x = std::log(n), y = 0.5 * std::log(square);
        sx += x, sy += y, sxx += x * x, sxy += x * y, count += 1;
    }
    return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

// Over the middle a sum depends on the heights of the points alone.
TEST_P(ConvergenceOverAFloor, ConvergesNearlyAsTheNumberOfLightsOverItsMiddle) {
    EXPECT_LT(convergence({{0, 1, 0}, {0, 2, 0}, {0, 0.7, 0}}), -0.75);
}

// Elsewhere the border of the cone tells; random points would converge with -1/2.
TEST_P(ConvergenceOverAFloor, ConvergesFasterThanRandomPointsElsewhere) {
    EXPECT_LT(convergence({{0.4, 1, 0.1}, {-0.3, 2, 0.5}, {1, 1.5, 1}, {0, 0.7, -2}}), -0.6);
}

TEST_P(IndirectLights, CarryAllThatTheRoomReflects) {
    Scene room = test::plain_scene(glm::vec3(0.7f));
    test::add_box(room, glm::dvec3(-1), glm::dvec3(1), -1);
    for (const double angle : {5.0, 35.0, 60.0, 85.0}) {  // the widest through a cube
        room.lights = {test::spot_light({0.3, 0.2, 0.1}, {0.3, -1, 0.2}, angle * degree)};
        const DeviceScene scene = test::on_device(room);
        const double flux = 2 * pi * (1 - std::cos(angle * degree));
        EXPECT_NEAR(
            test::total_flux(scene, test::place_lights(scene, {.vpls = 300}, GetParam()).lights),
            0.7 * flux, 0.7 * flux * 1e-5);  // sums of 300 floats
    }
}

TEST_P(IndirectLights, CarryHalfWhereHalfTheConeLeavesTheScene) {
    Scene world = test::plain_scene();
    test::add_quad(world, {glm::dvec3(0, 0, 9), {9, 0, 9}, {9, 0, -9}, {0, 0, -9}});
    world.lights = {test::spot_light({0, 1, 0}, {0, -1, 0}, 40 * degree)};
    const DeviceScene scene = test::on_device(world);
    const double half = 0.5 * pi * (1 - std::cos(40 * degree));  // times albedo 1/2
    EXPECT_NEAR(
        test::total_flux(scene, test::place_lights(scene, {.vpls = 4000}, GetParam()).lights), half,
        0.01 * half);
}

TEST_P(IndirectLights, CarryASunsLightOnAFloor) {
    Scene world = test::plain_scene();
    test::add_floor(world, 2.0);
    for (const double slant : {0.0, 45.0, 80.0}) {
        world.lights = {test::directional_light({static_cast<float>(std::sin(slant * degree)),
                                                 static_cast<float>(-std::cos(slant * degree)), 0},
                                                5.0f)};
        const DeviceScene scene = test::on_device(world);
        const double flux = 0.5 * 5.0 * 16.0 * std::cos(slant * degree);
        // A strip of the disc at 80 degrees: 2500 of 20000 samples, whose border counts 1 %.
        EXPECT_NEAR(
            test::total_flux(
                scene,
                test::place_lights(scene, {.vpls = 20000, .shadow_size = 1024}, GetParam()).lights),
            flux, 0.01 * flux)
            << slant;
    }
}

TEST_P(IndirectLights, AreNoneWhereTheSpotFacesAway) {
    Scene world = spot_over_floor(30 * degree);
    world.lights[0].direction = {0, 1, 0};
    const DeviceScene scene = test::on_device(world);
    for (const Vpl& light : test::place_lights(scene, {.vpls = 50}, GetParam()).lights)
        EXPECT_EQ(light.flux, glm::vec4(0.0f));
}

TEST_P(IndirectLights, AreNoneWhereTheSpotIsBuried) {
    Scene world = spot_over_floor(30 * degree);
    test::add_box(world, {-0.1, 0.9, -0.1}, {0.1, 1.1, 0.1}, 1);  // seen from inside: its back
    const DeviceScene scene = test::on_device(world);
    for (const Vpl& light : test::place_lights(scene, {.vpls = 50}, GetParam()).lights) {
        EXPECT_TRUE(std::isfinite(light.flux.x));
        EXPECT_GE(light.flux.x, 0.0f);
    }
}

}  // namespace
}  // namespace clgi
