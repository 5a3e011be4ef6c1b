// Which bin a direction is in, and which one two elements exchange light through.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "methods/antiradiance/bin_choice.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// Near borders of squares and of bins as elsewhere, and for any number of bins.
TEST(BinGrid, FindsTheNearestBin) {
    test::Random random(9);
    for (const int count : {32, 34, 128, 208, 1024, 4096}) {
        const DirectionBins bins = direction_bins(count);
        const BinGrid grid(bins, 0.5);
        for (int draw = 0; draw < 2000; ++draw) {
            glm::dvec3 w(random(-1, 1), random(-1, 1), random(-1, 1));
            if (draw % 4 == 1) w[draw % 3] = 0.0;
            if (draw % 4 == 2) w[draw % 3] = w[(draw + 1) % 3];
            if (draw % 4 == 3) w = bins.directions[static_cast<std::size_t>(draw % count)];
            w = glm::normalize(w);
            ASSERT_EQ(grid.nearest(w), bins.nearest(w)) << count << " " << draw;
        }
    }
}

// Directions of bins of one's own: along axes and diagonals of a cube.
DirectionBins few_bins(int count) {
    DirectionBins out;
    const glm::dvec3 all[] = {{1, 1, 1}, {1, 1, -1}, {1, -1, 1}, {-1, 1, 1}};
    for (int i = 0; i < count / 2; ++i) {
        glm::dvec3 axis(0.0);
        axis[i % 3] = 1.0;
        out.directions.push_back(count == 6 ? axis : glm::normalize(all[i]));
    }
    for (int i = 0; i < count / 2; ++i)
        out.directions.push_back(-out.directions[static_cast<std::size_t>(i)]);
    out.solid_angles.assign(out.directions.size(), 4.0 * pi / count);
    return out;
}

TEST(BinChoice, IsTheNearestBinThatBothEndsAllow) {
    for (const int count : {2, 6, 8, 32, 34, 128, 208, 1024, 4096}) {
        const DirectionBins bins = count < 32 ? few_bins(count) : direction_bins(count);
        const BinChoice choose(bins);
        const double farthest = std::min(2.0 * std::sqrt(4.0 * pi / count), 0.5 * pi);
        test::Random random(4);
        const auto any = [&] {
            return glm::normalize(glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1)));
        };
        int none = 0, others = 0;
        for (int draw = 0; draw < 500; ++draw) {
            const glm::dvec3 w = any();
            const BinDemand sender{any(), 0.3}, receiver{any(), 0.1};
            int best = -1;
            for (int j = 0; j < bins.count(); ++j) {
                const glm::dvec3& bin = bins.directions[static_cast<std::size_t>(j)];
                if (glm::dot(bin, sender.normal) < 0.3 || glm::dot(bin, receiver.normal) < 0.1)
                    continue;
                if (glm::dot(bin, w) <= std::cos(farthest)) continue;
                const auto at = static_cast<std::size_t>(best);
                if (best < 0 || glm::dot(bin, w) > glm::dot(bins.directions[at], w)) best = j;
            }
            none += best < 0;
            others += best >= 0 && best != bins.nearest(w);
            ASSERT_EQ(choose(w, sender, receiver).value_or(-1), best) << count << " " << draw;
            ASSERT_EQ(choose(w, {}, {}), bins.nearest(w)) << count << " " << draw;
        }
        EXPECT_GT(none, 100) << count;
        EXPECT_LT(none, 480) << count;
        if (count > 2) {
            EXPECT_GT(others, 5) << count;
        }
    }
}

}  // namespace
}  // namespace clgi
