// The share of a hemisphere in which a VPL meets fronts of surfaces, against view factors.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "vpl_tools.hpp"

namespace clgi {
namespace {

// The share of a VPL at a point of the world.
float reach(Scene world, std::uint32_t size = 64, const glm::vec3& normal = glm::vec3(0, 0, 1),
            const glm::dvec3& at = glm::dvec3(0)) {
    const DeviceScene scene = test::on_device(world);
    // The third shooter of four, and another number in the list than in the batch.
    const glm::vec3 far = glm::vec3(0, 0, 1000), p = scene.frame().to_local(at);
    const auto site = [](const glm::vec3& where, const glm::vec3& n) {
        return test::SitePlace{where, n, 1e-4f, glm::vec3(1.0f), {{where, n, n}}};
    };
    const test::Sites sites(
        {site(far, normal), site(p, normal), site(far, normal), site(far, normal)}, {3, 2, 1, 0});
    sites.balance(BALANCE_REACH, {-1, -1, -1, -1});
    const auto cubes = test::hemicubes(sites, &scene, {1, 3, size, 0.0f, 1e-6f});
    test::vpl_passes().reach(
        test::device().queue,
        {1, 3, 0, 4, sites.buffers.stride, sites.buffers.sample_stride, size, 1.0f, 1, 0, 0, 0},
        sites.buffers, cubes.views, cubes.depth);
    const auto found =
        test::download<float>(sites.buffers.balance, BALANCE_PLANES * sites.buffers.stride);
    const float* shares = found.data() + BALANCE_REACH * sites.buffers.stride;
    EXPECT_EQ(shares[3], -1.0f) << "not in the batch";
    EXPECT_EQ(shares[0], 0.0f) << "far away";
    EXPECT_EQ(shares[2], 0.0f) << "far away";
    EXPECT_EQ(found[BALANCE_SHOOTER * sites.buffers.stride + 1], 1.0f);
    EXPECT_EQ(found[BALANCE_RECEIVER * sites.buffers.stride + 1], 1.0f);
    return shares[1];
}

Scene two_islands() {
    Scene world = test::plain_scene();
    for (const double s : {-4.0, 4.0})
        test::add_triangle(world, {s, s, -4}, {s, 0.999 * s, -4}, {0.999 * s, s, -4});
    return world;
}

// A convex polygon that faces the origin (or away).
void add_disc(Scene& world, const glm::dvec3& center, double radius, bool away = false,
              std::uint32_t material = 0) {
    const int corners = 90;
    const auto at = [&](int k) {
        const double angle = 2.0 * test::pi * k / corners;
        return center + radius * glm::dvec3(std::cos(angle), std::sin(angle), 0);
    };
    for (int k = 0; k < corners; ++k)
        if (away)
            test::add_triangle(world, center, at(k), at(k + 1), material);
        else
            test::add_triangle(world, center, at(k + 1), at(k), material);
}

// A face of the half cube above the origin: the top, or one of four sides from the horizon on. A
// little smaller, so that none of its neighbours' rays meet it.
void add_face(Scene& world, int face) {
    const double h = 0.99;
    if (face == 0) {
        test::add_quad(world, {glm::dvec3(-h, -h, 1), {-h, h, 1}, {h, h, 1}, {h, -h, 1}});
        return;
    }
    const double angle = test::pi / 2 * (face - 1);
    const glm::dvec3 out(std::cos(angle), std::sin(angle), 0), across(-out.y, out.x, 0);
    const glm::dvec3 up(0, 0, h);
    test::add_quad(
        world, {out + across * h, out - across * h, out - across * h + up, out + across * h + up});
}

TEST(Reach, OfAClosedRoomIsAll) {
    Scene world = test::plain_scene();
    test::add_box(world, {-1, -2, -1.5}, {2, 1, 1}, -1);
    for (const std::uint32_t size : {32u, 64u, 128u, 200u})
        EXPECT_EQ(reach(world, size, glm::normalize(glm::vec3(0.3f, -0.5f, 0.7f))), 1.0f);
}

TEST(Reach, OfNothingIsNothing) { EXPECT_EQ(reach(two_islands()), 0.0f); }

// Of a cube about the VPL: .5541 the top, .1115 each side. Midpoints of 32 x 32 cells, each 1/16
// wide: 1/24 h^2 of the Laplacian, below 4 / pi, over an area of 4.
TEST(Reach, OfTheFacesOfACubeIsThatOfItsHemicube) {
    const double bound = 1.0 / 256.0 / 24.0 * 16.0 / test::pi;
    const double top = 4.0 / test::pi * std::sqrt(0.5) * std::atan(std::sqrt(0.5));
    EXPECT_NEAR(top, 0.5541, 1e-4);
    for (const std::uint32_t size : {32u, 64u, 128u})
        for (int face = 0; face < 5; ++face) {
            Scene world = two_islands();
            add_face(world, face);
            const double wanted = face == 0 ? top : (1.0 - top) / 4.0;
            EXPECT_NEAR(reach(world, size), wanted, bound) << "face " << face << ", size " << size;
        }
}

// A disc of radius r straight ahead at h: r^2 / (r^2 + h^2). The rays that its edge crosses may
// count or not: of the cells along the edge, half a cell each, as many one way as the other.
TEST(Reach, OfADiscIsItsViewFactor) {
    for (const double radius : {0.25, 0.5, 0.75, 0.95}) {
        Scene world = two_islands();
        add_disc(world, {0, 0, 1}, radius);
        const double wanted = radius * radius / (radius * radius + 1.0);
        const double cells = 2.0 * test::pi * radius * 16.0;  // along the edge
        const double weight = 1.0 / (256.0 * test::pi * std::pow(1.0 + radius * radius, 2));
        EXPECT_NEAR(reach(world), wanted, 2.0 * std::sqrt(cells) * weight) << radius;
    }
}

// A wall close by, to infinity, is half of what there is to see.
TEST(Reach, OfHalfTheSkyIsAHalf) {
    for (const double side : {-1.0, 1.0}) {
        Scene world = two_islands();
        test::add_quad(world, {glm::dvec3(0.001 * side, -3 * side, -0.5),
                               {0.001 * side, -3 * side, 3.5},
                               {0.001 * side, 3 * side, 3.5},
                               {0.001 * side, 3 * side, -0.5}});
        EXPECT_NEAR(reach(world), 0.5, 0.002) << side;
        // It shows its back to the other side.
        EXPECT_EQ(reach(world, 64, glm::vec3(0, 0, 1), glm::dvec3(0.002 * side, 0, 0)), 0.0f);
    }
}

TEST(Reach, CountsFrontsAndBothSidesOfTheDoubleSided) {
    Material both;
    both.double_sided = true;
    for (const bool away : {false, true}) {
        Scene one = two_islands(), two = two_islands();
        const std::uint32_t material = test::add_material(two, both);
        add_disc(one, {0, 0, 1}, 0.7, away);
        add_disc(two, {0, 0, 1}, 0.7, away, material);
        const float found = reach(one);
        EXPECT_NEAR(reach(two), 0.49 / 1.49, 0.01);
        EXPECT_EQ(found, away ? 0.0f : reach(two));
        // Backs hide fronts behind them.
        add_disc(one, {0, 0, 2}, 1.3);
        EXPECT_EQ(reach(one), found);
    }
}

}  // namespace
}  // namespace clgi
