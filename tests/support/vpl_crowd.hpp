// A crowd of VPLs of which nothing hides any other, and the transport between them in double
// precision.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>

#include "vpl_tools.hpp"

namespace clgi::test {

inline constexpr double half_rounding = 0x1p-11, smallest_half = 0x1p-25;

// Sites of all sizes close together, their samples about a disc that is not quite flat.
inline std::vector<SitePlace> crowd(int count) {
    Random random(4711);
    std::vector<SitePlace> out;
    for (int i = 0; i < count; ++i) {
        SitePlace site;
        site.position = glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1));
        site.normal = direction(random);
        site.area = static_cast<float>(std::exp(random(std::log(0.003), std::log(0.3))));
        const float radius = std::sqrt(site.area / CLGI_PI);
        const int samples = random.integer(1, 21);
        for (int k = 0; k < samples; ++k) {
            glm::vec3 across = direction(random) * radius;
            across -= 0.97f * glm::dot(across, site.normal) * site.normal;
            site.samples.push_back({site.position + across,
                                    glm::normalize(site.normal + 0.3f * direction(random)),
                                    glm::normalize(site.normal + 0.1f * direction(random))});
        }
        out.push_back(site);
    }
    return out;
}

// Every pair of a crowd in which nothing hides anything: far and near, facing each other or not.
// most: samples of a receiver that are looked at, the first of its own. open: without hemicubes.
inline void expect_means(const VplPasses& passes, std::size_t most, bool open = false) {
    const Sites sites(crowd(61));
    const float scale = 0.37f;
    const auto looked_at = static_cast<std::uint32_t>(most);
    const auto rows =
        open ? open_rows(sites, 0, 61, true, scale, passes, looked_at)
             : transport_rows(sites, hemicubes(sites, nullptr), true, scale, passes, looked_at);
    int far = 0, near_by = 0, hidden = 0;
    for (std::size_t i = 0; i < sites.places.size(); ++i)
        for (std::size_t j = 0; j < sites.places.size(); ++j) {
            const SitePlace &from = sites.places[i], &to = sites.places[j];
            double wanted = 0.0, condition = 0.0;
            bool doubtful = false, close = false;
            const std::size_t samples = std::min(most, to.samples.size());
            for (std::size_t k = 0; k < samples; ++k) {
                const SurfacePlace& sample = to.samples[k];
                const glm::dvec3 p(sample.position), d = p - glm::dvec3(from.position);
                const double back = glm::dot(d, glm::dvec3(sample.geometric));
                const double above = glm::dot(d, glm::dvec3(from.normal));
                doubtful |= std::abs(back) < 1e-6 || std::abs(above) < 1e-6;
                if (!(back < 0.0 && above > 0.0)) continue;
                const Exchanged e = exchange(from, p, glm::dvec3(sample.normal));
                doubtful |= e.doubtful;
                close |= e.near_by;
                wanted += e.factor;
                condition += e.condition;
            }
            const double found = glm::unpackHalf1x16(rows[i * sites.buffers.stride + j]);
            if (i == j) {
                EXPECT_EQ(found, 0.0) << "a site lights itself";
                continue;
            }
            if (doubtful) continue;
            const double share = scale / (pi * static_cast<double>(samples));
            wanted *= share;
            condition *= share;
            // Rounded dot products of three terms, twice, and to half.
            EXPECT_NEAR(found, wanted, half_rounding * wanted + 2e-6 * condition + smallest_half)
                << i << " to " << j;
            EXPECT_TRUE(condition > 0.0 || found == 0.0);
            hidden += condition == 0.0;
            far += wanted > 0.0 && !close;
            near_by += wanted > 0.0 && close;
        }
    EXPECT_GT(far, 200);
    EXPECT_GT(near_by, 90);
    EXPECT_GT(hidden, 1000);
}

}  // namespace clgi::test
