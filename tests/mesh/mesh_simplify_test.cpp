// Coarse meshes: how many triangles, how far from the fine mesh, closed or open as it was.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <clgi/mesh/simplify.hpp>
#include <cmath>
#include <limits>

#include "mask_tools.hpp"

namespace clgi {
namespace {

using mesh::simplify;

// Every triangle has vertices of its own, as if all edges were seams.
Scene seams_everywhere(const std::vector<test::Triangle>& triangles) {
    Scene scene = test::plain_scene();
    for (const test::Triangle& t : triangles) test::add_triangle(scene, t[0], t[1], t[2]);
    return scene;
}

Scene sheet(int n, double height) {
    std::vector<test::Triangle> out;
    const auto at = [&](int i, int j) {
        const double x = static_cast<double>(i) / n, y = static_cast<double>(j) / n;
        return glm::dvec3(x, y, height * std::sin(7 * x + 2 * y));
    };
    for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
            out.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            out.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    return seams_everywhere(out);
}

Adjacency adjacency_of(const Scene& scene, const std::vector<glm::uvec3>& triangles) {
    std::vector<SceneTriangle> list;
    for (const glm::uvec3& t : triangles) list.push_back({{t.x, t.y, t.z}, 0});
    return adjacency(scene.positions, list);
}

glm::dvec3 area_vector(const Scene& scene, const glm::uvec3& t) {
    return 0.5 * glm::cross(scene.positions[t.y] - scene.positions[t.x],
                            scene.positions[t.z] - scene.positions[t.x]);
}

// Points all over a triangle.
std::vector<glm::dvec3> points_of(const Scene& scene, const glm::uvec3& t) {
    std::vector<glm::dvec3> out;
    for (double i = 0; i <= 8; ++i)
        for (double j = 0; i + j <= 8; ++j)
            out.push_back((i * scene.positions[t.x] + j * scene.positions[t.y] +
                           (8 - i - j) * scene.positions[t.z]) /
                          8.0);
    return out;
}

// N equal triangles on a unit sphere have their middles 8 pi / (3 sqrt(3) N) below it; those of a
// coarse mesh are unequal, four times as deep at most. Each faces outward.
TEST(MeshSimplify, KeepsASphereClosedAndNearItself) {
    for (const double scale : {1.0, 1e-9, 1e9}) {
        const Scene scene = seams_everywhere(test::placed(test::icosphere(4), scale, {}));
        for (const std::size_t wanted : {1280u, 320u, 80u, 20u}) {
            const auto coarse = simplify(scene, wanted);
            EXPECT_LE(coarse.size(), wanted);
            EXPECT_GE(coarse.size(), wanted - std::max<std::size_t>(2, wanted / 100)) << wanted;
            EXPECT_TRUE(adjacency_of(scene, coarse).closed()) << wanted;
            double deepest = 0.0, facing = 1.0;
            for (const glm::uvec3& t : coarse) {
                for (const glm::dvec3& p : points_of(scene, t))
                    deepest = std::max(deepest, 1.0 - glm::length(p) / scale);
                const glm::dvec3 middle =
                    scene.positions[t.x] + scene.positions[t.y] + scene.positions[t.z];
                facing = std::min(facing, glm::dot(glm::normalize(area_vector(scene, t)),
                                                   glm::normalize(middle)));
            }
            const double pi = 3.14159265358979;
            EXPECT_LT(deepest, 4.0 * 8.0 * pi / (3.0 * std::sqrt(3.0) * wanted)) << wanted;
            EXPECT_GT(facing, 0.5) << wanted;
        }
    }
}

TEST(MeshSimplify, GivesEveryPieceItsShare) {
    std::vector<test::Triangle> all = test::icosphere(3);  // 1280 and 320 triangles
    for (const test::Triangle& t : test::placed(test::icosphere(2), 0.1, {5, 0, 0}))
        all.push_back(t);
    const Scene scene = seams_everywhere(all);
    const auto coarse = simplify(scene, 200);
    const auto small = std::count_if(coarse.begin(), coarse.end(), [&](const glm::uvec3& t) {
        return scene.positions[t.x].x > 3.0;
    });
    EXPECT_NEAR(static_cast<double>(small), 40.0, 2.0);
    EXPECT_NEAR(static_cast<double>(coarse.size()), 200.0, 4.0);
    EXPECT_EQ(adjacency_of(scene, coarse).piece_count, 2u);
    EXPECT_TRUE(adjacency_of(scene, coarse).closed());
}

// Above its square the sheet is a function: seen from above, what is left covers the square once.
TEST(MeshSimplify, KeepsTheBorderOfASheet) {
    for (const double height : {0.0, 0.1}) {
        const Scene scene = sheet(24, height);
        for (const std::size_t wanted : {400u, 100u}) {
            const auto coarse = simplify(scene, wanted);
            EXPECT_LE(coarse.size(), wanted);
            EXPECT_GE(coarse.size(), wanted - 4);  // flat ones at the border are left out
            double area = 0.0;
            for (const glm::uvec3& t : coarse) {
                EXPECT_GT(area_vector(scene, t).z, -1e-16);  // upright at the border
                area += area_vector(scene, t).z;
            }
            EXPECT_NEAR(area, 1.0, 1e-12) << height << " " << wanted;
        }
    }
}

// The height of a wave with 100 triangles: its curvature is 0.1 (7^2 + 2^2) = 5.3 at most, and a
// chord of length h misses it by h^2 / 8 of that; three times the side of an equal share.
TEST(MeshSimplify, StaysNearASheet) {
    const Scene scene = sheet(24, 0.1);
    const auto coarse = simplify(scene, 100);
    const double side = 3.0 * std::sqrt(2.0 / 100.0);
    double worst = 0.0;
    for (const glm::uvec3& t : coarse)
        for (const glm::dvec3& p : points_of(scene, t))
            worst = std::max(worst, std::abs(p.z - 0.1 * std::sin(7 * p.x + 2 * p.y)));
    EXPECT_LT(worst, 5.3 * side * side / 8.0);
    EXPECT_LT(worst, 0.05);  // a fourth of the wave
}

TEST(MeshSimplify, KeepsWhatIsSmallerThanTheTarget) {
    const Scene scene = seams_everywhere(test::icosphere(1));
    const Adjacency fine = adjacency(scene);
    for (const std::size_t wanted : {80u, 81u, 100000u}) {
        const auto same = simplify(scene, wanted);
        ASSERT_EQ(same.size(), 80u);
        for (std::size_t t = 0; t < 80; ++t)
            for (int k = 0; k < 3; ++k)
                EXPECT_EQ(fine.welded[same[t][k]], fine.welded[scene.triangles[t].vertex[k]]);
    }
}

// Of nothing nothing; of a piece never less than a tetrahedron; points and lines vanish, and
// vertices without triangles are never named.
TEST(MeshSimplify, OfFewOrNoTriangles) {
    EXPECT_TRUE(simplify(test::plain_scene(), 100).empty());
    const Scene ball = seams_everywhere(test::icosphere(2));
    const auto least = simplify(ball, 0);
    EXPECT_GE(least.size(), 4u);
    EXPECT_LE(least.size(), 20u);
    EXPECT_TRUE(adjacency_of(ball, least).closed());

    Scene scene = test::plain_scene();
    scene.positions.emplace_back(0.0, 0.0, 0.0);  // the same place as a corner below
    scene.normals.emplace_back(0, 0, 1);
    test::add_triangle(scene, {0, 0, 0}, {0, 0, 0}, {1, 0, 0});
    test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {2, 0, 0});
    test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const auto kept = simplify(scene, 100);
    ASSERT_EQ(kept.size(), 1u);
    for (int k = 0; k < 3; ++k) EXPECT_GT(kept[0][k], 0u);
    EXPECT_EQ(area_vector(scene, kept[0]), glm::dvec3(0, 0, 0.5));

    scene.positions[3].y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(simplify(scene, 1), InputError);
}

}  // namespace
}  // namespace clgi
