// Leaves at the vertices of fine meshes: which get them, what they hold, and what they block.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "lab/scenes/rooms.hpp"
#include "links_checks.hpp"
#include "methods/antiradiance/solid_angle.hpp"
#include "spheres.hpp"
#include "vertex_leaves.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

TEST(VertexElements, OfASphereAreItsVertices) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {1, 2, 3}, 0.5, 3, 1);
    const ElementTree tree = make_elements(scene, {.requested = 642});
    EXPECT_EQ(test::expect_consistent(tree), 642u);
    EXPECT_EQ(tree.leaves, 642u);
    EXPECT_EQ(tree.vertex_patches.size(), 3u * 1280u);
    EXPECT_NEAR(tree.areas[0], test::area_of(scene), 1e-12 * tree.areas[0]);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        const glm::dvec3 out =
            tree.vertex_patches[tree.first_patches[i]].corners[0] - glm::dvec3(1, 2, 3);
        EXPECT_GT(glm::dot(glm::normalize(out), tree.normals[i]), 0.9999);
        // The centroid of the vertex patches is a little below the vertex.
        EXPECT_LT(glm::length(tree.positions[i] - glm::dvec3(1, 2, 3) - out), 0.005);
        EXPECT_EQ(tree.backs[i], 0);
        EXPECT_LT(tree.triangles[i], 1280u);
    }
    EXPECT_EQ(make_elements(scene, {.requested = 642, .vertices = false}).leaves, 1280u);
}

// No leaf is larger than it would be without them; pieces of coarser triangles are as they were.
TEST(VertexElements, AreNeverCoarserThanWished) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 2, 1);
    double most = 0.0;
    const ElementTree vertices = make_elements(scene, {.max_area = 1.0});
    EXPECT_EQ(vertices.leaves, 162u);
    for (std::size_t i = 0; i < vertices.count(); ++i)
        if (vertices.is_leaf(i)) most = std::max(most, vertices.areas[i]);
    EXPECT_EQ(make_elements(scene, {.max_area = 1.001 * most}).leaves, 162u);
    const ElementTree coarse = make_elements(scene, {.max_area = 0.999 * most});
    const ElementTree never = make_elements(scene, {.max_area = 0.999 * most, .vertices = false});
    EXPECT_EQ(test::expect_consistent(coarse), 0u);
    EXPECT_EQ(coarse.positions, never.positions);
    EXPECT_EQ(coarse.ends, never.ends);
    EXPECT_EQ(coarse.areas, never.areas);
    // 320 triangles, 162 vertices.
    EXPECT_EQ(make_elements(scene, {.requested = 162}).leaves, 162u);
    EXPECT_EQ(make_elements(scene, {.requested = 163}).leaves, 320u);
    EXPECT_EQ(make_elements(scene, {.requested = 320}).leaves, 320u);
}

// A box of n x n squares on each side: its edges stay sharp. Few squares make no fewer leaves.
TEST(VertexElements, KeepCreasesSharp) {
    const auto box = [](int n) {
        Scene scene = test::plain_scene();
        for (int x = 0; x < n; ++x)
            for (int z = 0; z < n; ++z)
                for (int axis = 0; axis < 3; ++axis)
                    for (const double side : {0.0, 1.0}) {
                        std::array<glm::dvec3, 4> p;
                        for (int k = 0; k < 4; ++k) {
                            p[k][axis] = side;
                            p[k][(axis + 1) % 3] = (x + (k == 1 || k == 2 ? 1.0 : 0.0)) / n;
                            p[k][(axis + 2) % 3] = (z + (k >= 2 ? 1.0 : 0.0)) / n;
                        }
                        if (side == 0.0) std::swap(p[1], p[3]);
                        test::add_quad(scene, p);
                    }
        return scene;
    };
    const ElementTree tree = make_elements(box(4), {.max_area = 1.0});
    EXPECT_EQ(test::expect_consistent(tree), 6u * 25u);
    EXPECT_NEAR(tree.areas[0], 6.0, 1e-12);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        const glm::dvec3 n = glm::abs(tree.normals[i]);
        EXPECT_EQ(n.x + n.y + n.z, 1.0);
        // Beside the edge, within its own face.
        const glm::dvec3 from = tree.positions[i] - glm::dvec3(0.5);
        EXPECT_NEAR(glm::dot(from, tree.normals[i]), 0.5, 1e-12);
        EXPECT_LT(std::max({std::abs(from.x * (1 - n.x)), std::abs(from.y * (1 - n.y)),
                            std::abs(from.z * (1 - n.z))}),
                  0.499);
    }
    EXPECT_EQ(test::expect_consistent(make_elements(box(1), {.max_area = 10.0})), 0u);
    EXPECT_EQ(make_elements(box(1), {.max_area = 10.0}).leaves, 12u);
}

