// Leaves at the vertices of fine meshes: which get them, what they hold, and what they block.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "antiradiance/leaf_vertices.hpp"
#include "antiradiance/solid_angle.hpp"
#include "links_checks.hpp"
#include "spheres.hpp"

namespace clgi {
namespace {

constexpr double pi = 3.14159265358979323846;

// What holds for any tree with leaves at vertices. Returns how many it has.
std::size_t expect_consistent(const ElementTree& tree, bool joined = false) {
    if (tree.first_thirds.empty()) return 0;
    EXPECT_EQ(tree.first_thirds.size(), tree.count() + 1);
    EXPECT_EQ(tree.first_thirds.back(), tree.thirds.size());
    std::size_t found = 0;
    std::set<std::array<std::uint32_t, 3>> used;  // triangle, corner, side
    for (std::size_t i = 0; i < tree.count(); ++i) {
        SCOPED_TRACE(i);
        double farthest = 0.0;
        for (std::size_t k = i; k < tree.ends[i]; ++k)
            for (std::uint32_t t = tree.first_thirds[k]; t < tree.first_thirds[k + 1]; ++t) {
                const auto& p = tree.thirds[t].corners;
                for (const glm::dvec3& at :
                     {p[0], 0.5 * (p[0] + p[1]), 0.5 * (p[0] + p[2]), (p[0] + p[1] + p[2]) / 3.0})
                    farthest = std::max(farthest, glm::length(at - tree.positions[i]));
            }
        EXPECT_LE(farthest, tree.radii[i] * (1 + 1e-12));
        if (!tree.is_vertex(i)) continue;
        ++found;
        EXPECT_TRUE(tree.is_leaf(i) && !tree.is_patch(i) && tree.is_flat(i));
        EXPECT_NEAR(farthest, tree.radii[i], 1e-12 * farthest);
        glm::dvec3 across(0.0);
        double area = 0.0;
        for (std::uint32_t t = tree.first_thirds[i]; t < tree.first_thirds[i + 1]; ++t) {
            const VertexThird& third = tree.thirds[t];
            EXPECT_TRUE(used.insert({third.triangle, third.corner, tree.backs[i]}).second);
            if (!joined) {
                EXPECT_EQ(third.corners[0], tree.thirds[tree.first_thirds[i]].corners[0]);
            }
            const auto& p = third.corners;
            across += glm::cross(p[1] - p[0], p[2] - p[0]) / 6.0;
            area += glm::length(glm::cross(p[1] - p[0], p[2] - p[0])) / 6.0;
        }
        EXPECT_NEAR(tree.areas[i], area, 1e-12 * area);
        EXPECT_LE(glm::length(glm::normalize(across) - tree.normals[i]), 1e-9);
    }
    EXPECT_EQ(used.size(), tree.thirds.size());
    return found;
}

double area_of(const Scene& scene) {
    double sum = 0.0;
    for (const SceneTriangle& t : scene.triangles) {
        const glm::dvec3& a = scene.positions[t.vertex[0]];
        sum += 0.5 * glm::length(glm::cross(scene.positions[t.vertex[1]] - a,
                                            scene.positions[t.vertex[2]] - a));
    }
    return sum;
}

TEST(VertexElements, OfASphereAreItsVertices) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {1, 2, 3}, 0.5, 3, 1);
    const ElementTree tree = make_elements(scene, {.wished = 642});
    EXPECT_EQ(expect_consistent(tree), 642u);
    EXPECT_EQ(tree.leaves, 642u);
    EXPECT_EQ(tree.thirds.size(), 3u * 1280u);
    EXPECT_NEAR(tree.areas[0], area_of(scene), 1e-12 * tree.areas[0]);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        const glm::dvec3 out = tree.thirds[tree.first_thirds[i]].corners[0] - glm::dvec3(1, 2, 3);
        EXPECT_GT(glm::dot(glm::normalize(out), tree.normals[i]), 0.9999);
        // The centroid of the thirds is a little below the vertex.
        EXPECT_LT(glm::length(tree.positions[i] - glm::dvec3(1, 2, 3) - out), 0.005);
        EXPECT_EQ(tree.backs[i], 0);
        EXPECT_LT(tree.triangles[i], 1280u);
    }
    EXPECT_EQ(make_elements(scene, {.wished = 642, .vertices = false}).leaves, 1280u);
}

