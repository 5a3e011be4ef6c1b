// VPLs where nothing lies between surfaces: their transport without hemicubes, and the share of the
// hemisphere that surfaces fill, in closed form.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "math_modes.hpp"
#include "vpl_crowd.hpp"

namespace clgi {
namespace {

using test::SitePlace;
using test::Sites;

CLGI_IN_BOTH_MATHS(OpenTransport);

TEST_P(OpenTransport, IsTheMeanOfTheKernelOverTheReceiversSamples) {
    for (const std::size_t most : {1u, 2u, 5u, 16u, 1u << 20})
        test::expect_means(test::vpl_passes(GetParam()), most, true);
}

// Sites in one plane, which their normal meets by rounding alone, are one surface, whatever the
// shading normals of their samples are; one site looks at them from above.
TEST_P(OpenTransport, LeavesOutWhatLiesInThePlane) {
    const glm::vec3 normal = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));
    const glm::vec3 u = glm::normalize(glm::cross(normal, glm::vec3(0, 0, 1)));
    const glm::vec3 v = glm::cross(normal, u), above = 1.2f * normal;
    std::vector<SitePlace> places;
    for (int i = 0; i < 40; ++i) {
        const glm::vec3 at = 0.7f * normal + 0.1f * static_cast<float>(i % 8) * u +
                             0.1f * static_cast<float>(i / 8) * v;
        const glm::vec3 tilted = glm::normalize(normal + 0.4f * u);
        places.push_back({at, normal, 0.01f, glm::vec3(1.0f), {{at, tilted, normal}}});
    }
    places.push_back({above, -normal, 0.01f, glm::vec3(1.0f), {{above, -normal, -normal}}});
    const Sites sites(places);
    const auto rows =
        test::open_rows(sites, 0, 41, true, 1.0f, test::vpl_passes(GetParam()), 1u << 20, 2e-5f);
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < places.size(); ++j)
            EXPECT_EQ(rows[i * sites.buffers.stride + j] != 0, (i == 40) != (j == 40)) << i;
}

TEST(OpenTransport, IsTheSameForEveryWidthGroupAndBatch) {
    std::vector<cl_uint> order;
    for (cl_uint i = 0; i < 37; ++i) order.push_back((i * 5 + 2) % 37);
    const Sites sites(test::crowd(37), order);
    const std::uint32_t n = 37, stride = sites.buffers.stride;
    for (const std::uint32_t most : {3u, 21u}) {
        const auto rows_of = [&](int width, std::size_t group, std::uint32_t first,
                                 std::uint32_t count, bool kept) {
            BuildOptions build;
            build.packet_width = width;
            build.local_size = group;
            return test::open_rows(sites, first, count, kept, 1.0f,
                                   VplPasses(test::programs(), build), most);
        };
        const auto usual = rows_of(1, 0, 0, n, true);
        for (const int width : test::widths())
            for (const std::size_t group : {1u, 16u})
                EXPECT_EQ(rows_of(width, group, 0, n, true), usual) << width;
        for (const std::uint32_t batch : {1u, 7u, 8u, 16u})
            for (std::uint32_t first = 0; first < n; first += batch) {
                const std::uint32_t count = std::min(batch, n - first);
                const auto rows = rows_of(0, 0, first, count, false);
                for (std::uint32_t s = 0; s < count; ++s)
                    for (std::size_t j = 0; j < n; ++j)
                        EXPECT_EQ(rows[s * stride + j], usual[order[first + s] * stride + j]);
            }
    }
}

// ---- the share that surfaces fill --------------------------------------------------------------

// The share of a VPL at a point of the world, the 19th shooter of 21; others lie high above
// everything and see nothing: they look up, or `down` on what shows its back to them.
float open_reach(const Scene& world, const glm::vec3& normal = glm::vec3(0, 0, 1),
                 const glm::dvec3& at = glm::dvec3(0), float lift = 0.0f, Math math = Math::strict,
                 bool down = false) {
    const DeviceScene scene = test::on_device(world);
    std::vector<SitePlace> places;
    std::vector<cl_uint> order;
    for (cl_uint i = 0; i < 24; ++i) {
        const glm::vec3 p = i == 9 ? scene.frame().to_local(at) : glm::vec3(0, 0, 1000);
        const glm::vec3 n = i == 9 ? normal : glm::vec3(0, 0, down ? -1 : 1);
        places.push_back({p, n, 1e-4f, glm::vec3(1.0f), {{p, n, n}}});
        order.push_back((i * 7 + 13) % 24);
    }
    const Sites sites(places, order);
    sites.balance(BALANCE_REACH, std::vector<float>(24, -1.0f));
    const std::uint32_t stride = sites.buffers.stride;
    test::vpl_passes(math).reach_open(
        test::device().queue,
        {2, 21, 0, 24, stride, sites.buffers.sample_stride, 0, 1.0f, 1, 0, 0, lift}, scene,
        sites.buffers);
    const auto found = test::download<float>(sites.buffers.balance, BALANCE_PLANES * stride);
    const float* shares = found.data() + BALANCE_REACH * stride;
    for (cl_uint k = 0; k < 24; ++k) {
        if (order[k] == 9) continue;
        EXPECT_EQ(shares[order[k]], k < 2 || k > 22 ? -1.0f : 0.0f) << k;
    }
    EXPECT_EQ(found[BALANCE_SHOOTER * stride + 9], 1.0f);
    EXPECT_EQ(found[BALANCE_RECEIVER * stride + 9], 1.0f);
    return shares[9];
}