// The halves of a sphere have materials of their own: a leaf has one of them.
TEST(VertexElements, HaveOneMaterial) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 3, 1);
    test::add_material(scene, scene.materials[0]);
    for (std::size_t t = 0; t < scene.triangles.size() / 2; ++t) scene.triangles[t].material = 1;
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    EXPECT_GT(test::expect_consistent(tree), 642u);
    for (std::size_t i = 0; i < tree.count(); ++i)
        for (std::uint32_t k = tree.first_patches[i]; k < tree.first_patches[i + 1]; ++k)
            EXPECT_EQ(scene.triangles[tree.vertex_patches[k].triangle].material,
                      scene.triangles[tree.triangles[i]].material);
}

TEST(VertexElements, OfOpenSheetsHaveBacks) {
    Scene scene = test::plain_scene();
    test::add_sheet(scene, 8, [](double x, double z) { return 0.1 * std::sin(3 * x + z); });
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    EXPECT_EQ(test::expect_consistent(tree), 2u * 81u);
    for (std::size_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) {
            EXPECT_EQ(tree.normals[i].y < 0.0, tree.backs[i] != 0);
        }
    EXPECT_NEAR(tree.areas[0], 2.0 * test::area_of(scene), 1e-12 * tree.areas[0]);
    EXPECT_EQ(make_elements(scene, {.max_area = 1.0, .backs = false}).leaves, 81u);
}

// Two sheets that touch at a corner; a needle, whose tips have no normals.
TEST(VertexElements, LeaveAloneWhatIsNoSurface) {
    Scene scene = test::plain_scene();
    const auto flat = [](double, double) { return 0.0; };
    test::add_sheet(scene, 4, flat);
    const std::size_t first = scene.positions.size();
    test::add_sheet(scene, 4, flat);
    for (std::size_t v = first; v < scene.positions.size(); ++v)
        scene.positions[v] += glm::dvec3(1, 0, 1);
    EXPECT_EQ(test::expect_consistent(make_elements(scene, {.max_area = 1.0, .backs = false})),
              50u);

    Scene needle = test::plain_scene();
    const int sides = 64;
    needle.positions = {{0, 10, 0}, {0, -10, 0}};
    for (int k = 0; k < sides; ++k) {
        const double a = 2.0 * pi * k / sides;
        needle.positions.emplace_back(std::cos(a), 0.0, std::sin(a));
        const auto at = [&](int i) { return static_cast<std::uint32_t>(2 + i % sides); };
        needle.triangles.push_back({{0, at(k + 1), at(k)}, 0});
        needle.triangles.push_back({{1, at(k), at(k + 1)}, 0});
    }
    needle.normals.assign(needle.positions.size(), glm::vec3(0, 1, 0));
    EXPECT_EQ(test::expect_consistent(make_elements(needle, {.max_area = 100.0})), 0u);
    EXPECT_EQ(make_elements(needle, {.max_area = 100.0}).leaves, 128u);
}

