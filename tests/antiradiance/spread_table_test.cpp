// Light from leaves larger than a bin, spread by a Gaussian around their middle.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/links.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "links_checks.hpp"
#include "methods/antiradiance/solid_angle.hpp"
#include "methods/antiradiance/spread_table.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

TEST(SpreadTable, RowsSumToOneWithinTheirCone) {
    for (const int count : {32, 128, 512}) {
        const DirectionBins bins = direction_bins(count);
        const SpreadTable table(bins);
        const double mean = 4.0 * pi / count;
        std::size_t before = 0;
        for (const double angle :
             {0.0, 1e-30, mean, 1.5 * mean, 4.0 * mean, 1.0, pi, 2.0 * pi, 12.0}) {
            std::size_t most = 0;
            for (int j = 0; j < count; ++j) {
                const auto& row = table.row(j, angle);
                double sum = 0.0;
                std::set<int> seen;
                for (const SpreadShare& share : row) {
                    EXPECT_GT(share.weight, 0.0);
                    sum += share.weight;
                    seen.insert(share.bin);
                }
                EXPECT_NEAR(sum, 1.0, 1e-14);
                EXPECT_EQ(seen.size(), row.size());
                EXPECT_EQ(seen.count(j), 1u);
                most = std::max(most, row.size());
            }
            EXPECT_GE(most, before);
            before = most;
            if (angle <= mean) {
                EXPECT_EQ(most, 1u);
            }
        }
        EXPECT_NEAR(static_cast<double>(before), 0.5 * count, 2.0 + 0.05 * count);  // a hemisphere
    }
}

// Weights are those of the definition: 4 bins wide, the half angle is acos(1 - 8 / m).
TEST(SpreadTable, FollowsTheGaussian) {
    const DirectionBins bins = direction_bins(128);
    const SpreadTable table(bins);
    const double mean = 4.0 * pi / 128.0;
    for (const int middle : {0, 17, 90}) {
        double sum = 0.0;
        std::vector<double> wanted(128, 0.0);
        for (int j = 0; j < 128; ++j) {
            const double along =
                std::min(1.0, glm::dot(bins.directions[j], bins.directions[middle]));
            if (along < 1.0 - 8.0 / 128.0) continue;
            wanted[j] =
                bins.solid_angles[j] * std::exp(-std::pow(std::acos(along), 2) / (2.0 * mean));
            sum += wanted[j];
        }
        const auto& row = table.row(middle, 3.0 * mean);
        EXPECT_GE(row.size(), 2u);
        for (const SpreadShare& share : row)
            EXPECT_NEAR(share.weight, wanted[static_cast<std::size_t>(share.bin)] / sum, 1e-12);
    }
}

// What a large leaf close by sends arrives whole, through bins on the right sides; in a closed box
// irradiance is right but for the corners.
TEST(SpreadTable, KeepsTheSolidAngleOfLeaves) {
    const DirectionBins bins = direction_bins(128);
    Scene scene = test::plain_scene();
    const glm::dvec3 a(-1, 0, -1), b(-1, 0, 2), c(2, 0, -1);
    test::add_triangle(scene, a, b, c);
    test::add_triangle(scene, {0.1, 0.5, -0.1}, {0.11, 0.5, -0.1}, {0.1, 0.5, -0.09});
    const ElementTree tree = make_elements(scene, {.max_area = 1e6, .backs = false});
    const std::uint32_t sender = tree.triangles[1] == 0 ? 1 : 2, receiver = 3 - sender;
    const double total = solid_angle({a, b, c}, tree.positions[receiver]);
    const Links links = make_links(tree, bins, {.spread = Spread::gaussian});
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t k = links.first[receiver]; k < links.first[receiver + 1]; ++k) {
        ASSERT_EQ(links.senders[k], sender);
        const int bin = links.bins[k];
        const double sent = test::bin_cosine(tree, bins, sender, bin);
        EXPECT_GT(sent, 0.0);
        EXPECT_LT(test::bin_cosine(tree, bins, receiver, bin), 0.0);
        sum += double{links.form_factors[k]} * tree.areas[sender] * sent *
               bins.solid_angles[static_cast<std::size_t>(bin)];
        ++count;
    }
    EXPECT_GT(count, 8u);
    EXPECT_NEAR(sum, total, 1e-6 * total);
}

// In a closed box radiance 1 gives the irradiance pi. The Gaussian takes light that grazes a wall
// next to another for light that comes from further above it, and so gives too much.
TEST(SpreadTable, IrradianceInAClosedBox) {
    Scene box = test::plain_scene();
    test::add_box(box, {0, 0, 0}, {1.0, 1.2, 0.8}, -1);
    const ElementTree walls = make_elements(box, {.requested = 600});
    const DirectionBins bins = direction_bins(512);
    const auto error = [&](Spread spread) {
        const Links links = make_links(walls, bins, {.spread = spread});
        return test::send_one(walls, bins, links).mean_irradiance / pi - 1.0;
    };
    const double precise = error(Spread::precise), gaussian = error(Spread::gaussian),
                 none = error(Spread::none);
    RecordProperty("precise", std::to_string(precise));
    RecordProperty("gaussian", std::to_string(gaussian));
    RecordProperty("none", std::to_string(none));
    EXPECT_NEAR(precise, 0.0, 0.02);
    EXPECT_NEAR(gaussian, 0.0, 0.07);
}

}  // namespace
}  // namespace clgi
