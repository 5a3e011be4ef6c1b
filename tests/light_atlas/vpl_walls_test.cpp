// Walls between points of a patch: against brute force, and what belongs to a VPL beside one.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/vpl_layout.hpp>
#include <cmath>

#include "methods/light_atlas/walls.hpp"
#include "scenes.hpp"
#include "walls.hpp"

namespace clgi {
namespace {

using test::corner;

// On which side of each of the triangle's planes through `from` the direction runs: all alike where
// it meets the triangle.
bool meets(const Scene& scene, std::uint32_t t, const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 a = corner(scene, t, 0) - from, b = corner(scene, t, 1) - from,
                     c = corner(scene, t, 2) - from, way = to - from;
    const glm::dvec3 across = glm::cross(b - a, c - a);
    if (glm::dot(a, across) * glm::dot(a - way, across) > 0.0) return false;
    const double u = glm::dot(way, glm::cross(a, b)), v = glm::dot(way, glm::cross(b, c)),
                 w = glm::dot(way, glm::cross(c, a));
    return (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
}

TEST(VplWalls, AreFoundAsByTryingAll) {
    test::Random random(41);
    for (const double away : {0.0, 1e5}) {
        Scene scene = test::plain_scene();
        const auto point = [&](double size) {
            return glm::dvec3(random(-size, size), random(-size, size), random(-size, size));
        };
        const glm::dvec3 there(away, -away, 0.5 * away);
        for (int i = 0; i < 3000; ++i) {
            const glm::dvec3 at = there + point(1.0);
            const double size = std::pow(10.0, random(-3, -0.5));
            test::add_triangle(scene, at, at + point(size), at + point(size));
        }
        const Walls walls(scene);
        int met = 0, open = 0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 from = there + point(1.2);
            glm::dvec3 to = from + point(i % 2 ? 0.3 : 2.0);
            if (i % 5 == 0) to[i % 3] = from[i % 3];  // along an axis' plane
            const auto counts = [](std::uint32_t t) { return t % 7 != 0; };
            Walls::Met expected;
            for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
                if (!counts(t) || !meets(scene, t, from, to)) continue;
                const glm::dvec3 across = test::normal_of(scene, t);
                const double share =
                    glm::dot(corner(scene, t, 0) - from, across) / glm::dot(to - from, across);
                if (share < expected.share)
                    expected = {share, t, glm::dot(to - from, across) > 0.0};
            }
            const bool any = expected.triangle != no_index;
            EXPECT_EQ(walls.between(from, to, counts), any) << away << ", " << i;
            const Walls::Met nearest = walls.nearest(from, to, counts);
            EXPECT_EQ(nearest.triangle, expected.triangle) << away << ", " << i;
            EXPECT_EQ(nearest.back, expected.back);
            EXPECT_NEAR(nearest.share, expected.share, away > 0.0 ? 1e-6 : 1e-9);
            (any ? met : open)++;
        }
        EXPECT_GT(met, 200);
        EXPECT_GT(open, 300);
    }
}

TEST(VplWalls, OfNothingAreNone) {
    const Scene scene = test::plain_scene();
    EXPECT_FALSE(Walls(scene).between({0, 0, 0}, {1, 1, 1}, [](std::uint32_t) { return true; }));
}

// Nothing passes between triangles that share an edge, not even along a line through it.
TEST(VplWalls, HaveNoGaps) {
    const Scene scene = test::crooked_wall(1.0, 1.0, 20);
    const Walls walls(scene);
    test::Random random(43);
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const double share = random(0, 1);
            const glm::dvec3 at =
                share * corner(scene, t, k) + (1.0 - share) * corner(scene, t, (k + 1) % 3);
            const glm::dvec3 way(random(-1, 1), random(-1, 1), random(0.05, 1));
            EXPECT_TRUE(walls.between(at - 0.3 * way, at + 0.7 * way, [](std::uint32_t) {
                return true;
            })) << t;
        }
}

// A wall of two sides stands on a floor that is not cut below it, and a shelf hangs above.
TEST(VplWalls, KeepSamplesOnTheirSideOfAWall) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::add_quad(scene, {glm::dvec3(0.5, 0.1, -1), {1, 0.1, -1}, {1, 0.1, 1}, {0.5, 0.1, 1}});
    Material both = scene.materials[0];
    both.double_sided = true;
    const double x = 0.13;
    test::add_quad(scene, {glm::dvec3(x, 0, 1), {x, 0, -1}, {x, 0.5, -1}, {x, 0.5, 1}},
                   test::add_material(scene, both));
    for (const bool turned : {false, true}) {
        if (turned) scene.materials[0].double_sided = true;
        const Patches patches = make_patches(scene);
        for (const std::uint32_t n : {60u, 400u, 1600u}) {
            const VplLayout layout = place_vpls(scene, patches, {.count = n});
            const std::vector<glm::dvec3> at = test::positions(scene, layout.vpls);
            const std::vector<glm::dvec3> samples = test::positions(scene, layout.samples);
            std::uint32_t beyond = 0, near = 0;
            for (std::size_t v = 0; v < at.size(); ++v) {
                if (layout.vpls[v].triangle > 1) continue;
                for (std::uint32_t i = 0; i < layout.vpls[v].sample_count; ++i) {
                    const glm::dvec3& p = samples[layout.vpls[v].first_sample + i];
                    beyond += (p.x > x) != (at[v].x > x);
                    near += std::abs(p.x - x) < 0.5 * std::sqrt(layout.area / n);
                }
            }
            EXPECT_EQ(beyond, 0u) << n;
            EXPECT_GT(near, 100u);
        }
    }
}

}  // namespace
}  // namespace clgi