// Beside a coarse sphere, the sender of each link to a small plate is as large as the vertex
// patches of its triangles are, those that face the other way subtracted.
TEST(VertexElements, CoverWhatTheirOutlineCovers) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 1, 0}, 0.6, 1, 1);
    const auto plate = static_cast<std::uint32_t>(scene.triangles.size());
    test::add_triangle(scene, {0, 0, 0}, {0, 0, 1e-3}, {1e-3, 0, 0});
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    EXPECT_EQ(test::expect_consistent(tree), 42u);
    const DirectionBins bins = direction_bins(4096);
    const Links links = make_links(tree, bins);
    int mixed = 0, seen = 0;
    for (std::uint32_t i = 0; i < tree.count(); ++i) {
        if (tree.triangles[i] != plate || tree.backs[i]) continue;
        std::vector<double> found(tree.count(), 0.0);
        for (std::uint32_t k = links.first[i]; k < links.first[i + 1]; ++k) {
            const auto bin = static_cast<std::size_t>(links.bins[k]);
            found[links.senders[k]] +=
                double{links.form_factors[k]} * tree.areas[links.senders[k]] *
                std::abs(test::bin_cosine(tree, bins, links.senders[k], links.bins[k])) *
                bins.solid_angles[bin];
        }
        for (std::uint32_t s = 0; s < tree.count(); ++s) {
            if (found[s] == 0.0 || !tree.is_vertex(s)) continue;
            const glm::dvec3 eye = tree.positions[i];
            const double side = glm::dot(tree.normals[s], eye - tree.positions[s]) > 0 ? 1 : -1;
            double wanted = 0.0, away = 0.0;
            for (std::uint32_t k = tree.first_patches[s]; k < tree.first_patches[s + 1]; ++k) {
                const auto& [a, b, c] = tree.vertex_patches[k].corners;
                const glm::dvec3 middle = (a + b + c) / 3.0, b2 = (a + b) / 2.0, c2 = (a + c) / 2.0;
                const double part =
                    solid_angle({a, b2, middle}, eye) + solid_angle({a, middle, c2}, eye);
                const bool faces = side * glm::dot(glm::cross(b - a, c - a), eye - a) > 0.0;
                wanted += faces ? part : -part;
                away += faces ? 0.0 : part;
            }
            EXPECT_NEAR(found[s], wanted, 1e-5 * wanted) << s;
            ++seen;
            mixed += away > 0.0;
        }
    }
    EXPECT_GT(seen, 30);
    EXPECT_GT(mixed, 2);
}

// From within a sphere of radiance 1 all directions above a leaf are bright: not less than between
// faces.
TEST(VertexElements, SeeClosedRooms) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 2.0, 4, -1);
    const DirectionBins bins = direction_bins(512);
    // At vertices, joined ones, and faces.
    for (const auto& [requested, vertices] :
         {std::pair(2562u, true), {1000u, true}, {1000u, false}}) {
        const ElementTree tree =
            make_elements(scene, {.requested = requested, .vertices = vertices});
        EXPECT_EQ(test::expect_consistent(tree, true), vertices ? tree.leaves : 0u);
        EXPECT_EQ(tree.leaves == 2562u, requested == 2562u);
        const Links links = make_links(tree, bins);
        for (const float f : links.form_factors) ASSERT_TRUE(std::isfinite(f) && f > 0.0f);
        const test::Arrived all = test::send_one(tree, bins, links);
        // Bins are a tenth of a radian wide. Measured, with vertices and without: 3.0 % and 2.5 %,
        // 0.84 % and 0.84 %, 0.43 % and 0.46 %.
        EXPECT_LT(all.farthest_solid_angle, 0.04);
        EXPECT_LT(all.farthest_irradiance, 0.012);
        EXPECT_NEAR(all.mean_irradiance / pi, 1.0, 0.006);
    }
}

}  // namespace
}  // namespace clgi
