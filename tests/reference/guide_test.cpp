// Directions that are learnt from what paths met.
// SPDX-License-Identifier: MIT
#include "reference/guide.hpp"

#include <gtest/gtest.h>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "reference/sampled_light.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi::reference {
namespace {

constexpr double pi_ = std::numbers::pi;

glm::vec3 anywhere(Random& random) {
    const float y = 2.0f * random() - 1.0f, angle = 6.2831853f * random();
    const float across = std::sqrt(1.0f - y * y);
    return {across * std::cos(angle), y, across * std::sin(angle)};
}

// Light from around an axis, and a little from everywhere, at places around a middle.
std::vector<Met> lit_from(const glm::vec3& axis, const glm::vec3& middle, int count,
                          std::uint64_t seed) {
    std::vector<Met> out;
    for (int k = 0; k < count; ++k) {
        Random random(seed, 0, static_cast<std::uint64_t>(k));
        const glm::vec3 direction = anywhere(random);
        const bool bright = glm::dot(direction, axis) > 0.9f;
        const glm::vec3 place = middle + 0.3f * anywhere(random);
        out.push_back({place, direction, bright ? 20.0f : 0.1f});
    }
    return out;
}

// The density is that of the directions drawn, its integral 1, and most of it where light is.
TEST(Guide, DrawsDirectionsByItsDensity) {
    const glm::vec3 axis = glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f));
    const Guide guide(lit_from(axis, {0, 0, 0}, 790, 1));
    const Guide::Cell* cell = guide.at({0.1f, 0.2f, -0.1f});
    ASSERT_TRUE(cell);
    // What is drawn of two functions over their values at even directions.
    const auto value = [](const glm::vec3& d) { return glm::dvec2(1.0 + d.x * d.y, d.z * d.z); };
    constexpr int count = 200000;
    glm::dvec2 drawn(0.0), even(0.0);
    double integral = 0.0, near = 0.0;
    for (int k = 0; k < count; ++k) {
        Random random(7, 1, static_cast<std::uint64_t>(k));
        const glm::vec3 direction = cell->sample(random);
        EXPECT_NEAR(glm::length(direction), 1.0, 1e-5);
        ASSERT_GT(cell->density(direction), 0.0f);
        drawn += value(direction) / double{count};
        near += glm::dot(direction, axis) > 0.85f ? 1.0 / count : 0.0;
        const glm::vec3 other = anywhere(random);
        even += value(other) * (double{cell->density(other)} * 4.0 * pi_ / count);
        integral += double{cell->density(other)} * 4.0 * pi_ / count;
    }
    EXPECT_NEAR(integral, 1.0, 0.02);
    EXPECT_NEAR(drawn.x, even.x, 0.02 * even.x);
    EXPECT_NEAR(drawn.y, even.y, 0.02 * even.y);
    EXPECT_GT(near, 0.8);  // 20 of a twentieth against 0.1 of the rest: 0.91, with wide bins
}

// The mean around an axis, per steradian.
double around(const Guide::Cell& cell, const glm::vec3& axis) {
    double sum = 0.0;
    int count = 0;
    Random random(11, 0, 0);
    while (count < 1000) {
        const glm::vec3 direction = anywhere(random);
        if (glm::dot(direction, axis) < 0.92f) continue;
        sum += double{cell.density(direction)};
        ++count;
    }
    return sum / count;
}

// Each part of the scene has its own light.
TEST(Guide, KnowsPlaces) {
    const glm::vec3 up(0, 1, 0), aside(1, 0, 0);
    std::vector<Met> met = lit_from(up, {-2, 0, 0}, 5000, 2);
    const std::vector<Met> other = lit_from(aside, {2, 1, 0}, 5000, 3);
    met.insert(met.end(), other.begin(), other.end());
    const Guide guide(std::move(met));
    for (const float at : {-0.2f, 0.0f, 0.2f}) {
        const Guide::Cell* left = guide.at({-2 + at, at, -at});
        const Guide::Cell* right = guide.at({2 + at, 1 - at, at});
        ASSERT_TRUE(left && right);
        EXPECT_GT(around(*left, up), 50.0 * around(*left, aside));
        EXPECT_GT(around(*right, aside), 50.0 * around(*right, up));
    }
}

