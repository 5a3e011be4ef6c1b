// What surrounds texels, and what that makes of the light that they gathered: nearest and complete
// in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "frames.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

using test::SitePlace;
using test::SurfacePlace;

using test::nan;

// ---- nearest
// ----------------------------------------------------------------------------------------

TEST(Nearest, IsTheReachOfTheNearestVplThatFacesTheSameWay) {
    test::Random random(33);
    for (const int width : test::widths()) {
        std::vector<SitePlace> places;
        std::vector<float> reach;
        for (int i = 0; i < 40; ++i) {
            const glm::vec3 p(random(-1, 1), random(-1, 1), random(-1, 1));
            places.push_back({p, test::direction(random), 0.1f, glm::vec3(1.0f), {{p, p, p}}});
            reach.push_back(static_cast<float>(random(0.1, 1)));
        }
        test::Sites sites(places);
        sites.balance(BALANCE_REACH, reach);
        const std::uint32_t count = 203, stride = test::padded(count);
        std::vector<SurfacePlace> texels;
        for (std::uint32_t t = 0; t < count; ++t) {
            const glm::vec3 p(random(-1, 1), random(-1, 1), random(-1, 1));
            // The shading normal has no part in it.
            texels.push_back({p, test::direction(random), test::direction(random)});
        }
        texels[7].geometric = glm::vec3(0.0f);
        const cl::Buffer out = test::upload(std::vector<float>(stride, -1.0f));
        const FillParams params{
            0, 40, sites.buffers.stride, sites.buffers.sample_stride, count, stride, 48, 0};
        AtlasPasses(test::programs(), {.packet_width = width})
            .nearest(test::device().queue, params, sites.buffers,
                     test::upload_points(texels, stride, GBUFFER_GEOMETRIC + 3), out);
        const auto found = test::download<float>(out, count);
        int none = 0;
        for (std::size_t t = 0; t < count; ++t) {
            double least = 1e9;
            float wanted = 0.0f;
            bool doubtful = false;
            for (std::size_t i = 0; i < places.size(); ++i) {
                const glm::dvec3 d =
                    glm::dvec3(texels[t].position) - glm::dvec3(places[i].position);
                const double alike =
                    glm::dot(glm::dvec3(texels[t].geometric), glm::dvec3(places[i].normal));
                doubtful |= std::abs(alike - 0.5) < 1e-6;
                if (alike <= 0.5) continue;
                doubtful |= std::abs(glm::dot(d, d) - least) < 1e-6;
                if (glm::dot(d, d) >= least) continue;
                least = glm::dot(d, d);
                wanted = reach[i];
            }
            none += wanted == 0.0f;
            EXPECT_TRUE(doubtful || found[t] == (t < 48 ? -1.0f : wanted)) << width << " " << t;
        }
        EXPECT_GT(none, 0);
    }
}

// Of two at one distance the first counts; of none, 0.
TEST(Nearest, PrefersTheFirstOfEquals) {
    const glm::vec3 up(0, 1, 0);
    std::vector<SitePlace> places;
    for (const float x : {0.25f, -0.25f, 0.5f})
        places.push_back({{x, 0, 0}, up, 0.1f, glm::vec3(1.0f), {{up, up, up}}});
    test::Sites sites(places);
    sites.balance(BALANCE_REACH, {0.3f, 0.7f, 0.9f});
    const cl::Buffer texels = test::upload_points({{{0, 0, 0}, up, up}}, 16, GBUFFER_GEOMETRIC + 3);
    const cl::Buffer out = test::upload(std::vector<float>(16, -1.0f));
    for (const std::uint32_t sites_used : {3u, 0u}) {
        test::atlas_passes().nearest(test::device().queue, {0, sites_used, 16, 16, 1, 16, 0, 0},
                                     sites.buffers, texels, out);
        EXPECT_EQ(test::download<float>(out, 1)[0], sites_used ? 0.3f : 0.0f);
    }
}

// ---- complete
// ---------------------------------------------------------------------------------------

