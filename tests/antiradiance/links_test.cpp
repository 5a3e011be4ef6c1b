// Links of single pairs in closed form: solid angles, bins, sides; inputs that would divide by 0.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/links.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "links_checks.hpp"
#include "methods/antiradiance/solid_angle.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
const ElementOptions whole{.max_area = 1e6, .backs = false};

// A small equilateral triangle that faces `normal`.
void add_facing(Scene& scene, const glm::dvec3& at, const glm::dvec3& normal, double size) {
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 s = glm::normalize(glm::cross(n, glm::dvec3(0.3, 0.5, 0.8)));
    const glm::dvec3 t = glm::cross(n, s);
    const double h = std::sqrt(0.75);
    test::add_triangle(scene, at + size * s, at + size * (-0.5 * s + h * t),
                       at + size * (-0.5 * s - h * t));
}

// What `receiver` gets in each bin from a sender of radiance 1 and -1, sr: form factor * area *
// |cosine| * solid angle of the bin.
std::map<int, double> angles(const ElementTree& tree, const DirectionBins& bins, const Links& links,
                             std::size_t receiver) {
    std::map<int, double> out;
    for (std::size_t k = links.first[receiver]; k < links.first[receiver + 1]; ++k) {
        const std::uint32_t sender = links.senders[k];
        EXPECT_GT(links.form_factors[k], 0.0f);
        out[links.bins[k]] += static_cast<double>(links.form_factors[k]) * tree.areas[sender] *
                              std::abs(test::bin_cosine(tree, bins, sender, links.bins[k])) *
                              bins.solid_angles[links.bins[k]];
    }
    return out;
}

double sum(const std::map<int, double>& angles) {
    double out = 0.0;
    for (const auto& [bin, angle] : angles) out += angle;
    return out;
}

TEST(SolidAngle, OfTrianglesInClosedForm) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1), none(0.0);
    EXPECT_NEAR(solid_angle({x, y, z}, none), pi / 2.0, 1e-15);  // an octant
    EXPECT_NEAR(solid_angle({x, z, y}, none), pi / 2.0, 1e-15);  // from behind
    // A face of a regular tetrahedron from its middle; half a face of a cube.
    EXPECT_NEAR(solid_angle({glm::dvec3(1, 1, 1), {1, -1, -1}, {-1, 1, -1}}, none), pi, 1e-14);
    EXPECT_NEAR(solid_angle({glm::dvec3(1, 1, 1), {-1, 1, 1}, {-1, -1, 1}}, none), pi / 3.0, 1e-14);
    // Far away: area * cosine / distance^2, to the square of size by distance.
    EXPECT_NEAR(solid_angle({x, y, none}, {600, 0, 800}), 0.5 * 0.8e-6, 1e-9);
    EXPECT_NEAR(solid_angle({glm::dvec3(-1, -1, 0), {2, -1, 0}, {-1, 2, 0}}, {0, 0, 1e-9}),
                2.0 * pi, 1e-8);
    EXPECT_NEAR(solid_angle({1e-60 * x, 1e-60 * y, 1e-60 * z}, none), pi / 2.0, 1e-15);
    EXPECT_EQ(solid_angle({x, y, none}, none), 0.0);                       // at a corner
    EXPECT_NEAR(solid_angle({x, y, none}, {3.0, -2.0, 0.0}), 0.0, 1e-15);  // in the plane
}

