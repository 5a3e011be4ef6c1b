// Patches of surfaces whose parts are known, and of surfaces that are broken.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/patches.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"
#include "walls.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// What must hold for any scene.
void expect_consistent(const Scene& scene, const Patches& patches) {
    ASSERT_EQ(patches.triangle_patch.size(), scene.triangles.size());
    std::uint32_t next = 0, skipped = 0;
    double area = 0.0;
    for (std::uint32_t p = 0; p < patches.patches.size(); ++p) {
        const Patch& patch = patches.patches[p];
        EXPECT_EQ(patch.first, next);
        EXPECT_GE(patch.count, 1u);
        next += patch.count;
        double sum = 0.0;
        for (std::uint32_t i = patch.first; i < next; ++i) {
            const std::uint32_t t = patches.triangles[i];
            EXPECT_EQ(patches.triangle_patch[t], p);
            EXPECT_EQ(scene.materials[scene.triangles[t].material].double_sided,
                      patch.double_sided);
            sum += test::area_of(scene, t);
        }
        EXPECT_NEAR(patch.area, sum, 1e-12 * sum);
        EXPECT_NEAR(glm::length(patch.normal), 1.0, 1e-12);
        EXPECT_TRUE(std::isfinite(patch.centre.x + patch.centre.y + patch.centre.z));
        EXPECT_TRUE(patch.spread >= 0.0 && patch.spread < pi);
        area += patch.area;
    }
    EXPECT_EQ(next, patches.triangles.size());
    for (const std::uint32_t p : patches.triangle_patch) skipped += p == no_index;
    EXPECT_EQ(skipped, patches.skipped_triangles);
    EXPECT_EQ(skipped + next, scene.triangles.size());
    EXPECT_NEAR(patches.area, area, 1e-12 * area);
    const double all = test::area_of(scene);
    EXPECT_NEAR(patches.area + patches.skipped_area, all, 1e-12 * all);
}

TEST(Patches, OfABoxAreItsFaces) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, 0, 2}, {2, 1, 4}, 1);
    const Patches patches = make_patches(scene);
    expect_consistent(scene, patches);
    ASSERT_EQ(patches.patches.size(), 6u);
    glm::dvec3 sum(0.0);
    for (const Patch& patch : patches.patches) {
        const glm::dvec3 n = glm::abs(patch.normal);
        EXPECT_DOUBLE_EQ(std::max({n.x, n.y, n.z}), 1.0);
        EXPECT_NEAR(patch.area, n.x * 2 + n.y * 6 + n.z * 3, 1e-12);
        EXPECT_NEAR(glm::dot(patch.centre - glm::dvec3(0.5, 0.5, 3), patch.normal),
                    0.5 * (n.x * 3 + n.y * 1 + n.z * 2), 1e-12);
        EXPECT_NEAR(patch.spread, 0.0, 1e-7);
        sum += patch.normal;
    }
    EXPECT_NEAR(glm::length(sum), 0.0, 1e-12);
    EXPECT_NEAR(patches.area, 22.0, 1e-12);
}

TEST(Patches, TakeAWallAsOneHoweverItIsCut) {
    for (const std::uint32_t cells : {1u, 2u, 70u}) {
        const Scene scene = test::crooked_wall(3, 2, cells);
        const Patches patches = make_patches(scene);
        expect_consistent(scene, patches);
        ASSERT_EQ(patches.patches.size(), 1u) << cells;
        EXPECT_NEAR(patches.patches[0].area, 6.0, 1e-12);
        EXPECT_NEAR(glm::length(patches.patches[0].centre - glm::dvec3(1.5, 1, 0)), 0.0, 1e-12);
    }
}

// A cap of half angle a has the share (1 - cos a) / 2 of a sphere: at least 45 caps of 0.3.
TEST(Patches, OfASphereAreBoundedInAngle) {
    const Scene scene = furnace({.subdivisions = 5});
    const Patches patches = make_patches(scene, {0.3f, 1.0f});
    expect_consistent(scene, patches);
    EXPECT_GE(patches.patches.size(), 45u);
    EXPECT_LE(patches.patches.size(), 450u);
    double widest = 0.0;
    for (const Patch& patch : patches.patches) {
        const glm::dvec3 seed =
            glm::normalize(test::normal_of(scene, patches.triangles[patch.first]));
        for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i) {
            const glm::dvec3 n = glm::normalize(test::normal_of(scene, patches.triangles[i]));
            const double angle = std::acos(std::min(1.0, glm::dot(n, seed)));
            EXPECT_LE(angle, 0.3 + 1e-4);  // rounding may turn triangles this small by so much
            EXPECT_LE(std::acos(std::min(1.0, glm::dot(n, patch.normal))), patch.spread + 1e-4);
            widest = std::max(widest, angle);
        }
    }
    EXPECT_GT(widest, 0.28);  // and reaches the bound
}

