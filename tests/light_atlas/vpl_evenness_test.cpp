// How evenly VPLs and sample points lie on a wall, however it is cut and turned.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/vpl_layout.hpp>
#include <cmath>

#include "scenes.hpp"
#include "walls.hpp"

namespace clgi {
namespace {

using test::least_distance;
using test::position;
using test::positions;

// The largest difference between the share of points in a box and the box's area, over many boxes
// in the unit square.
double discrepancy(const std::vector<glm::dvec3>& points, double width, double height) {
    test::Random random(11);
    double worst = 0.0;
    for (int i = 0; i < 2000; ++i) {
        double x0 = random(0, 1), x1 = random(0, 1), y0 = random(0, 1), y1 = random(0, 1);
        if (x0 > x1) std::swap(x0, x1);
        if (y0 > y1) std::swap(y0, y1);
        const auto in = std::count_if(points.begin(), points.end(), [&](const glm::dvec3& p) {
            return p.x >= x0 * width && p.x < x1 * width && p.y >= y0 * height && p.y < y1 * height;
        });
        worst =
            std::max(worst, std::abs(double(in) / double(points.size()) - (x1 - x0) * (y1 - y0)));
    }
    return worst;
}

// Random points: least distance 0.02, discrepancy of a thousand 0.03.
TEST(VplEvenness, DoesNotDependOnHowAWallIsCut) {
    for (const glm::dvec2 size : {glm::dvec2(1, 1), glm::dvec2(3, 2), glm::dvec2(7, 0.5)})
        for (const std::uint32_t cells : {1u, 9u, 70u}) {
            const Scene scene = test::crooked_wall(size.x, size.y, cells);
            const Patches patches = make_patches(scene);
            const VplLayout layout =
                place_vpls(scene, patches, {.count = 100, .samples_per_vpl = 10});
            ASSERT_EQ(layout.vpls.size(), 100u);
            ASSERT_EQ(layout.samples.size(), 1000u);
            const std::vector<glm::dvec3> vpls = positions(scene, layout.vpls);
            const std::vector<glm::dvec3> samples = positions(scene, layout.samples);
            EXPECT_GT(least_distance(vpls, size.x * size.y), 0.55);
            EXPECT_GT(least_distance(samples, size.x * size.y), 0.4);
            EXPECT_LT(discrepancy(samples, size.x, size.y), size.x == 7 ? 0.05 : 0.02);
            for (const VplSite& vpl : layout.vpls) {
                EXPECT_GE(vpl.sample_count, 5u);
                EXPECT_LE(vpl.sample_count, 16u);
            }
        }
}

// The share of a VPL's cell on one side of an edge that may be anywhere. Of m independent samples
// its error is sqrt(1 / (6 m)) on average (STABILITY 1.3); these are spread evenly.
TEST(VplEvenness, SharesErrLessThanThoseOfRandomSamples) {
    for (const std::uint32_t m : {10u, 30u, 100u}) {
        const Scene scene = test::crooked_wall(1, 1, 1);
        const VplLayout layout =
            place_vpls(scene, make_patches(scene), {.count = 1, .samples_per_vpl = m});
        ASSERT_EQ(layout.vpls.size(), 1u);
        const std::vector<glm::dvec3> samples = positions(scene, layout.samples);
        double square = 0.0;
        const int edges = 200;
        for (int axis = 0; axis < 2; ++axis)
            for (int k = 0; k < edges; ++k) {
                const double edge = (k + 0.5) / edges;
                const auto inside =
                    std::count_if(samples.begin(), samples.end(),
                                  [&](const glm::dvec3& p) { return p[axis] < edge; });
                const double error = double(inside) / double(samples.size()) - edge;
                square += error * error / (2 * edges);
            }
        EXPECT_LT(std::sqrt(square), 0.6 * std::sqrt(1.0 / (6.0 * m))) << m;
    }
}

// Cells lie along the borders, however the wall is turned.
TEST(VplEvenness, KeepsOffTheBordersOfATurnedWall) {
    for (const double angle : {0.3, 0.7, 2.0}) {
        Scene scene = test::crooked_wall(4, 1, 9);
        const double c = std::cos(angle), s = std::sin(angle);
        for (glm::dvec3& p : scene.positions) p = {c * p.x - s * p.y, 2 * p.z, s * p.x + c * p.y};
        const VplLayout layout =
            place_vpls(scene, make_patches(scene), {.count = 64, .samples_per_vpl = 10});
        for (const VplSite& vpl : layout.vpls) {
            const glm::dvec3 p = position(scene, vpl);
            const double x = c * p.x + s * p.z, y = c * p.z - s * p.x;
            EXPECT_GT(std::min({x, y, 4 - x, 1 - y}), 0.25 * std::sqrt(4.0 / 64)) << angle;
        }
    }
}

}  // namespace
}  // namespace clgi