TEST(Links, BetweenTwoTrianglesCarryTheirSolidAngles) {
    test::Random random(5);
    const DirectionBins bins = direction_bins(208);
    for (int i = 0; i < 50; ++i) {
        const glm::dvec3 way(random(-1, 1), random(-1, 1), random(-1, 1));
        const glm::dvec3 w = glm::normalize(way);
        const glm::dvec3 tilt(random(-0.5, 0.5), random(-0.5, 0.5), random(-0.5, 0.5));
        const double d = random(2.0, 9.0);
        Scene scene = test::plain_scene();
        add_facing(scene, glm::dvec3(0.0), w + tilt, 0.03);
        add_facing(scene, d * w, -w + 0.7 * tilt, 0.05);
        const ElementTree tree = make_elements(scene, whole);
        ASSERT_EQ(tree.count(), 3u);
        const Links links = make_links(tree, bins);
        EXPECT_EQ(links.count(), 2u);
        EXPECT_EQ(links.pairs, 1u);
        EXPECT_EQ(links.unrefined, 0u);
        for (const std::uint32_t receiver : {1u, 2u}) {
            const std::uint32_t sender = 3 - receiver;
            const glm::dvec3 travel = tree.positions[receiver] - tree.positions[sender];
            const auto got = angles(tree, bins, links, receiver);
            ASSERT_EQ(got.size(), 1u);
            EXPECT_EQ(got.begin()->first, bins.nearest(travel));
            const double cosine = glm::dot(tree.normals[sender], glm::normalize(travel));
            const double expected = tree.areas[sender] * cosine / glm::dot(travel, travel);
            EXPECT_NEAR(got.begin()->second, expected, 0.01 * expected);  // (size / distance)^2
        }
    }
}

// [Dachsbacher07, figure 7]: what lies behind a sender gets what it takes away, and only fronts
// receive.
TEST(Links, LeaveFromBothSidesAndArriveAtFronts) {
    const DirectionBins bins = direction_bins(128);
    Scene scene = test::plain_scene();
    add_facing(scene, {0, 0, 0}, {0.1, 1, 0.2}, 0.1);
    add_facing(scene, {0.5, 2, 0.1}, {0, 1, 0.1}, 0.1);  // its back is towards the first one
    const ElementTree tree = make_elements(scene, whole);
    const std::uint32_t low = tree.triangles[1] == 0 ? 1 : 2, high = 3 - low;
    const Links links = make_links(tree, bins);
    ASSERT_EQ(links.count(), 1u);
    EXPECT_EQ(links.senders[0], high);
    EXPECT_EQ(links.first[low + 1] - links.first[low], 1u);
    const glm::dvec3 w = bins.directions[links.bins[0]];
    EXPECT_LT(glm::dot(w, tree.normals[high]), 0.0);
    EXPECT_LT(glm::dot(w, tree.normals[low]), 0.0);
    EXPECT_GT(links.form_factors[0], 0.0f);
}

TEST(Links, OfWhatLooksAwayAreNone) {
    const DirectionBins bins = direction_bins(128);
    Scene scene = test::plain_scene();
    add_facing(scene, {0, 0, 0}, {0.1, -1, 0.2}, 0.1);
    add_facing(scene, {0.5, 2, 0.1}, {0, 1, 0.1}, 0.1);
    EXPECT_EQ(make_links(make_elements(scene, whole), bins).pairs, 0u);
    // A small sender through the receiver's plane counts where its middle is.
    for (const double y : {-0.01, 0.01}) {
        Scene through = test::plain_scene();
        add_facing(through, {0, 0, 0}, {0, 1, 0}, 0.1);
        add_facing(through, {2.0, y, 0.3}, {-1, 0, 0.2}, 0.1);
        const ElementTree tree = make_elements(through, whole);
        const std::uint32_t floor = tree.triangles[1] == 0 ? 1 : 2;
        EXPECT_EQ(angles(tree, bins, make_links(tree, bins), floor).size(), y > 0.0 ? 1u : 0u);
    }
}