TEST(Patches, StayNearTheirPlane) {
    const Scene scene = furnace({.subdivisions = 5});
    const double radius = std::sqrt(3.0);  // half the diagonal of its box
    const Patches patches = make_patches(scene, {1.5f, 0.02f});
    expect_consistent(scene, patches);
    double farthest = 0.0;
    for (const Patch& patch : patches.patches) {
        const std::uint32_t seed = patches.triangles[patch.first];
        const glm::dvec3 normal = glm::normalize(test::normal_of(scene, seed));
        for (std::uint32_t i = patch.first; i < patch.first + patch.count; ++i)
            for (int k = 0; k < 3; ++k)
                farthest = std::max(farthest,
                                    std::abs(glm::dot(test::corner(scene, patches.triangles[i], k) -
                                                          test::corner(scene, seed, 0),
                                                      normal)));
    }
    EXPECT_LE(farthest, 0.02 * radius * (1 + 1e-9));
    EXPECT_GT(farthest, 0.015 * radius);
}

TEST(Patches, EndWhereTheOtherSideIsSeen) {
    Scene scene = test::crooked_wall(2, 1, 2);
    Material material;
    material.double_sided = true;
    const std::uint32_t both = test::add_material(scene, material);
    for (SceneTriangle& t : scene.triangles)
        if (scene.positions[t.vertex[0]].x + scene.positions[t.vertex[1]].x +
                scene.positions[t.vertex[2]].x >
            3.0)
            t.material = both;
    const Patches patches = make_patches(scene);
    expect_consistent(scene, patches);
    ASSERT_EQ(patches.patches.size(), 2u);
    EXPECT_NE(patches.patches[0].double_sided, patches.patches[1].double_sided);
    for (SceneTriangle& t : scene.triangles) t.material = both;
    EXPECT_EQ(make_patches(scene).patches.size(), 1u);
}

// Two coplanar halves; a vertex lies on the middle of the left one's edge.
TEST(Patches, GrowAcrossATriangleWithoutAreaButNotAcrossATJunction) {
    Scene scene = test::plain_scene();
    const glm::dvec3 a(1, 0, 0), b(1, 1, 0), m(1, 0.5, 0);
    test::add_triangle(scene, {0, 0.5, 0}, a, b);
    test::add_triangle(scene, {2, 0.5, 0}, m, a);
    test::add_triangle(scene, {2, 0.5, 0}, b, m);
    EXPECT_EQ(make_patches(scene).patches.size(), 2u);
    test::add_triangle(scene, b, a, m);
    const Patches patches = make_patches(scene);
    expect_consistent(scene, patches);
    EXPECT_EQ(patches.patches.size(), 1u);
    EXPECT_EQ(patches.skipped_triangles, 1u);
    EXPECT_EQ(patches.triangle_patch[3], no_index);
    EXPECT_NEAR(patches.area, 1.0, 1e-12);
}

TEST(Patches, DoNotGrowWhereThreeTrianglesMeetOrTwoAreWoundApart) {
    Scene scene = test::plain_scene();
    const glm::dvec3 a(0, 0, 0), b(0, 1, 0);
    test::add_triangle(scene, a, b, {-1, 0, 0});
    test::add_triangle(scene, b, a, {1, 0, 0});
    EXPECT_EQ(make_patches(scene).patches.size(), 1u);
    test::add_triangle(scene, b, a, {1, 0, 0.01});
    EXPECT_EQ(make_patches(scene).patches.size(), 3u);
    scene.triangles.pop_back();
    std::swap(scene.triangles[1].vertex[0], scene.triangles[1].vertex[1]);
    const Patches apart = make_patches(scene);
    EXPECT_EQ(apart.patches.size(), 2u);
    for (const auto& sides : apart.neighbours)
        for (const std::uint32_t next : sides) EXPECT_EQ(next, no_index);
}

// The same triangle again reflects no more light; its back does, and has no back of its own.
TEST(Patches, SkipCopies) {
    Scene scene = test::plain_scene();
    Material material;
    material.double_sided = true;
    const std::uint32_t both = test::add_material(scene, material);
    for (const std::uint32_t m : {0u, both}) {
        Scene one = scene;
        const glm::dvec3 a(0, 0, 0), b(2, 0, 0), c(0, 3, 0), d(2, 3, 0);
        test::add_triangle(one, a, b, c, m);
        test::add_triangle(one, d, c, b, m);
        test::add_triangle(one, b, c, a, m);
        test::add_triangle(one, c, a, b, m);
        test::add_triangle(one, b, a, c, m);
        const Patches patches = make_patches(one);
        expect_consistent(one, patches);
        EXPECT_EQ(patches.skipped_triangles, m == both ? 3u : 2u);
        EXPECT_NEAR(patches.skipped_area, m == both ? 9.0 : 6.0, 1e-12);
        // Copies do not part what they lie on.
        EXPECT_EQ(patches.triangle_patch[0], m == both ? patches.triangle_patch[1] : 0u);
    }
}

