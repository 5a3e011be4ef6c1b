// The tree of elements: sizes, order, areas and spheres, open sheets, hard inputs.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/advanced/elements.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>

#include "scenes.hpp"

namespace clgi {
namespace {

using test::plain_scene;

// What must hold for any tree.
void expect_consistent(const ElementTree& tree) {
    const std::size_t count = tree.count();
    for (const std::size_t size : {tree.positions.size(), tree.normals.size(), tree.areas.size(),
                                   tree.radii.size(), tree.corners.size(), tree.parents.size(),
                                   tree.levels.size(), tree.triangles.size(), tree.backs.size()})
        ASSERT_EQ(size, count);
    std::size_t leaves = 0;
    for (std::size_t i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        ASSERT_GT(tree.ends[i], i);
        ASSERT_LE(tree.ends[i], count);
        ASSERT_TRUE(std::isfinite(tree.radii[i]));
        EXPECT_GT(tree.areas[i], 0.0);
        const std::uint32_t parent = tree.parents[i];
        EXPECT_EQ(parent == no_index, i == 0);
        if (parent != no_index) {
            ASSERT_LT(parent, i);
            EXPECT_LE(tree.ends[i], tree.ends[parent]);
            EXPECT_EQ(tree.levels[i], tree.levels[parent] + 1);
        }
        if (tree.is_patch(i)) {
            const auto& p = tree.corners[i];
            const glm::dvec3 across = glm::cross(p[1] - p[0], p[2] - p[0]);
            EXPECT_NEAR(0.5 * glm::length(across), tree.areas[i], 1e-9 * tree.areas[i]);
            EXPECT_GT(glm::dot(across, tree.normals[i]), 0.999 * glm::length(across));
        }
        if (tree.is_leaf(i)) {
            EXPECT_TRUE(tree.is_patch(i));
            ++leaves;
            continue;
        }
        double area = 0.0;
        glm::dvec3 moment(0.0);
        int children = 0;
        std::size_t child = i + 1;
        for (; child < tree.ends[i]; child = tree.ends[child], ++children) {
            EXPECT_EQ(tree.parents[child], i);
            if (tree.is_patch(i)) {
                EXPECT_EQ(tree.triangles[child], tree.triangles[i]);
            }
            area += tree.areas[child];
            moment += tree.areas[child] * tree.positions[child];
        }
        EXPECT_EQ(child, tree.ends[i]);
        EXPECT_GE(children, 2);
        EXPECT_LE(children, 4);
        EXPECT_NEAR(area, tree.areas[i], 1e-12 * area);
        EXPECT_LE(glm::length(moment / area - tree.positions[i]), 1e-9 * tree.radii[i] + 1e-12);
        // The sphere holds every leaf below, and one of them touches it.
        double farthest = 0.0;
        for (std::size_t k = i; k < tree.ends[i]; ++k)
            if (tree.is_leaf(k))
                for (const glm::dvec3& corner : tree.corners[k])
                    farthest = std::max(farthest, glm::length(corner - tree.positions[i]));
        EXPECT_NEAR(farthest, tree.radii[i], 1e-12 * farthest);
    }
    EXPECT_EQ(leaves, tree.leaves);
}

Scene cube() {
    Scene scene = plain_scene();
    test::add_box(scene, glm::dvec3(0.0), glm::dvec3(1.0), -1);
    return scene;
}

// Triangles of very different size and shape.
Scene random_triangles(int count) {
    test::Random random(11);
    Scene scene = plain_scene();
    for (int i = 0; i < count; ++i) {
        const double size = std::exp(random(-3.0, 1.0));
        glm::dvec3 p[3];
        const glm::dvec3 at(random(-5, 5), random(-5, 5), random(-5, 5));
        for (glm::dvec3& corner : p)
            corner = at + size * glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1));
        test::add_triangle(scene, p[0], p[1], p[2]);
    }
    return scene;
}

