// What must not change a result: how the scene is turned, and in which order its triangles,
// vertices and lights are listed.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "frames.hpp"
#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Receiver;

constexpr double half_ulp = 0x1p-24;  // half the spacing of floats at 1

// The 24 rotations that take axes to axes: they move coordinates about and change no digit.
std::vector<glm::mat3> quarter_turns() {
    std::vector<glm::mat3> out;
    const glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int x = 0; x < 6; ++x)
        for (int y = 0; y < 6; ++y) {
            if (x / 2 == y / 2) continue;
            const glm::vec3 right = axes[x / 2] * (x % 2 ? -1.0f : 1.0f);
            const glm::vec3 up = axes[y / 2] * (y % 2 ? -1.0f : 1.0f);
            out.emplace_back(right, up, glm::cross(right, up));
        }
    return out;
}

Camera turned(Camera camera, const glm::mat3& turn) {
    camera.position = glm::dmat3(turn) * camera.position;
    camera.right = turn * camera.right;
    camera.up = turn * camera.up;
    camera.forward = turn * camera.forward;
    return camera;
}

Scene turned(Scene scene, const glm::mat3& turn) {
    for (glm::dvec3& position : scene.positions) position = glm::dmat3(turn) * position;
    for (glm::vec3& normal : scene.normals) normal = turn * normal;
    for (Light& light : scene.lights) {
        light.position = glm::dmat3(turn) * light.position;
        light.direction = turn * light.direction;
    }
    for (Camera& camera : scene.cameras) camera = turned(camera, turn);
    return scene;
}

template <typename T>
std::vector<T> arranged(const std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    std::vector<T> out;
    for (const std::uint32_t index : order) out.push_back(values[index]);
    return out;
}

std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    test::Random random(seed);
    for (std::size_t i = count; i > 1; --i)
        std::swap(order[i - 1], order[random.integer(0, static_cast<int>(i) - 1)]);
    return order;
}

// triangles[i] says which triangle comes i-th.
Scene with_triangles(Scene scene, const std::vector<std::uint32_t>& triangles) {
    scene.triangles = arranged(scene.triangles, triangles);
    return scene;
}

Scene with_vertices(Scene scene, const std::vector<std::uint32_t>& vertices) {
    std::vector<std::uint32_t> place(vertices.size());
    for (std::uint32_t i = 0; i < vertices.size(); ++i) place[vertices[i]] = i;
    scene.positions = arranged(scene.positions, vertices);
    scene.normals = arranged(scene.normals, vertices);
    for (SceneTriangle& triangle : scene.triangles)
        for (std::uint32_t& vertex : triangle.vertex) vertex = place[vertex];
    return scene;
}

// A box around random triangles, none of which lie in one plane.
Scene heap() {
    test::Random random(8);
    Scene scene = test::plain_scene();
    test::add_box(scene, glm::dvec3(-1), glm::dvec3(1), -1);
    for (int t = 0; t < 80; ++t) {
        glm::dvec3 corner[3];
        const glm::dvec3 at(random(-0.8, 0.8), random(-0.8, 0.8), random(-0.8, 0.8));
        for (glm::dvec3& c : corner)
            c = at + glm::dvec3(random(-0.2, 0.2), random(-0.2, 0.2), random(-0.2, 0.2));
        test::add_triangle(scene, corner[0], corner[1], corner[2]);
    }
    scene.lights = {test::spot_light({0.3, 0.9, 0.2}, {-0.2f, -1, -0.3f}, 0.7)};
    scene.cameras = {test::camera_at({0, 0, 0.95}, {0, 0, -1}, 1.2f)};
    return scene;
}

// How far rounding may move the point where a pixel's ray meets its triangle, to first order:
//   b1 = e2.(d x t) / det, b2 = e1.(d x t) / det, det = d.(e1 x e2), t from corner to eye
// Each triple product is off by 6 half_ulp of its factors' lengths at most (a product, two sums,
// twice), and the result moves by e1 db1 + e2 db2; the differences and the last sum add half_ulp of
// the scene.
double rounding(const Scene& scene, const SceneFrame& frame, int triangle, const glm::dvec3& eye,
                const glm::dvec3& seen) {
    const SceneTriangle& corners = scene.triangles[triangle];
    const glm::dvec3 a(frame.to_local(scene.positions[corners.vertex[0]]));
    const glm::dvec3 e1 = glm::dvec3(frame.to_local(scene.positions[corners.vertex[1]])) - a;
    const glm::dvec3 e2 = glm::dvec3(frame.to_local(scene.positions[corners.vertex[2]])) - a;
    const glm::dvec3 d = glm::normalize(seen - eye);
    const double reach = glm::length(eye - a), l1 = glm::length(e1), l2 = glm::length(e2);
    const double determinant = std::abs(glm::dot(d, glm::cross(e1, e2)));
    return 6 * half_ulp * l1 * l2 * (2 * reach + l1 + l2) / determinant + 6 * half_ulp;
}