TEST(Patches, CountNeedlesAndSlivers) {
    Scene scene = test::plain_scene();
    test::Random random(17);
    const auto point = [&](double size) {
        return glm::dvec3(random(-size, size), random(-size, size), random(-size, size));
    };
    for (int i = 0; i < 10000; ++i) {
        const glm::dvec3 from = point(10), along = point(3);
        const double width = std::pow(10.0, random(-12, -1));
        test::add_triangle(scene, from, from + along, from + random(0, 1) * along + point(width));
    }
    const Patches patches = make_patches(scene);
    expect_consistent(scene, patches);
    EXPECT_GT(patches.skipped_triangles, 3000u);
    EXPECT_LT(patches.skipped_triangles, 7000u);
    // Less than two spacings high, less than 11 m long: 2^-19 m each.
    EXPECT_LT(patches.skipped_area, 10000 * 0.5 * 11 * 0x1p-19);

    Scene needle = test::plain_scene();
    test::add_triangle(needle, {0, 0, 0}, {1, 0, 0}, {1, 1e-7, 0});
    test::add_triangle(needle, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    const Patches two = make_patches(needle);
    expect_consistent(needle, two);
    EXPECT_EQ(two.skipped_triangles, 1u);
    EXPECT_NEAR(two.skipped_area, 0.5e-7, 1e-15);
}

TEST(Patches, OfLittleAreFew) {
    Scene scene = test::plain_scene();
    Patches patches = make_patches(scene);
    expect_consistent(scene, patches);
    EXPECT_TRUE(patches.patches.empty());
    test::add_triangle(scene, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
    patches = make_patches(scene);
    expect_consistent(scene, patches);
    EXPECT_EQ(patches.skipped_triangles, 1u);
    test::add_triangle(scene, {0, 0, 0}, {0, 2, 0}, {0, 0, 3});
    patches = make_patches(scene);
    expect_consistent(scene, patches);
    ASSERT_EQ(patches.patches.size(), 1u);
    EXPECT_NEAR(patches.patches[0].area, 3.0, 1e-12);
    EXPECT_NEAR(patches.patches[0].normal.x, 1.0, 1e-12);
}

bool same(const Patches& a, const Patches& b) {
    if (a.triangle_patch != b.triangle_patch || a.triangles != b.triangles) return false;
    if (a.neighbours != b.neighbours || a.patches.size() != b.patches.size()) return false;
    for (std::size_t p = 0; p < a.patches.size(); ++p) {
        const Patch &x = a.patches[p], &y = b.patches[p];
        if (x.area != y.area || x.normal != y.normal || x.centre != y.centre) return false;
    }
    return a.area == b.area && a.skipped_area == b.skipped_area;
}

TEST(Patches, AreTheSameInEveryRunAndFarAway) {
    const Scene scene = bumpy_mesh();
    const Patches patches = make_patches(scene);
    expect_consistent(scene, patches);
    EXPECT_TRUE(same(patches, make_patches(scene)));
    const Scene room = corridor();
    const Patches near = make_patches(room);
    const Patches far = make_patches(test::moved(room, {1 << 20, -(1 << 21), 1 << 19}));
    EXPECT_EQ(near.patches.size(), far.patches.size());
    EXPECT_EQ(far.skipped_triangles, 0u);
    EXPECT_NEAR(near.area, far.area, 1e-6 * near.area);
}

TEST(Patches, NeedValidInput) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    EXPECT_THROW(make_patches(scene, {-0.1f, 0.1f}), Error);
    EXPECT_THROW(make_patches(scene, {1.6f, 0.1f}), Error);
    EXPECT_THROW(make_patches(scene, {std::nanf(""), 0.1f}), Error);
    EXPECT_THROW(make_patches(scene, {0.1f, -1.0f}), Error);
    EXPECT_THROW(make_patches(scene, {0.1f, std::numeric_limits<float>::infinity()}), Error);
    scene.triangles[1].material = 1;
    EXPECT_THROW(make_patches(scene), InputError);
    scene.triangles[1].material = 0;
    scene.positions[2].y = std::nan("");
    EXPECT_THROW(make_patches(scene), InputError);
    scene.positions[2].y = 0.0;
    scene.triangles[0].vertex[1] = 4;
    EXPECT_THROW(make_patches(scene), InputError);
}

}  // namespace
}  // namespace clgi