// Where vertices are more than leaves are wished: whole, small, round and facing one way.
TEST(VertexElements, AreJoinedToTheWishedNumber) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {1, 2, 3}, 0.5, 5, 1);
    for (const std::size_t wished : {100u, 700u, 5000u}) {
        const ElementTree tree = make_elements(scene, {.wished = wished});
        EXPECT_EQ(expect_consistent(tree, true), tree.leaves);
        EXPECT_GT(tree.leaves, wished * 2 / 3);
        EXPECT_LT(tree.leaves, wished * 3 / 2);
        EXPECT_EQ(tree.thirds.size(), 3u * 20480u);
        EXPECT_NEAR(tree.areas[0], area_of(scene), 1e-12 * tree.areas[0]);
        const double mean = tree.areas[0] / static_cast<double>(tree.leaves);
        for (std::size_t i = 0; i < tree.count(); ++i) {
            if (!tree.is_leaf(i)) continue;
            EXPECT_LT(tree.areas[i], 4.0 * mean);
            EXPECT_LT(tree.radii[i], 3.0 * std::sqrt(mean));
            const glm::dvec3 out = tree.positions[i] - glm::dvec3(1, 2, 3);
            EXPECT_GT(glm::dot(glm::normalize(out), tree.normals[i]), 0.99);
        }
    }
}

// What pixels read: a vertex of a joined leaf has the light of the leaves around it, so that light
// that falls linearly over the sphere is smooth across leaves.
TEST(VertexElements, JoinedShareTheirLightWithThoseBeside) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 5, 1);
    const ElementTree tree = make_elements(scene, {.wished = 300});
    std::vector<std::uint32_t> rows;
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) rows.push_back(i);
    const LeafVertices shared = leaf_vertices(tree, rows);
    ASSERT_EQ(shared.of_thirds.size(), tree.thirds.size());
    EXPECT_EQ(shared.first.size(), 10242u + 1u);
    double mixed = 0.0, alone = 0.0;  // squares of differences from the height of the vertex
    for (std::uint32_t row = 0; row < rows.size(); ++row)
        for (std::uint32_t k = tree.first_thirds[rows[row]]; k < tree.first_thirds[rows[row] + 1];
             ++k) {
            const std::uint32_t v = shared.of_thirds[k];
            double sum = 0.0, height = 0.0;
            bool own = false;
            for (std::uint32_t l = shared.first[v]; l < shared.first[v + 1]; ++l) {
                const auto& [leaf, share] = shared.leaves[l];
                EXPECT_GT(share, 0.0f);
                sum += double{share};
                height += double{share} * tree.positions[rows[leaf]].y;
                own |= leaf == row;
            }
            EXPECT_TRUE(own);
            EXPECT_NEAR(sum, 1.0, 1e-6);
            const double wanted = tree.thirds[k].corners[0].y;
            mixed += std::pow(height - wanted, 2);
            alone += std::pow(tree.positions[rows[row]].y - wanted, 2);
        }
    EXPECT_LT(mixed, 0.3 * alone);
}