TEST(Turned, ShowsTheSameTrianglesAtTheSameDepth) {
    const Scene scene = heap();
    const DeviceScene placed = test::on_device(scene);
    const View view = make_view(scene.cameras[0], placed.frame(), 93, 71);
    const Drawing usual = test::draw(placed, view);
    for (const glm::mat3& turn : quarter_turns()) {
        const Scene other = turned(scene, turn);
        const Drawing drawing = test::draw(other, other.cameras[0], 93, 71);
        for (std::size_t p = 0; p < usual.pixels(); ++p) {
            ASSERT_EQ(drawing.triangle(p), usual.triangle(p)) << p;
            ASSERT_EQ(drawing.visibility[p] >> 32, usual.visibility[p] >> 32) << p;
            const glm::dvec3 before(usual.at(GBUFFER_POSITION, p));
            const glm::dvec3 after(drawing.at(GBUFFER_POSITION, p) * turn);  // turned back
            const double bound =
                rounding(scene, placed.frame(), usual.triangle(p), glm::dvec3(view.eye), before);
            EXPECT_LE(glm::length(after - before), 2 * bound) << p;
            const glm::vec3 normal = drawing.at(GBUFFER_GEOMETRIC, p) * turn;
            EXPECT_EQ(drawing.at(GBUFFER_BASE, p), usual.at(GBUFFER_BASE, p));
            EXPECT_GT(glm::dot(normal, usual.at(GBUFFER_GEOMETRIC, p)), 1 - 16 * half_ulp);
        }
    }
}

TEST(Turned, GathersTheSame) {
    test::Random random(21);
    const auto direction = [&] {
        return glm::normalize(glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)) +
                              glm::vec3(0, 1e-6f, 0));
    };
    std::vector<Vpl> lights;
    std::vector<Receiver> receivers;
    for (int i = 0; i < 64; ++i) {
        lights.push_back(
            {glm::vec4(direction() * 0.5f, 1e-3f), glm::vec4(direction(), 1e-6f), glm::vec4(1.0f)});
        receivers.push_back({direction() * 0.4f, direction()});
    }
    const auto usual = test::gather(receivers, lights, {});
    for (const glm::mat3& turn : quarter_turns()) {
        std::vector<Vpl> lights_there = lights;
        for (Vpl& light : lights_there) {
            light.position = glm::vec4(turn * glm::vec3(light.position), light.position.w);
            light.normal = glm::vec4(turn * glm::vec3(light.normal), light.normal.w);
        }
        std::vector<Receiver> receivers_there = receivers;
        for (Receiver& receiver : receivers_there)
            receiver = {turn * receiver.position, turn * receiver.normal};
        const auto found = test::gather(receivers_there, lights_there, {});
        for (std::size_t r = 0; r < receivers.size(); ++r) {
            double condition = 0.0;  // the sum if no cosine were less than 1
            for (const Vpl& light : lights) {
                const glm::dvec3 t = glm::dvec3(light.position) - glm::dvec3(receivers[r].position);
                const double square = glm::dot(t, t), radius2 = light.position.w;
                condition += (square + radius2) / std::numbers::pi /
                             (square * (square + radius2) + radius2 * radius2);
            }
            // 16 roundings a term and one for each of 63 additions, in either picture.
            EXPECT_NEAR(found[r].x, usual[r].x, 2 * (16 + 63) * half_ulp * condition);
        }
    }
}

// (2 rho I / 5 h^2)(1 - cos^5 a), whichever way is down: Halton points stand still in the world, so
// other ones make the sum.
TEST(Turned, LightsASpotsOwnPlaceAsTheIntegralSays) {
    const double angle = std::numbers::pi / 6, wanted = 0.2 * (1 - std::pow(std::cos(angle), 5));
    Scene world = test::plain_scene();
    test::add_floor(world, 12.0);
    world.lights = {test::spot_light({0, 1, 0}, {0, -1, 0}, angle)};
    std::vector<glm::mat3> turns = quarter_turns();
    turns.push_back(glm::mat3(2, -1, 2, 2, 2, -1, -1, 2, 2) / 3.0f);  // off every axis
    for (const glm::mat3& turn : turns) {
        const DeviceScene scene = test::on_device(turned(world, turn));
        const auto placed = test::place_lights(scene, {.vpls = 10000, .shadow_size = 256});
        // As in tests/shading/lights_test.cpp: corners at 1/256 pixel, and the sum of 10,000
        // points.
        EXPECT_NEAR(test::lux_at(scene, placed.lights, glm::dmat3(turn) * glm::dvec3(0, 1, 0),
                                 turn * glm::vec3(0, -1, 0)),
                    wanted, 0.005 * wanted)
            << turn[1].x << " " << turn[1].y << " " << turn[1].z;
    }
}