// Walls of many triangles: their clusters send the solid angle that they have.
TEST(Links, OfFlatClustersCarryTheirSolidAngles) {
    const DirectionBins bins = direction_bins(128);
    for (const double low : {1.0, -2.2}) {  // above the floor; through its plane, the middle below
        Scene scene = test::plain_scene();
        for (int x = 0; x < 4; ++x)
            for (int z = 0; z < 4; ++z) {
                const double a = 0.1 * x, b = 0.1 * z, c = a + 0.1, d = b + 0.1;
                test::add_quad(scene, {glm::dvec3(a, 0, d), {c, 0, d}, {c, 0, b}, {a, 0, b}});
                const double y = low + x, z0 = 1.5 * z - 3.0;
                test::add_quad(
                    scene,
                    {glm::dvec3(8, y, z0 + 1.5), {8, y + 1, z0 + 1.5}, {8, y + 1, z0}, {8, y, z0}});
            }
        const ElementTree tree = make_elements(scene, whole);
        const Links links = make_links(tree, bins, {.bin_share = 1.0});
        const double from = std::max(0.0, low), to = low + 4.0;
        bool clusters = false;
        for (std::uint32_t i = 0; i < tree.count(); ++i) {
            if (!tree.is_leaf(i) || tree.normals[i].y < 0.5) continue;
            const glm::dvec3 eye = tree.positions[i];
            const double expected =
                solid_angle({glm::dvec3(8, from, -3), {8, to, -3}, {8, to, 3}}, eye) +
                solid_angle({glm::dvec3(8, from, -3), {8, to, 3}, {8, from, 3}}, eye);
            double got = 0.0;
            for (std::uint32_t r = i; r != no_index; r = tree.parents[r]) {
                got += sum(angles(tree, bins, links, r));
                for (std::size_t k = links.first[r]; k < links.first[r + 1]; ++k)
                    clusters = clusters || !tree.is_patch(links.senders[k]);
            }
            // What the plane cuts counts where its middle is: half a row of 1.8 m, at most.
            EXPECT_NEAR(got, expected, (low > 0.0 ? 0.05 : 0.3) * expected);
        }
        EXPECT_TRUE(clusters);
    }
}

// Where the nearest bin lies on the wrong side of either plane, another one is taken.
TEST(Links, UseBinsInFrontOfTheReceiverAndOnTheSendersSide) {
    const DirectionBins bins = direction_bins(128);
    test::Random random(8);
    int moved = 0;
    for (int draw = 0; draw < 300; ++draw) {
        const glm::dvec3 w =
            glm::normalize(glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1)));
        const glm::dvec3 side = glm::normalize(glm::cross(w, glm::dvec3(0.1, 0.7, random(-1, 1))));
        Scene scene = test::plain_scene();
        add_facing(scene, glm::dvec3(0.0), side + 0.1 * w, 0.1);  // grazing, w is in front
        add_facing(scene, 4.0 * w, random(-1, 1) * side - 0.1 * w, 0.1);
        const ElementTree tree = make_elements(scene, whole);
        const Links links = make_links(tree, bins);
        for (std::uint32_t i = 0; i < tree.count(); ++i)
            for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k) {
                const std::uint32_t sender = links.senders[k];
                const glm::dvec3 travel = tree.positions[i] - tree.positions[sender];
                const glm::dvec3& bin = bins.directions[links.bins[k]];
                EXPECT_LT(glm::dot(bin, tree.normals[i]), 0.0);
                EXPECT_GT(
                    glm::dot(bin, tree.normals[sender]) * glm::dot(travel, tree.normals[sender]),
                    0.0);
                EXPECT_GE(std::abs(glm::dot(bin, tree.normals[sender])), 0.01);
                EXPECT_GE(glm::dot(bin, glm::normalize(travel)), std::cos(2 * 0.3133));
                moved += links.bins[k] != bins.nearest(travel);
            }
    }
    EXPECT_GT(moved, 50);
}