TEST(Elements, OfACubeAreHalvesOfItsTriangles) {
    // Twelve triangles of 0.5 m^2: after three halvings they have 1/16.
    const ElementTree tree = make_elements(cube(), {.max_area = 0.1});
    expect_consistent(tree);
    EXPECT_EQ(tree.leaves, 96u);
    EXPECT_EQ(tree.skipped_triangles, 0u);
    EXPECT_DOUBLE_EQ(tree.areas[0], 6.0);
    EXPECT_LE(glm::length(tree.positions[0] - glm::dvec3(0.5)), 1e-12);
    EXPECT_NEAR(tree.radii[0], std::sqrt(0.75), 1e-12);
    for (std::size_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_leaf(i)) continue;
        EXPECT_DOUBLE_EQ(tree.areas[i], 0.0625);
        EXPECT_LT(glm::dot(tree.normals[i], tree.positions[i] - glm::dvec3(0.5)), -0.4);
        EXPECT_EQ(tree.backs[i], 0);  // the cube is closed
        // Halves of a right-angled triangle with equal legs have its shape.
        EXPECT_NEAR(tree.radii[i], std::sqrt(0.125 * 5.0 / 9.0), 1e-12);
    }
}

TEST(Elements, AreTheTriangleWhereThereIsOne) {
    Scene scene = plain_scene();
    test::add_triangle(scene, {0, 0, 0}, {3, 0, 0}, {0, 0, 3});
    const ElementTree tree = make_elements(scene, {.max_area = 10.0, .backs = false});
    expect_consistent(tree);
    ASSERT_EQ(tree.count(), 1u);
    EXPECT_TRUE(tree.is_leaf(0));
    EXPECT_EQ(tree.positions[0], glm::dvec3(1, 0, 1));
    EXPECT_EQ(tree.normals[0], glm::dvec3(0, -1, 0));
    EXPECT_EQ(tree.areas[0], 4.5);
}

TEST(Elements, OfNothingAreNone) {
    const ElementTree tree = make_elements(plain_scene());
    EXPECT_EQ(tree.count(), 0u);
    EXPECT_EQ(tree.leaves, 0u);
}

TEST(Elements, KeepAreaAndOrderWhateverTheTriangles) {
    const Scene scene = random_triangles(501);
    const ElementTree tree = make_elements(scene, {.max_area = 0.05, .backs = false});
    expect_consistent(tree);
    std::vector<double> areas(scene.triangles.size(), 0.0);
    double total = 0.0;
    for (std::size_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) {
            EXPECT_LE(tree.areas[i], 0.05 * (1 + 1e-6));
            areas[tree.triangles[i]] += tree.areas[i];
        }
    for (std::size_t t = 0; t < areas.size(); ++t) {
        const auto& v = scene.triangles[t].vertex;
        const glm::dvec3 a = scene.positions[v[0]];
        const double area =
            0.5 * glm::length(glm::cross(scene.positions[v[1]] - a, scene.positions[v[2]] - a));
        EXPECT_NEAR(areas[t], area, 1e-12 * area);
        total += area;
    }
    EXPECT_NEAR(tree.areas[0], total, 1e-12 * total);
    // No coarser than needed: a leaf that was cut is more than half of what is allowed.
    for (std::size_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i) && tree.parents[i] != no_index && tree.is_patch(tree.parents[i])) {
            EXPECT_GT(tree.areas[i], 0.025 * (1 - 1e-6));
        }
}

TEST(Elements, AreAboutAsManyAsWished) {
    const Scene scene = random_triangles(500);
    for (const std::size_t requested : {2000u, 8192u, 20000u}) {
        const ElementTree tree = make_elements(scene, {.requested = requested, .backs = false});
        const auto leaves = static_cast<double>(tree.leaves);
        EXPECT_NEAR(leaves, static_cast<double>(requested), 0.1 * static_cast<double>(requested));
    }
    // Equal triangles are cut alike: 12 * 2^9 or 12 * 2^10, and the nearer one is taken.
    EXPECT_EQ(make_elements(cube(), {.requested = 8192}).leaves, 6144u);
    EXPECT_EQ(make_elements(cube(), {.requested = 9300}).leaves, 12288u);
}

TEST(Elements, CutLargeTrianglesHoweverManySmallOnesThereAre) {
    Scene scene = furnace({.subdivisions = 5, .radius = 0.1});  // 20,480 triangles
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    const ElementTree tree = make_elements(scene, {.requested = 1000, .vertices = false});
    const double most = 4.0 * tree.areas[0] / 1000;
    EXPECT_GT(tree.leaves, 20480u + 250u);
    for (std::size_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) {
            EXPECT_LE(tree.areas[i], most * (1 + 1e-6));
        }
}