// Two triangles far below the horizon give the scene its size.
Scene open_islands() {
    Scene world = test::plain_scene();
    for (const double s : {-4.0, 4.0})
        test::add_triangle(world, {s, s, -4}, {s, 0.999 * s, -4}, {0.999 * s, s, -4});
    return world;
}

CLGI_IN_BOTH_MATHS(OpenReach);

// 12 triangles cut by the horizon in every way.
TEST_P(OpenReach, OfAClosedRoomIsAll) {
    Scene world = test::plain_scene();
    test::add_box(world, {-1, -2, -1.5}, {2, 1, 1}, -1);
    test::Random random(3);
    for (int i = 0; i < 30; ++i) {
        const glm::dvec3 at(random(-0.9, 1.9), random(-1.9, 0.9), random(-1.4, 0.9));
        EXPECT_NEAR(open_reach(world, test::direction(random), at, 0.0f, GetParam()), 1.0f, 1e-5f)
            << i;
    }
    // On a wall, also beside an edge and in a corner: its own two triangles lie in its plane.
    for (const glm::dvec3& at :
         {glm::dvec3(-1, 0.3, 0.2), {-1, -1.999, 0.2}, {-1, 0.999, 0.999}, {-1, -0.5, -0.25}})
        EXPECT_NEAR(open_reach(world, glm::vec3(1, 0, 0), at, 2e-5f, GetParam()), 1.0f, 1e-5f);
}

TEST(OpenReach, OfNothingIsNothing) { EXPECT_EQ(open_reach(open_islands()), 0.0f); }

// A rectangle with a corner straight over the point, at height h: the closed form of Lambert.
double corner_factor(double a, double b, double h) {
    const double x = a / h, y = b / h, rx = std::sqrt(1 + x * x), ry = std::sqrt(1 + y * y);
    return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2.0 * test::pi);
}

TEST_P(OpenReach, OfARectangleIsItsFormFactor) {
    for (const auto& [a, b, h] : {std::tuple{1.0, 1.0, 1.0}, {3.0, 0.2, 0.5}, {0.05, 2.0, 2.0}}) {
        Scene world = open_islands();
        test::add_quad(world, {glm::dvec3(0, 0, h), {0, b, h}, {a, b, h}, {a, 0, h}});
        for (const bool others_see_its_back : {false, true})
            EXPECT_NEAR(
                open_reach(world, {0, 0, 1}, glm::dvec3(0), 0.0f, GetParam(), others_see_its_back),
                corner_factor(a, b, h), 2e-7 + 2e-6 * corner_factor(a, b, h));
    }
}

// A point looks from where it is lifted to, along each axis and aslant.
TEST_P(OpenReach, LooksFromAbove) {
    const double a = 0.8, b = 0.6, h = 1.0, lift = 0.25;
    const glm::dvec3 ways[] = {
        {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, glm::normalize(glm::dvec3(1, 2, 3))};
    for (const glm::dvec3& n : ways) {
        const glm::dvec3 u = glm::normalize(glm::cross(n, glm::dvec3(0.3, -0.5, 0.8)));
        const glm::dvec3 v = glm::cross(n, u);
        Scene world = test::plain_scene();
        world.materials[0].double_sided = true;
        test::add_quad(world, {h * n, h * n + b * v, h * n + a * u + b * v, h * n + a * u});
        const double scale = test::on_device(world).frame().scale;
        const auto local = static_cast<float>(lift * scale);
        EXPECT_NEAR(open_reach(world, glm::vec3(n), glm::dvec3(0), local, GetParam()),
                    corner_factor(a, b, h - lift), 1e-6);
    }
}

// To infinity, beside the point: half of what there is to see, whichever way it is turned.
TEST_P(OpenReach, OfHalfTheSkyIsAHalf) {
    for (const double side : {-1.0, 1.0}) {
        Scene world = open_islands();
        test::add_quad(world, {glm::dvec3(1e-3 * side, -4 * side, -3),
                               {1e-3 * side, -4 * side, 4},
                               {1e-3 * side, 4 * side, 4},
                               {1e-3 * side, 4 * side, -3}});
        EXPECT_NEAR(open_reach(world, {0, 0, 1}, glm::dvec3(0), 0.0f, GetParam()), 0.5, 5e-4)
            << side;
        EXPECT_EQ(open_reach(world, {0, 0, 1}, glm::dvec3(0.002 * side, 0, 0)), 0.0f) << "its back";
    }
}

TEST(OpenReach, CountsFrontsAndBothSidesOfTheDoubleSided) {
    Material both;
    both.double_sided = true;
    for (const bool away : {false, true}) {
        Scene one = open_islands(), two = open_islands();
        const std::uint32_t material = test::add_material(two, both);
        std::array<glm::dvec3, 4> corners = {glm::dvec3(0, 0, 1), {0, 1, 1}, {1, 1, 1}, {1, 0, 1}};
        if (away) std::swap(corners[1], corners[3]);
        test::add_quad(one, corners);
        test::add_quad(two, corners, material);
        EXPECT_NEAR(open_reach(two), corner_factor(1, 1, 1), 1e-6);
        EXPECT_EQ(open_reach(one), away ? 0.0f : open_reach(two));
    }
}

TEST(OpenReach, IsNeverMoreThanAll) {
    Scene world = test::plain_scene();
    test::add_box(world, {-1, -1, -1}, {1, 1, 1}, -1);
    test::add_box(world, {-0.8, -0.8, 0.3}, {0.8, 0.8, 0.5}, 1);
    EXPECT_EQ(open_reach(world, {0, 0, 1}, {0.1, 0.2, -0.5}), 1.0f);
}

}  // namespace
}  // namespace clgi
