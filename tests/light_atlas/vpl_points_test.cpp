// The points at which VPLs are looked at: the first sample points of each, side by side.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>

#include "vpl_tools.hpp"

namespace clgi {
namespace {

using test::SurfacePlace;

// Sites of 1 to 21 samples; no number comes twice.
std::vector<test::SitePlace> places(int count) {
    test::Random random(815);
    const auto any = [&] { return glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)); };
    std::vector<test::SitePlace> out(static_cast<std::size_t>(count));
    for (test::SitePlace& site : out) {
        site.area = 0.1f;
        for (int k = random.integer(1, 21); k > 0; --k)
            site.samples.push_back({any(), any(), any()});
    }
    return out;
}

TEST(Points, AreTheFirstSamplesOfEachSiteAndThenNothing) {
    const test::Sites sites(places(37));
    for (const std::uint32_t most : {1u, 2u, 3u, 8u, 9u, 21u}) {
        const SiteBuffers b = test::with_points(sites, most);
        EXPECT_EQ(b.per_site, most < 3    ? most
                              : most < 4  ? 4u
                              : most < 9  ? 8u
                              : most < 17 ? 16u
                                          : 32u);
        const auto found = test::download<float>(b.points, SITE_POINT_PLANES * b.point_stride);
        for (std::size_t i = 0; i < b.point_stride; ++i) {
            const std::size_t site = i / b.per_site, k = i % b.per_site;
            SurfacePlace wanted{glm::vec3(0.0f), glm::vec3(0.0f), glm::vec3(0.0f)};
            if (site < sites.places.size() &&
                k < std::min<std::size_t>(most, sites.places[site].samples.size()))
                wanted = sites.places[site].samples[k];
            for (int c = 0; c < 3; ++c) {
                EXPECT_EQ(found[(SITE_POINT_POSITION + c) * b.point_stride + i],
                          wanted.position[c]);
                EXPECT_EQ(found[(SITE_POINT_NORMAL + c) * b.point_stride + i], wanted.normal[c]);
                EXPECT_EQ(found[(SITE_POINT_GEOMETRIC + c) * b.point_stride + i],
                          wanted.geometric[c]);
            }
        }
    }
}

}  // namespace
}  // namespace clgi