// Too little to learn from, places that are all the same, light that is none or not finite.
TEST(Guide, LearnsFromWhatThereIs) {
    EXPECT_FALSE(Guide({}).at({0, 0, 0}));
    EXPECT_FALSE(Guide(lit_from({0, 1, 0}, {0, 0, 0}, 399, 4)).at({0, 0, 0}));
    std::vector<Met> met = lit_from({0, 1, 0}, {0, 0, 0}, 5000, 5);
    for (Met& one : met) one.place = {1, 2, 3};
    EXPECT_TRUE(Guide(met).at({9, 9, 9}));
    for (std::size_t k = 0; k < met.size(); ++k)
        met[k].light = k % 3 == 0   ? 0.0f
                       : k % 3 == 1 ? -1.0f
                                    : std::numeric_limits<float>::infinity();
    EXPECT_FALSE(Guide(met).at({1, 2, 3}));
}

// A room with a window and a glossy floor, under an even or an uneven sky, or with a lamp behind a
// screen: with a guide the same light, and less noise of what comes through the window.
struct Room {
    explicit Room(int lit) {
        test::add_box(scene, {0, 0, 0}, {4, 3, 4}, -1);
        Material glossy;
        glossy.base_color = {0.3f, 0.5f, 0.7f, 1.0f};
        glossy.metallic = 0.5f;
        glossy.roughness = 0.4f;
        glossy.specular = 1.0f;
        const std::uint32_t floor = test::add_material(scene, glossy);
        test::add_quad(scene, {{{0, 0.1, 0}, {0, 0.1, 4}, {4, 0.2, 4}, {4, 0.2, 0}}}, floor);
        if (lit == 2) {
            Material lamp;
            lamp.emission = {9.0f, 5.0f, 2.0f};
            test::add_quad(scene, {{{0.1, 2, 1}, {0.1, 2.5, 1}, {0.1, 2.5, 2}, {0.1, 2, 2}}},
                           test::add_material(scene, lamp));
            test::add_quad(scene,
                           {{{0.3, 1.5, 0.5}, {0.3, 2.8, 0.5}, {0.3, 2.8, 2.5}, {0.3, 1.5, 2.5}}});
            return;
        }
        // All of a wall goes, and most of it comes back.
        std::erase_if(scene.triangles, [&](const SceneTriangle& triangle) {
            for (const std::uint32_t vertex : triangle.vertex)
                if (scene.positions[vertex].x > 0.01) return false;
            return true;
        });
        test::add_quad(scene, {{{0, 0, 0}, {0, 2, 0}, {0, 2, 4}, {0, 0, 4}}});
        test::add_quad(scene, {{{0, 2, 0}, {0, 3, 0}, {0, 3, 3}, {0, 2, 3}}});
        scene.environment = test::gradient_sky();
        if (lit == 0) {
            scene.environment->texels.clear();
            scene.environment->width = scene.environment->height = 0;
            scene.environment->factor = {1.0f, 1.2f, 1.5f};
        }
    }
    Scene scene = test::plain_scene({0.8f, 0.6f, 0.4f});
    Camera camera = test::camera_at({0.5, 1.5, 2.0}, {4, 0.8, 1.5});
};

TEST(Guide, LeavesLightAsItIs) {
    constexpr int width = 4, height = 3, samples = 5000;
    for (const int lit : {0, 1, 2}) {
        const Room room(lit);
        const Geometry geometry(room.scene);
        const Tracer tracer(geometry);
        const Lights lights(room.scene, geometry);
        const Sky sky(room.scene.environment);
        Paths paths(geometry, tracer, lights, sky, Options());
        const PixelLight light(geometry, tracer, paths, room.camera, width, height, Filter::box);
        std::vector<Met> met;
        std::array<glm::dvec3, 2> mean{}, square{};
        std::optional<Guide> guide;
        for (const int guided : {0, 1}) {
            if (guided == 1) paths.follow(&guide.emplace(std::move(met)));
            for (std::size_t pixel = 0; pixel < width * height; ++pixel)
                for (int k = 0; k < samples; ++k) {
                    Random random(5 + guided, pixel, static_cast<std::uint64_t>(k));
                    const glm::dvec3 found(light(pixel, random, guided == 0 ? &met : nullptr));
                    mean[guided] += found / double{width * height * samples};
                    square[guided] += found * found / double{width * height * samples};
                }
        }
        for (int c = 0; c < 3; ++c) {
            const auto variance = [&](int k) { return square[k][c] - mean[k][c] * mean[k][c]; };
            const double slack =
                std::sqrt((variance(0) + variance(1)) / double{width * height * samples});
            EXPECT_NEAR(mean[0][c], mean[1][c], 4.0 * slack) << lit << ' ' << c;
            if (lit == 2) continue;  // every surface asks the lamp: there is little to learn
            EXPECT_LT(variance(1), (c == 0 ? 0.9 : 0.6) * variance(0)) << lit << ' ' << c;
        }
    }
}

}  // namespace
}  // namespace clgi::reference