CLGI_IN_ALL_MODES(Reordered);

SecondOrderOptions odd_frame() {
    SecondOrderOptions options;
    options.build = test::usual_build();
    options.width = 47;
    options.height = 35;
    options.emitters = {.vpls = 100, .shadow_size = 128, .face_size = 64};
    options.negative_vpls = 50;
    return options;
}

TEST_P(Reordered, TrianglesAndVerticesGiveTheSamePictureBitForBit) {
    const Scene scene = heap();
    const auto render = [&](const Scene& other) {
        return test::render(other, other.cameras[0], odd_frame());
    };
    const test::Frame usual = render(scene);
    for (const Scene& other :
         {with_triangles(scene, shuffled(scene.triangles.size(), 1)),
          with_triangles(with_vertices(scene, shuffled(scene.positions.size(), 3)),
                         shuffled(scene.triangles.size(), 4))}) {
        const test::Frame frame = render(other);
        EXPECT_TRUE(test::same_bits(frame.radiance, usual.radiance));
        EXPECT_TRUE(test::same_bits(frame.lights, usual.lights));
        EXPECT_TRUE(test::same_bits(frame.negative, usual.negative));
    }
}

// The same triangle from another corner: another corner's rounding inside, the same pixels.
TEST_P(Reordered, CornersCoverTheSamePixels) {
    const Scene scene = heap();
    const DeviceScene placed = test::on_device(scene);
    const View view = make_view(scene.cameras[0], placed.frame(), 93, 71);
    const Drawing usual = test::draw(placed, view);
    Scene other = scene;
    for (SceneTriangle& triangle : other.triangles)
        triangle = {{triangle.vertex[1], triangle.vertex[2], triangle.vertex[0]},
                    triangle.material};
    const Drawing drawing = test::draw(other, scene.cameras[0], 93, 71);
    for (std::size_t p = 0; p < usual.pixels(); ++p) {
        // No two of these surfaces cross so close to a pixel's centre that rounding would choose.
        ASSERT_EQ(drawing.triangle(p), usual.triangle(p)) << p;
        const glm::dvec3 before(usual.at(GBUFFER_POSITION, p));
        const glm::dvec3 after(drawing.at(GBUFFER_POSITION, p));
        const double bound =
            rounding(scene, placed.frame(), usual.triangle(p), glm::dvec3(view.eye), before);
        EXPECT_LE(glm::length(after - before), 2 * bound) << p;
    }
}

TEST_P(Reordered, LightsGiveTheSameLightsAndTheSameSum) {
    Scene scene = heap();
    scene.lights.push_back(test::point_light({-0.4, 0.7, 0.3}, 0.37f));
    scene.lights.push_back(test::directional_light({0.2f, -1, 0.1f}, 0.83f));
    scene.lights.push_back(test::spot_light({0.5, 0.5, 0.6}, {-1, -0.4f, -1}, 0.5, 2.1f));
    SecondOrderOptions options = odd_frame();
    options.negative_vpls = 0;  // a direction is no sum: its own rounding is not bounded here
    options.low_resolution_step = 1;
    const test::Frame usual = test::render(scene, scene.cameras[0], options);
    std::swap(scene.lights[0], scene.lights[2]);
    std::swap(scene.lights[1], scene.lights[3]);
    const test::Frame other = test::render(scene, scene.cameras[0], options);

    const auto sorted = [](std::vector<Vpl> lights) {
        std::sort(lights.begin(), lights.end(),
                  [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) < 0; });
        return lights;
    };
    EXPECT_FALSE(test::same_bits(usual.lights, other.lights));
    EXPECT_TRUE(test::same_bits(sorted(usual.lights), sorted(other.lights)));
    // Nothing is taken away, so each of n additions is half_ulp of the sum off at most; then a
    // handful of products.
    const double additions = options.emitters.vpls + 4 + 8;
    for (std::size_t p = 0; p < usual.pixels; ++p)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(other.radiance[p][c], usual.radiance[p][c],
                        2 * (additions * half_ulp + test::half_error()) * usual.radiance[p][c]);
}

}  // namespace
}  // namespace clgi