// A large leaf close by: its solid angle as one bin, or bin by bin, against 160,000 points of it.
TEST(Links, SpreadALargeLeafOverItsBins) {
    const DirectionBins bins = direction_bins(128);
    Scene scene = test::plain_scene();
    const glm::dvec3 a(-1, 0, -1), b(-1, 0, 2), c(2, 0, -1);
    test::add_triangle(scene, a, b, c);
    add_facing(scene, {0.1, 0.5, -0.1}, {0.1, -1, 0.05}, 0.01);
    const ElementTree tree = make_elements(scene, whole);
    const std::uint32_t sender = tree.triangles[1] == 0 ? 1 : 2, receiver = 3 - sender;
    const glm::dvec3 eye = tree.positions[receiver];
    const double total = solid_angle({a, b, c}, eye);
    const Links one = make_links(tree, bins, {.spread = Spread::none});
    EXPECT_EQ(one.unrefined, 1u);
    const auto single = angles(tree, bins, one, receiver);
    ASSERT_EQ(single.size(), 1u);
    EXPECT_NEAR(sum(single), total, 1e-6 * total);

    std::map<int, double> expected;
    constexpr int n = 400;
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n - i; ++k)
            for (const double vertex_patch : {1.0 / 3.0, 2.0 / 3.0}) {
                if (vertex_patch > 0.5 && k == n - i - 1) continue;
                const double u = (i + vertex_patch) / n, v = (k + vertex_patch) / n;
                const glm::dvec3 travel = eye - (a + u * (b - a) + v * (c - a));
                const double d = glm::length(travel);
                expected[bins.nearest(travel)] += 4.5 / (n * n) * travel.y / (d * d * d);
            }
    EXPECT_NEAR(sum(expected), total, 1e-3 * total);
    const Links links = make_links(tree, bins);
    EXPECT_EQ(links.unrefined, 1u);
    auto got = angles(tree, bins, links, receiver);
    EXPECT_NEAR(sum(got), total, 1e-6 * total);
    double difference = 0.0;
    for (const auto& [bin, angle] : expected) difference += std::abs(angle - got[bin]);
    EXPECT_LT(difference, 0.15 * total);  // parts of a quarter of a bin, on borders of bins

    // In parts that are elements: the same.
    const ElementTree cut = make_elements(scene, {.max_area = 0.1, .backs = false});
    const std::uint32_t small = static_cast<std::uint32_t>(
        std::max_element(cut.triangles.begin(), cut.triangles.end(),
                         [](std::uint32_t l, std::uint32_t r) { return l + 1 < r + 1; }) -
        cut.triangles.begin());
    ASSERT_EQ(cut.triangles[small], 1u);
    EXPECT_NEAR(sum(angles(cut, bins, make_links(cut, bins), small)), total, 1e-6 * total);
}

TEST(Links, CountOfALargeLeafOnlyWhatIsInFront) {
    const DirectionBins bins = direction_bins(512);
    for (const double low :
         {-1.0, -2.5}) {  // half of it is in front; less, and the middle is behind
        Scene scene = test::plain_scene();
        add_facing(scene, {0, 0, 0}, {0, 1, 0}, 0.01);
        const double high = low + 2.0 > 0.0 ? low + 2.0 : 1.0;
        const glm::dvec3 a(0.5, low, -1), b(0.5, low, 1), c(0.5, high, 0);
        test::add_triangle(scene, a, b, c);
        const ElementTree tree = make_elements(scene, whole);
        const std::uint32_t receiver = tree.triangles[1] == 0 ? 1 : 2;
        const double part = high / (high - low);  // of its height
        const double expected = solid_angle(
            {glm::dvec3(0.5, 0, -part), {0.5, 0, part}, {0.5, high, 0}}, tree.positions[receiver]);
        const auto got = angles(tree, bins, make_links(tree, bins), receiver);
        EXPECT_NEAR(sum(got), expected, 0.05 * expected);
    }
}

TEST(Links, OfPlatesBackToBackAreNone) {
    const DirectionBins bins = direction_bins(128);
    for (const double d : {0.0, 1e-30, 1e-3})
        for (const bool apart : {true, false}) {  // fronts away from each other, or towards
            Scene scene = test::plain_scene();
            const int up = apart ? 1 : -1;
            for (const int side : {1, -1}) {
                const glm::dvec3 a(0, side > 0 ? d : 0.0, 0), b = a + glm::dvec3(0, 0, 1),
                                                              c = a + glm::dvec3(1, 0, 0);
                if (side == up)
                    test::add_triangle(scene, a, b, c);
                else
                    test::add_triangle(scene, a, c, b);
            }
            const ElementTree tree = make_elements(scene, {.max_area = 0.01, .backs = false});
            const Links links = make_links(tree, bins);
            for (const float f : links.form_factors) EXPECT_TRUE(std::isfinite(f) && f > 0.0f);
            if (apart) {
                EXPECT_EQ(links.count(), 0u) << d;
            }
            const test::Arrived arrived = test::send_one(tree, bins, links);
            for (const double angle : arrived.solid_angle) EXPECT_LE(angle, 2.0 * pi * 1.02);
            // A millimetre apart, leaves of 14 cm fill each other's hemispheres.
            if (!apart && d == 1e-3) {
                EXPECT_GT(arrived.mean_irradiance, 0.9 * pi);
            }
        }
}