TEST(Complete, BringsFormFactorsToTheReachOfSurfaces) {
    struct {
        float reach, filled, raised;
    } const cases[] = {{1.0f, 0.8f, 1.25f}, {0.6f, 0.5f, 1.2f},  {0.5f, 0.8f, 1.0f},
                       {1.0f, 0.1f, 1.5f},  {0.5f, 2.0f, 0.5f},  {1.0f, 0.7f, 1.0f / 0.7f},
                       {1.0f, 0.0f, 1.0f},  {0.0f, 0.5f, 1.0f},  {0.0f, 0.0f, 1.0f},
                       {1.0f, 1.25f, 0.8f}, {1.0f, 1e-30f, 1.5f}};
    for (const int width : test::widths()) {
        const std::uint32_t count = 61, stride = 64;
        std::vector<float> reach(stride, nan), filled(stride, nan), light(3 * stride, nan);
        for (std::uint32_t t = 0; t < count; ++t) {
            reach[t] = cases[t % 11].reach;
            filled[t] = cases[t % 11].filled;
            for (std::uint32_t c = 0; c < 3; ++c)
                light[c * stride + t] =
                    1.0f + 3.0f * static_cast<float>(c) + 0.01f * static_cast<float>(t);
        }
        const cl::Buffer out = test::upload(std::vector<float>(3 * stride, -3.0f));
        const cl::Buffer gathered = test::upload(light);
        const cl::Buffer bad = test::upload(std::vector<cl_uint>{0});
        AtlasPasses(test::programs(), {.packet_width = width})
            .complete(test::device().queue, {0, 0, 0, 0, count, stride, 16, 0}, test::upload(reach),
                      test::upload(filled), gathered, out, bad);
        const auto found = test::download<float>(out, 3 * stride);
        EXPECT_TRUE(test::same_bits(test::download<float>(gathered, 3 * stride), light));
        EXPECT_EQ(test::download<cl_uint>(bad, 1)[0], 0u) << width;
        for (std::uint32_t t = 0; t < count; ++t)
            for (std::uint32_t c = 0; c < 3; ++c) {
                const double wanted =
                    t < 16 ? -3.0 : double{light[c * stride + t]} * double{cases[t % 11].raised};
                EXPECT_NEAR(found[c * stride + t], wanted, 2e-7 * std::abs(wanted))
                    << "texel " << t;
            }
    }
}

TEST(Complete, CountsPacketsThatAreNotFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const int width : test::widths())
        for (const float value : {nan, infinity, -infinity, 3e38f})
            for (std::uint32_t c = 0; c < 3; ++c) {
                std::vector<float> light(3 * 64, 1.0f);
                light[c * 64 + 3] = light[c * 64 + 60] = value;
                light[c * 64 + 61] = nan;  // beyond the last texel
                const cl::Buffer bad = test::upload(std::vector<cl_uint>{0});
                AtlasPasses(test::programs(), {.packet_width = width})
                    .complete(test::device().queue, {0, 0, 0, 0, 61, 64, 0, 0},
                              test::upload(std::vector<float>(64, 1.0f)),
                              test::upload(std::vector<float>(64, 0.5f)), test::upload(light),
                              test::empty<float>(3 * 64), bad);
                EXPECT_EQ(test::download<cl_uint>(bad, 1)[0], 2u) << width << " " << value;
            }
}

TEST(Fill, OfNothingIsFine) {
    const test::Sites sites({{{0, 0, 0}, {0, 0, 1}, 0.1f, glm::vec3(1.0f), {{{}, {}, {}}}}});
    const cl::Buffer any = test::upload(std::vector<float>(1024, 7.0f));
    const FillParams params{0, 0, 16, 16, 0, 16, 0, FILL_FORM_FACTORS};
    const cl::CommandQueue& queue = test::device().queue;
    const AtlasPasses& passes = test::atlas_passes();
    passes.see(queue, {0, 8, 0, 16, 0, 0, 0, 0}, any, any, any, any).wait();
    passes.gather(queue, params, sites.buffers, any, any, any, any).wait();
    passes.nearest(queue, params, sites.buffers, any, any).wait();
    passes.complete(queue, params, any, any, any, any, any).wait();
    EXPECT_EQ(test::download<float>(any, 1024), std::vector<float>(1024, 7.0f));
}

}  // namespace
}  // namespace clgi