TEST(Elements, AreNoSmallerThanTheLeastArea) {
    const ElementTree tree = make_elements(cube(), {.min_area = 0.1, .requested = 100000});
    EXPECT_EQ(tree.leaves, 96u);
    EXPECT_EQ(tree.max_area, 0.1);
}

TEST(Elements, HaveBacksWhereLightCouldPass) {
    Scene scene = cube();
    Material cloth = scene.materials[0];
    cloth.double_sided = true;
    const std::uint32_t two = test::add_material(scene, cloth);
    const std::uint32_t closed = static_cast<std::uint32_t>(scene.triangles.size());
    test::add_triangle(scene, {0.2, 0.2, 0.2}, {0.8, 0.2, 0.2}, {0.2, 0.2, 0.8});  // a sheet
    test::add_triangle(scene, {0.2, 0.6, 0.2}, {0.8, 0.6, 0.2}, {0.2, 0.6, 0.8}, two);
    for (const bool backs : {true, false}) {
        const ElementTree tree = make_elements(scene, {.max_area = 0.05, .backs = backs});
        expect_consistent(tree);
        std::vector<double> front(closed + 2, 0.0), back(closed + 2, 0.0);
        for (std::size_t i = 0; i < tree.count(); ++i)
            if (tree.is_leaf(i)) (tree.backs[i] ? back : front)[tree.triangles[i]] += tree.areas[i];
        for (std::uint32_t t = 0; t < closed; ++t) EXPECT_EQ(back[t], 0.0) << t;
        for (std::uint32_t t = closed; t < closed + 2; ++t) {
            EXPECT_NEAR(front[t], 0.18, 1e-12);
            EXPECT_NEAR(back[t], backs ? 0.18 : 0.0, 1e-12);
        }
        for (std::size_t i = 0; i < tree.count(); ++i)
            if (tree.is_patch(i) && tree.triangles[i] >= closed) {
                EXPECT_EQ(tree.normals[i].y, tree.backs[i] ? 1.0 : -1.0);
            }
    }
    // Closed, but of a material that has two sides.
    Scene both = plain_scene();
    both.materials[0].double_sided = true;
    test::add_box(both, glm::dvec3(0.0), glm::dvec3(1.0), 1);
    EXPECT_EQ(make_elements(both, {.max_area = 1.0}).leaves, 24u);
}

TEST(Elements, SayWhichClustersAreFlat) {
    Scene scene = plain_scene();
    for (int x = 0; x < 4; ++x)
        for (int z = 0; z < 4; ++z) {
            const double a = x, b = z, c = x + 1, d = z + 1;
            test::add_quad(scene, {glm::dvec3(a, 0, d), {c, 0, d}, {c, 0, b}, {a, 0, b}});
        }
    const ElementOptions faces{.max_area = 1.0, .backs = false, .vertices = false};
    ElementTree tree = make_elements(scene, faces);
    expect_consistent(tree);
    for (std::size_t i = 0; i < tree.count(); ++i) EXPECT_EQ(tree.normals[i], glm::dvec3(0, 1, 0));
    // A step of a hundredth of the width is no plane; neither are both sides of a sheet.
    for (std::size_t v = 0; v < 4; ++v) scene.positions[v].y = 0.04;
    tree = make_elements(scene, faces);
    EXPECT_FALSE(tree.is_flat(0));
}

TEST(Elements, KeepFrontsAndBacksOfSheetsApart) {
    Scene scene = plain_scene();
    test::add_floor(scene, 1.0);
    test::add_floor(scene, 1.0, 0.5);
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    expect_consistent(tree);
    EXPECT_EQ(tree.leaves, 16u);
    EXPECT_FALSE(tree.is_flat(0));
    for (std::uint32_t i = 1; i < tree.count(); ++i) {
        const bool back = i >= tree.ends[1];
        if (tree.is_patch(i)) {
            EXPECT_EQ(tree.backs[i] != 0, back);
            EXPECT_EQ(tree.normals[i].y, back ? -1.0 : 1.0);
        }
    }
}

TEST(Elements, LeaveOutTrianglesWithoutANormal) {
    Scene scene = cube();
    test::add_triangle(scene, {0.1, 0.1, 0.1}, {0.2, 0.2, 0.2}, {0.3, 0.3, 0.3});
    test::add_triangle(scene, {0.1, 0.1, 0.1}, {0.1, 0.1, 0.1}, {0.3, 0.3, 0.3});
    test::add_triangle(scene, {0.1, 0.1, 0.1}, {0.9, 0.1, 0.1}, {0.5, 0.1 + 1e-9, 0.1});
    const ElementTree tree = make_elements(scene, {.max_area = 1.0});
    expect_consistent(tree);
    EXPECT_EQ(tree.leaves, 12u);
    EXPECT_EQ(tree.skipped_triangles, 3u);
    EXPECT_NEAR(tree.skipped_area, 0.4e-9, 1e-15);
}

