// Light that VPLs bring to texels: gather, nearest and complete in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "math_modes.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

using test::SitePlace;
using test::SurfacePlace;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

struct Filled {
    std::vector<float> irradiance, filled;
    std::uint32_t stride;
};

// Batches of VPLs after what was there before, 0.25 times the channel's number.
Filled gather(const test::Sites& sites, const std::vector<SurfacePlace>& texels,
              std::uint32_t batch, const AtlasPasses& passes = test::atlas_passes(),
              std::uint32_t first_texel = 0, const DeviceScene* scene = nullptr) {
    const auto count = static_cast<std::uint32_t>(texels.size());
    Filled out;
    out.stride = test::padded(count);
    std::vector<float> before(3 * out.stride);
    for (std::size_t k = 0; k < before.size(); ++k)
        before[k] = 0.25f * static_cast<float>(k / out.stride);
    const cl::Buffer irradiance = test::upload(before);
    const cl::Buffer filled = test::upload(std::vector<float>(out.stride, 0.5f));
    const cl::Buffer planes = test::upload_points(texels, out.stride, GBUFFER_GEOMETRIC + 3);
    const SiteBuffers& b = sites.buffers;
    for (std::uint32_t first = 0; first < b.site_count; first += batch) {
        const auto cubes =
            test::hemicubes(sites, scene, {first, std::min(batch, b.site_count - first)});
        passes.gather(test::device().queue,
                      {first, cubes.count, b.stride, b.sample_stride, count, out.stride,
                       first_texel, cubes.words},
                      b, cubes.views, cubes.pixels, planes, irradiance, filled);
    }
    out.irradiance = test::download<float>(irradiance, before.size());
    out.filled = test::download<float>(filled, out.stride);
    return out;
}

struct Crowd {
    std::vector<SitePlace> places;
    std::vector<glm::vec3> received;
    std::vector<SurfacePlace> texels;
    std::vector<cl_uint> order;
    Crowd() {
        test::Random random(31);
        for (int i = 0; i < 23; ++i) {
            SitePlace site;
            site.position = glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1));
            site.normal = test::direction(random);
            site.area = static_cast<float>(std::exp(random(std::log(0.003), std::log(0.3))));
            site.albedo = glm::vec3(random(0.1, 1), random(0.1, 1), random(0.1, 1));
            const float radius = std::sqrt(site.area / CLGI_PI);
            const int samples = random.integer(1, 13);
            for (int k = 0; k < samples; ++k) {
                glm::vec3 across = test::direction(random) * radius;
                across -= 0.97f * glm::dot(across, site.normal) * site.normal;
                site.samples.push_back({site.position + across, site.normal, site.normal});
                site.weights.push_back(static_cast<float>(random(0, 2)));
            }
            places.push_back(site);
            received.push_back(glm::vec3(random(0, 9), random(0, 9), random(0, 9)));
            order.push_back(static_cast<cl_uint>((i * 5 + 2) % 23));
        }
        for (int i = 0; i < 197; ++i) {
            const glm::vec3 normal = test::direction(random);
            texels.push_back({glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)),
                              glm::normalize(normal + 0.5f * test::direction(random)), normal});
        }
    }
    test::Sites sites() const {
        test::Sites out(places, order, received);
        // Factors have no part in it.
        out.balance(BALANCE_SHOOTER, std::vector<float>(23, nan));
        out.balance(BALANCE_RECEIVER, std::vector<float>(23, nan));
        return out;
    }
};

CLGI_IN_BOTH_MATHS(Gather);