// Across a sharp crease, between materials and to another piece nothing is joined.
TEST(VertexElements, AreNotJoinedAcrossCreasesAndMaterials) {
    Scene scene = test::plain_scene();
    Material other;
    const std::uint32_t material = test::add_material(scene, other);
    const int n = 24;
    const auto sheet = [&](const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
                           std::uint32_t of) {
        for (int y = 0; y < n; ++y)
            for (int x = 0; x < n; ++x) {
                const auto at = [&](int i, int j) {
                    return corner + (double(i) / n) * u + (double(j) / n) * v;
                };
                test::add_quad(scene, {at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)}, of);
            }
    };
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    sheet({0, 0, 0}, z, x, 0);         // a floor
    sheet({0, 0, 0}, x, y, 0);         // a wall on its edge
    sheet({1, 0, 0}, z, x, material);  // more floor
    sheet({0, 1e-2, 0}, z, x, 0);      // a board above it
    const ElementTree tree = make_elements(scene, {.wished = 400});
    EXPECT_EQ(expect_consistent(tree, true), tree.leaves);
    EXPECT_LT(tree.leaves, 700u);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        const VertexThird& first = tree.thirds[tree.first_thirds[i]];
        for (std::uint32_t t = tree.first_thirds[i]; t < tree.first_thirds[i + 1]; ++t)
            EXPECT_EQ(tree.thirds[t].triangle / (2 * n * n), first.triangle / (2 * n * n)) << i;
    }
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
    EXPECT_EQ(expect_consistent(coarse), 0u);
    EXPECT_EQ(coarse.positions, never.positions);
    EXPECT_EQ(coarse.ends, never.ends);
    EXPECT_EQ(coarse.areas, never.areas);
    // 320 triangles, 162 vertices.
    EXPECT_EQ(make_elements(scene, {.wished = 162}).leaves, 162u);
    EXPECT_EQ(make_elements(scene, {.wished = 163}).leaves, 320u);
    EXPECT_EQ(make_elements(scene, {.wished = 320}).leaves, 320u);
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
    EXPECT_EQ(expect_consistent(tree), 6u * 25u);
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
    EXPECT_EQ(expect_consistent(make_elements(box(1), {.max_area = 10.0})), 0u);
    EXPECT_EQ(make_elements(box(1), {.max_area = 10.0}).leaves, 12u);
}

// The halves of a sphere have materials of their own: a leaf has one of them.
TEST(VertexElements, HaveOneMaterial) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 3, 1);
    test::add_material(scene, scene.materials[0]);
    for (std::size_t t = 0; t < scene.triangles.size() / 2; ++t) scene.triangles[t].material = 1;
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    EXPECT_GT(expect_consistent(tree), 642u);
    for (std::size_t i = 0; i < tree.count(); ++i)
        for (std::uint32_t k = tree.first_thirds[i]; k < tree.first_thirds[i + 1]; ++k)
            EXPECT_EQ(scene.triangles[tree.thirds[k].triangle].material,
                      scene.triangles[tree.triangles[i]].material);
}

TEST(VertexElements, OfOpenSheetsHaveBacks) {
    Scene scene = test::plain_scene();
    test::add_sheet(scene, 8, [](double x, double z) { return 0.1 * std::sin(3 * x + z); });
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    EXPECT_EQ(expect_consistent(tree), 2u * 81u);
    for (std::size_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) {
            EXPECT_EQ(tree.normals[i].y < 0.0, tree.backs[i] != 0);
        }
    EXPECT_NEAR(tree.areas[0], 2.0 * area_of(scene), 1e-12 * tree.areas[0]);
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
    EXPECT_EQ(expect_consistent(make_elements(scene, {.max_area = 1.0, .backs = false})), 50u);

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
    EXPECT_EQ(expect_consistent(make_elements(needle, {.max_area = 100.0})), 0u);
    EXPECT_EQ(make_elements(needle, {.max_area = 100.0}).leaves, 128u);
}

// Beside a coarse sphere, the sender of each link to a small plate is as large as the thirds of its
// triangles are, those that face the other way subtracted.
TEST(VertexElements, CoverWhatTheirOutlineCovers) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 1, 0}, 0.6, 1, 1);
    const auto plate = static_cast<std::uint32_t>(scene.triangles.size());
    test::add_triangle(scene, {0, 0, 0}, {0, 0, 1e-3}, {1e-3, 0, 0});
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    EXPECT_EQ(expect_consistent(tree), 42u);
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
            for (std::uint32_t k = tree.first_thirds[s]; k < tree.first_thirds[s + 1]; ++k) {
                const auto& [a, b, c] = tree.thirds[k].corners;
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
    for (const auto& [wished, vertices] : {std::pair(2562u, true), {1000u, true}, {1000u, false}}) {
        const ElementTree tree = make_elements(scene, {.wished = wished, .vertices = vertices});
        EXPECT_EQ(expect_consistent(tree, true), vertices ? tree.leaves : 0u);
        EXPECT_EQ(tree.leaves == 2562u, wished == 2562u);
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