// Leaves that cross: the middle of one lies within the other one and sees none of it.
TEST(Links, GiveNothingToWhatLiesInTheSendersPlane) {
    const DirectionBins bins = direction_bins(128);
    for (const int facing : {1, -1}) {
        Scene scene = test::plain_scene();
        test::add_triangle(scene, {-1, 0, 1}, {2, 0, -2}, {-1, 0, -1});
        add_facing(scene, {-0.3, 0, -0.4}, {facing, 0, 0.1}, 0.5);
        const ElementTree tree = make_elements(scene, whole);
        const std::uint32_t large = tree.triangles[1] == 0 ? 1 : 2, small = 3 - large;
        const Links links = make_links(tree, bins);
        EXPECT_EQ(links.first[small + 1] - links.first[small], 0u);
        EXPECT_GT(links.count(), 0u);
    }
}

TEST(Links, EndWhereTrianglesCrossAndCoincide) {
    const DirectionBins bins = direction_bins(128);
    Scene scene = test::plain_scene();
    test::Random random(3);
    for (int i = 0; i < 500; ++i)  // about one point
        add_facing(scene, glm::dvec3(0.0), {random(-1, 1), random(-1, 1), random(-1, 1)}, 1.0);
    const ElementTree tree = make_elements(scene, {.max_area = 10.0});
    for (const float f : make_links(tree, bins).form_factors)
        ASSERT_TRUE(std::isfinite(f) && f > 0.0f);

    Scene many = test::plain_scene();
    test::add_triangle(many, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    many.triangles.assign(100000, many.triangles[0]);
    EXPECT_EQ(make_links(make_elements(many, {.max_area = 1.0}), bins).count(), 0u);
}

TEST(Links, OfNothingAreNone) {
    const DirectionBins bins = direction_bins(128);
    const Links none = make_links(make_elements(test::plain_scene()), bins);
    EXPECT_EQ(none.count(), 0u);
    EXPECT_EQ(none.first, std::vector<std::uint32_t>{0});
    EXPECT_EQ(none.bytes(), 4u);
    Scene scene = test::plain_scene();
    add_facing(scene, {0, 0, 0}, {0, 1, 0}, 1.0);
    const Links one = make_links(make_elements(scene, {.max_area = 0.1, .backs = false}), bins);
    EXPECT_EQ(one.count(), 0u);
    EXPECT_EQ(one.pairs, 0u);
}

TEST(Links, RefuseWhatTheyCannotMake) {
    const DirectionBins bins = direction_bins(128);
    Scene scene = test::plain_scene();
    add_facing(scene, {0, 0, 0}, {0, 1, 0}, 0.1);
    add_facing(scene, {0, 1, 0}, {0, -1, 0}, 0.1);
    const ElementTree tree = make_elements(scene, whole);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(make_links(tree, bins, {.bin_share = 0.0}), Error);
    EXPECT_THROW(make_links(tree, bins, {.bin_share = nan}), Error);
    EXPECT_THROW(make_links(tree, bins, {.threads = -1}), Error);
    EXPECT_THROW(make_links(tree, DirectionBins{}), Error);
    ElementTree wrong = tree;
    wrong.normals.pop_back();
    EXPECT_THROW(make_links(wrong, bins), Error);
    Scene tiny = scene;
    for (glm::dvec3& p : tiny.positions) p *= 1e-25;
    EXPECT_THROW(make_links(make_elements(tiny, whole), bins), InputError);
}

}  // namespace
}  // namespace clgi