// VPLs and texels all over the place, nothing between them.
TEST_P(Gather, AddsWhatEveryVplSendsInEveryChannel) {
    const Crowd crowd;
    const test::Sites sites = crowd.sites();
    int near_by = 0, far = 0;
    for (const std::uint32_t batch : {23u, 4u}) {
        const Filled found = gather(sites, crowd.texels, batch, test::atlas_passes(GetParam()));
        for (std::size_t t = 0; t < crowd.texels.size(); ++t) {
            const SurfacePlace& texel = crowd.texels[t];
            glm::dvec3 sum(0.0, 0.25, 0.5), condition = sum;
            double filled = 0.5, filled_condition = 0.5;
            bool doubtful = false;
            for (std::size_t i = 0; i < crowd.places.size(); ++i) {
                const SitePlace& site = crowd.places[i];
                const glm::dvec3 d = glm::dvec3(texel.position) - glm::dvec3(site.position);
                const double back = glm::dot(d, glm::dvec3(texel.geometric));
                const double above = glm::dot(d, glm::dvec3(site.normal));
                doubtful |= std::abs(back) < 1e-6 || std::abs(above) < 1e-6;
                if (!(back < 0.0 && above > 0.0)) continue;
                const test::Exchanged e =
                    test::exchange(site, glm::dvec3(texel.position), glm::dvec3(texel.normal));
                doubtful |= e.doubtful;
                const double share = site.area / test::pi;
                filled += share * e.even;
                filled_condition += share * e.even_condition;
                const glm::dvec3 radiosity =
                    glm::dvec3(site.albedo) * glm::dvec3(crowd.received[i]);
                sum += share * e.factor * radiosity;
                condition += share * e.condition * radiosity;
                if (e.factor > 0.0) ++(e.near_by ? near_by : far);
            }
            if (doubtful) continue;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found.irradiance[c * found.stride + t], sum[c], 3e-6 * condition[c])
                    << t;
            EXPECT_NEAR(found.filled[t], filled, 3e-6 * filled_condition) << t;
        }
    }
    EXPECT_GT(near_by, 100);
    EXPECT_GT(far, 300);
}

// One small VPL of flux P over a floor: E = P / pi cos cos' / d^2, with cos = cos' = h / d.
TEST_P(Gather, OfOneVplOverAFloorIsAPointLight) {
    const double height = 0.4, area = 1e-7;
    const glm::vec3 albedo(0.2f, 0.5f, 0.9f), received(3.0f, 20.0f, 70.0f), down(0, -1, 0);
    SitePlace site{
        {0, float(height), 0}, down, float(area), albedo, {{{0, float(height), 0}, down, down}}};
    test::Sites sites({site}, {}, {received});
    sites.balance(BALANCE_SHOOTER, {1.25f});
    std::vector<SurfacePlace> texels;
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 up(0, 1, 0);
        texels.push_back({{0.07f * static_cast<float>(i % 10) - 0.3f, 0,
                           0.07f * static_cast<float>(i / 10) - 0.4f},
                          up,
                          up});
    }
    Scene world = test::plain_scene();
    test::add_floor(world, 1.0);
    const DeviceScene scene = test::on_device(world);  // as large in its local frame
    ASSERT_EQ(scene.frame().to_local(glm::dvec3(0)), glm::vec3(0));
    for (SurfacePlace& texel : texels)
        texel.position = scene.frame().to_local(glm::dvec3(texel.position));
    const Filled found = gather(sites, texels, 1, test::atlas_passes(GetParam()), 0, &scene);
    for (std::size_t t = 0; t < texels.size(); ++t) {
        const glm::dvec3 d = glm::dvec3(texels[t].position) - glm::dvec3(site.position);
        const double form = area / test::pi * d.y * d.y / std::pow(glm::dot(d, d), 2);
        EXPECT_NEAR(found.filled[t] - 0.5, form, 1e-7);
        for (int c = 0; c < 3; ++c) {
            const double wanted = 0.25 * c + form * double{albedo[c]} * received[c];
            EXPECT_NEAR(found.irradiance[c * found.stride + t], wanted, 1e-6 * wanted);
        }
    }
}

TEST(Gather, IsTheSameForEveryWidthGroupAndPart) {
    const Crowd crowd;
    const test::Sites sites = crowd.sites();
    const Filled usual = gather(sites, crowd.texels, 23);
    for (const int width : {1, 4, 8, 16}) {
        BuildOptions build;
        build.packet_width = width;
        build.local_size = width == 4 ? 1 : 0;
        const AtlasPasses passes(test::programs(), build);
        const Filled whole = gather(sites, crowd.texels, 23, passes);
        const Filled part = gather(sites, crowd.texels, 23, passes, 96);
        for (std::size_t t = 0; t < crowd.texels.size(); ++t) {
            EXPECT_EQ(whole.filled[t], usual.filled[t]) << width;
            EXPECT_EQ(part.filled[t], t < 96 ? 0.5f : usual.filled[t]) << width;
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t at = c * usual.stride + t;
                EXPECT_EQ(whole.irradiance[at], usual.irradiance[at]);
                EXPECT_EQ(part.irradiance[at],
                          t < 96 ? 0.25f * static_cast<float>(c) : usual.irradiance[at]);
            }
        }
    }
}