TEST(Elements, EndForAHundredThousandIdenticalTriangles) {
    Scene scene = plain_scene();
    test::add_triangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    scene.triangles.assign(100000, scene.triangles[0]);
    const ElementTree tree = make_elements(scene, {.max_area = 1.0, .backs = false});
    EXPECT_EQ(tree.leaves, 100000u);
    EXPECT_LE(*std::max_element(tree.levels.begin(), tree.levels.end()), 9u);  // log4 1e5 = 8.3
    EXPECT_NEAR(tree.radii[0], std::sqrt(5.0) / 3.0, 1e-9);
    EXPECT_TRUE(tree.is_flat(0));
}

// At medians of the longest axis: quarters of a row. By number where nothing else tells them apart.
TEST(Elements, AreClusteredWithTheirNeighbours) {
    for (int axis = 0; axis < 3; ++axis) {
        Scene row = plain_scene();
        for (int i = 0; i < 64; ++i) {
            glm::dvec3 a(0.0), b(0.3), c(0.3);
            a[axis] = b[axis] = c[axis] = (i * 29) % 64;
            a[(axis + 1) % 3] = (i * 7) % 5;
            b[(axis + 1) % 3] = -0.3;
            test::add_triangle(row, a, b, c);
        }
        const ElementTree tree = make_elements(row, {.max_area = 100.0, .backs = false});
        expect_consistent(tree);
        double before = -1.0;
        for (std::uint32_t child = 1; child < tree.count(); child = tree.ends[child]) {
            double low = 64.0, high = 0.0;
            for (std::uint32_t i = child; i < tree.ends[child]; ++i) {
                if (!tree.is_leaf(i)) continue;
                low = std::min(low, tree.positions[i][axis]);
                high = std::max(high, tree.positions[i][axis]);
            }
            EXPECT_GT(low, before);
            EXPECT_NEAR(high - low, 15.0, 1e-9);
            before = high;
        }
    }
    Scene same = plain_scene();
    test::add_triangle(same, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    same.triangles.assign(256, same.triangles[0]);
    const ElementTree tree = make_elements(same, {.max_area = 1.0, .backs = false});
    std::uint32_t first = 0;
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        if (tree.is_leaf(i)) {
            EXPECT_EQ(tree.triangles[i], first++);
        }
}

TEST(Elements, DoNotDependOnWhereTheSceneIs) {
    const Scene scene = random_triangles(60);
    Scene moved = scene;
    for (glm::dvec3& p : moved.positions) p += glm::dvec3(1e6, -2e6, 3e6);
    const ElementTree a = make_elements(scene, {.max_area = 0.1});
    const ElementTree b = make_elements(moved, {.max_area = 0.1});
    ASSERT_EQ(a.count(), b.count());
    EXPECT_EQ(a.ends, b.ends);
    EXPECT_EQ(a.triangles, b.triangles);
    for (std::size_t i = 0; i < a.count(); ++i) EXPECT_NEAR(a.radii[i], b.radii[i], 1e-8);
}

TEST(Elements, RefuseWhatTheyCannotMake) {
    const Scene scene = cube();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(make_elements(scene, {.max_area = -1.0}), Error);
    EXPECT_THROW(make_elements(scene, {.max_area = nan}), Error);
    EXPECT_THROW(make_elements(scene, {.min_area = nan}), Error);
    EXPECT_THROW(make_elements(scene, {.requested = 0}), Error);
    EXPECT_THROW(make_elements(scene, {.max_area = 1e-9}), Error);    // too many
    EXPECT_THROW(make_elements(scene, {.max_area = 5e-324}), Error);  // infinitely many
    Scene wrong = scene;
    wrong.triangles[3].material = 7;
    EXPECT_THROW(make_elements(wrong), InputError);
    wrong = scene;
    wrong.positions[3].x = nan;
    EXPECT_THROW(make_elements(wrong), InputError);
}

}  // namespace
}  // namespace clgi