// ---- nearest
// ----------------------------------------------------------------------------------------

TEST(Nearest, IsTheReachOfTheNearestVplThatFacesTheSameWay) {
    test::Random random(33);
    for (const int width : {1, 4, 8, 16}) {
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
            0, 40, sites.buffers.stride, sites.buffers.sample_stride, count, stride, 48, 1};
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
        test::atlas_passes().nearest(test::device().queue, {0, sites_used, 16, 16, 1, 16, 0, 1},
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
    for (const int width : {1, 4, 8, 16}) {
        const std::uint32_t count = 61, stride = 64;
        std::vector<float> reach(stride, nan), filled(stride, nan), light(3 * stride, nan);
        for (std::uint32_t t = 0; t < count; ++t) {
            reach[t] = cases[t % 11].reach;
            filled[t] = cases[t % 11].filled;
            for (std::uint32_t c = 0; c < 3; ++c)
                light[c * stride + t] =
                    1.0f + 3.0f * static_cast<float>(c) + 0.01f * static_cast<float>(t);
        }
        const cl::Buffer out = test::upload(light), bad = test::upload(std::vector<cl_uint>{0});
        AtlasPasses(test::programs(), {.packet_width = width})
            .complete(test::device().queue, {0, 0, 0, 0, count, stride, 16, 1}, test::upload(reach),
                      test::upload(filled), out, bad);
        const auto found = test::download<float>(out, 3 * stride);
        EXPECT_EQ(test::download<cl_uint>(bad, 1)[0], 0u) << width;
        for (std::uint32_t t = 0; t < count; ++t)
            for (std::uint32_t c = 0; c < 3; ++c) {
                const double wanted =
                    double{light[c * stride + t]} * (t < 16 ? 1.0 : double{cases[t % 11].raised});
                EXPECT_NEAR(found[c * stride + t], wanted, 2e-7 * wanted) << "texel " << t;
            }
    }
}

TEST(Complete, CountsPacketsThatAreNotFinite) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const int width : {1, 4, 16})
        for (const float value : {nan, infinity, -infinity, 3e38f})
            for (std::uint32_t c = 0; c < 3; ++c) {
                std::vector<float> light(3 * 64, 1.0f);
                light[c * 64 + 3] = light[c * 64 + 60] = value;
                light[c * 64 + 61] = nan;  // beyond the last texel
                const cl::Buffer bad = test::upload(std::vector<cl_uint>{0});
                AtlasPasses(test::programs(), {.packet_width = width})
                    .complete(test::device().queue, {0, 0, 0, 0, 61, 64, 0, 1},
                              test::upload(std::vector<float>(64, 1.0f)),
                              test::upload(std::vector<float>(64, 0.5f)), test::upload(light), bad);
                EXPECT_EQ(test::download<cl_uint>(bad, 1)[0], 2u) << width << " " << value;
            }
}

TEST(Fill, OfNothingIsFine) {
    const test::Sites sites({{{0, 0, 0}, {0, 0, 1}, 0.1f, glm::vec3(1.0f), {{{}, {}, {}}}}});
    const cl::Buffer any = test::upload(std::vector<float>(1024, 7.0f));
    const FillParams params{0, 0, 16, 16, 0, 16, 0, 1};
    const cl::CommandQueue& queue = test::device().queue;
    const AtlasPasses& passes = test::atlas_passes();
    passes.gather(queue, params, sites.buffers, any, any, any, any, any).wait();
    passes.nearest(queue, params, sites.buffers, any, any).wait();
    passes.complete(queue, params, any, any, any, any).wait();
    EXPECT_EQ(test::download<float>(any, 1024), std::vector<float>(1024, 7.0f));
}

}  // namespace
}  // namespace clgi
