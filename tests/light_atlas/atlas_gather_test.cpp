// Light that VPLs send to the texels that they see, in double precision. Who sees whom is given.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "math_modes.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

using test::SitePlace;
using test::SurfacePlace;

using test::nan;
constexpr std::uint32_t site_count = 23, listed_count = 18, texel_count = 197;

// VPLs and texels all over the place; of the VPLs some are listed, in any order. The others have
// powers that are no numbers.
struct Crowd {
    std::vector<SitePlace> places;
    std::vector<SurfacePlace> texels;
    std::vector<cl_uint> order;
    std::vector<bool> sees;  // [site_count][texel_count]
    Crowd() {
        test::Random random(31);
        for (std::uint32_t i = 0; i < site_count; ++i) {
            SitePlace site;
            site.position = glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1));
            site.normal = test::direction(random);
            site.area = static_cast<float>(std::exp(random(std::log(0.003), std::log(0.3))));
            site.albedo = glm::vec3(nan);
            const float radius = std::sqrt(site.area / CLGI_PI);
            const int samples = random.integer(1, 13);
            site.power = color(random);
            for (int k = 0; k < samples; ++k) {
                glm::vec3 across = test::direction(random) * radius;
                across -= 0.97f * glm::dot(across, site.normal) * site.normal;
                site.samples.push_back({site.position + across, site.normal, site.normal});
                site.powers.push_back(color(random) / static_cast<float>(samples));
            }
            order.push_back((i * 5 + 2) % site_count);
            places.push_back(site);
        }
        for (std::uint32_t k = listed_count; k < site_count; ++k) {
            places[order[k]].power = glm::vec3(nan);
            for (glm::vec3& power : places[order[k]].powers) power = glm::vec3(nan);
        }
        for (std::uint32_t i = 0; i < texel_count; ++i)
            texels.push_back({glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)),
                              test::direction(random), glm::vec3(nan)});
        for (std::uint32_t k = 0; k < site_count * texel_count; ++k)
            sees.push_back(random.integer(0, 2) > 0);
    }
    // What changes may take light away.
    static glm::vec3 color(test::Random& random) {
        return glm::vec3(random(-2, 9), random(-2, 9), random(-2, 9));
    }
    bool lights(std::uint32_t site, std::size_t texel) const {
        return sees[site * texel_count + texel];
    }
    test::Sites sites() const {
        test::Sites out(places, order);
        out.buffers.listed = test::upload(std::vector<cl_uint>{listed_count});
        return out;
    }
    // Bits of `count` VPLs of the list, or (kept) of all sites by their number; other bits are 1.
    cl::Buffer seen(std::uint32_t first, std::uint32_t count, bool kept) const {
        const std::uint32_t stride = test::padded(texel_count);
        std::vector<cl_uchar> out(seen_rows(kept ? site_count : count) * stride, 0xff);
        for (std::uint32_t k = 0; k < (kept ? site_count : count); ++k)
            for (std::uint32_t t = 0; t < texel_count; ++t)
                if (!lights(kept ? k : order[first + k], t))
                    out[k / SEEN_VPLS * stride + t] &=
                        static_cast<cl_uchar>(~(1u << k % SEEN_VPLS));
        return test::upload(out);
    }
};

struct Filled {
    std::vector<float> gathered, filled;
    std::uint32_t stride;
};

// Batches of VPLs after what was there before, 0.25 times the channel's number.
// open: to all whom nothing hides, which bits do not say.
Filled gather(const Crowd& crowd, std::uint32_t batch, std::uint32_t flags,
              const AtlasPasses& passes = test::atlas_passes(), std::uint32_t first_texel = 0,
              bool open = false, float lift = 0.0f) {
    const test::Sites sites = crowd.sites();
    const SiteBuffers& b = sites.buffers;
    Filled out;
    out.stride = test::padded(texel_count);
    std::vector<float> before(3 * out.stride);
    for (std::size_t k = 0; k < before.size(); ++k)
        before[k] = 0.25f * static_cast<float>(k / out.stride);
    const cl::Buffer gathered = test::upload(before);
    const cl::Buffer filled = test::upload(std::vector<float>(out.stride, 0.5f));
    const cl::Buffer planes = test::upload_points(crowd.texels, out.stride,
                                                  (open ? GBUFFER_GEOMETRIC : GBUFFER_NORMAL) + 3);
    for (std::uint32_t first = 0; first < site_count; first += batch) {
        const std::uint32_t count = std::min(batch, site_count - first);
        const FillParams params{first,       count,      b.stride,    b.sample_stride,
                                texel_count, out.stride, first_texel, flags,
                                lift,        0,          0,           0};
        const cl::CommandQueue& queue = test::device().queue;
        if (open)
            passes.gather_open(queue, params, b, planes, gathered, filled);
        else
            passes.gather(queue, params, b, planes,
                          crowd.seen(first, count, (flags & FILL_KEPT) != 0), gathered, filled);
    }
    out.gathered = test::download<float>(gathered, before.size());
    out.filled = test::download<float>(filled, out.stride);
    return out;
}

// Irradiance of three channels and the form factor, and the same if all cosines were 1.
struct Lit {
    glm::dvec4 value = glm::dvec4(0.0), condition = glm::dvec4(0.0);
    bool near_by = false, doubtful = false;
};

// Far away a disc with the power of the site, near by a disc for every sample, with its own.
Lit lit_by(const SitePlace& site, const SurfacePlace& texel) {
    Lit out;
    const glm::dvec3 p(texel.position), n(texel.normal);
    const test::Exchanged whole = test::exchange(site, p, n);
    out.near_by = whole.near_by;
    out.doubtful = whole.doubtful;
    const auto add = [&](const glm::vec3& power, double area, double factor, double condition) {
        const glm::dvec4 of(glm::dvec3(power), area);
        out.value += of * factor / test::pi;
        out.condition += glm::abs(of) * condition / test::pi;
    };
    if (!out.near_by) {
        add(site.power, site.area, whole.factor, whole.condition);
        return out;
    }
    const double count = static_cast<double>(site.samples.size());
    for (std::size_t k = 0; k < site.samples.size(); ++k) {
        SitePlace part = site;
        part.position = site.samples[k].position;
        const glm::dvec3 d = p - glm::dvec3(part.position);
        const double cosines =
            std::max(-glm::dot(d, n), 0.0) * std::max(glm::dot(d, glm::dvec3(site.normal)), 0.0);
        const double radius2 = double{site.area} / test::pi / count, square = glm::dot(d, d);
        add(site.powers[k], site.area / count, test::disc_kernel(cosines, square, radius2),
            test::disc_kernel(square, square, radius2));
    }
    return out;
}

CLGI_IN_BOTH_MATHS(Gather);

TEST_P(Gather, AddsWhatEveryListedVplSendsInEveryChannel) {
    const Crowd crowd;
    int near_by = 0, far = 0;
    for (const std::uint32_t batch : {23u, 9u, 8u, 4u})
        for (const bool kept : {false, true}) {
            const std::uint32_t flags = FILL_FORM_FACTORS | (kept ? std::uint32_t{FILL_KEPT} : 0u);
            const Filled found = gather(crowd, batch, flags, test::atlas_passes(GetParam()));
            for (std::size_t t = 0; t < crowd.texels.size(); ++t) {
                glm::dvec4 sum(0.0, 0.25, 0.5, 0.5), condition = sum;
                bool doubtful = false;
                for (std::uint32_t k = 0; k < listed_count; ++k) {
                    const std::uint32_t site = crowd.order[k];
                    if (!crowd.lights(site, t)) continue;
                    const Lit lit = lit_by(crowd.places[site], crowd.texels[t]);
                    sum += lit.value;
                    condition += lit.condition;
                    doubtful |= lit.doubtful;
                    if (lit.value.w > 0.0) ++(lit.near_by ? near_by : far);
                }
                if (doubtful) continue;
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(found.gathered[c * found.stride + t], sum[c], 3e-6 * condition[c])
                        << t << ", batch " << batch << ", kept " << kept;
                EXPECT_NEAR(found.filled[t], sum.w, 3e-6 * condition.w) << t;
            }
        }
    EXPECT_GT(near_by, 400);
    EXPECT_GT(far, 1200);
}

// The same crowd with geometric normals beside the shading ones: a VPL behind a texel's triangle
// lights it as little as one that looks away from it.
TEST_P(Gather, WithoutOcclusionAddsWhatFacesEachOther) {
    Crowd crowd;
    test::Random random(77);
    for (SurfacePlace& texel : crowd.texels)
        texel.geometric = glm::normalize(texel.normal + 0.3f * test::direction(random));
    constexpr float lift = 0.01f;
    int lit = 0, behind = 0;
    for (const std::uint32_t batch : {23u, 9u}) {
        const Filled found =
            gather(crowd, batch, FILL_FORM_FACTORS, test::atlas_passes(GetParam()), 0, true, lift);
        for (std::size_t t = 0; t < crowd.texels.size(); ++t) {
            glm::dvec4 sum(0.0, 0.25, 0.5, 0.5), condition = sum;
            bool doubtful = false;
            for (std::uint32_t k = 0; k < listed_count; ++k) {
                const SitePlace& site = crowd.places[crowd.order[k]];
                const SurfacePlace& texel = crowd.texels[t];
                const glm::dvec3 d = glm::dvec3(texel.position) - glm::dvec3(site.position);
                const double above = glm::dot(d, glm::dvec3(site.normal)) - double{lift};
                const double back = glm::dot(d, glm::dvec3(texel.geometric));
                doubtful |= std::abs(above) < 1e-6 || std::abs(back) < 1e-6;
                const Lit term = lit_by(site, texel);
                if (!(above > 0.0 && back < 0.0)) {
                    behind += term.value.w > 0.0;
                    continue;
                }
                sum += term.value;
                condition += term.condition;
                doubtful |= term.doubtful;
                lit += term.value.w > 0.0;
            }
            if (doubtful) continue;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found.gathered[c * found.stride + t], sum[c], 3e-6 * condition[c]) << t;
            EXPECT_NEAR(found.filled[t], sum.w, 3e-6 * condition.w) << t;
        }
    }
    EXPECT_GT(lit, 1000);
    EXPECT_GT(behind, 50);
}

TEST(Gather, WithoutOcclusionIsTheSameForEveryWidthGroupAndPart) {
    Crowd crowd;
    for (SurfacePlace& texel : crowd.texels) texel.geometric = texel.normal;
    const Filled usual = gather(crowd, 23, FILL_FORM_FACTORS, test::atlas_passes(), 0, true);
    for (const int width : test::widths()) {
        BuildOptions build;
        build.packet_width = width;
        build.local_size = width == 4 ? 1 : 0;
        const Filled part =
            gather(crowd, 7, FILL_FORM_FACTORS, AtlasPasses(test::programs(), build), 96, true);
        for (std::size_t t = 0; t < texel_count; ++t)
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_EQ(
                    part.gathered[c * usual.stride + t],
                    t < 96 ? 0.25f * static_cast<float>(c) : usual.gathered[c * usual.stride + t])
                    << width;
    }
}

TEST(Gather, IsTheSameInBatchesOfAnySizeKeptOrNot) {
    const Crowd crowd;
    const Filled usual = gather(crowd, 23, FILL_FORM_FACTORS);
    for (const std::uint32_t kept : {0u, std::uint32_t{FILL_KEPT}})
        for (const std::uint32_t batch : {1u, 8u, 23u}) {
            const Filled found = gather(crowd, batch, kept | FILL_FORM_FACTORS);
            for (std::size_t t = 0; t < texel_count; ++t) {
                EXPECT_EQ(found.filled[t], usual.filled[t]) << batch;
                for (std::size_t c = 0; c < 3; ++c)
                    EXPECT_EQ(found.gathered[c * usual.stride + t],
                              usual.gathered[c * usual.stride + t])
                        << batch;
            }
        }
}

TEST(Gather, SumsFormFactorsIfAskedTo) {
    const Crowd crowd;
    for (const std::uint32_t kept : {0u, std::uint32_t{FILL_KEPT}}) {
        const Filled with = gather(crowd, 9, kept | FILL_FORM_FACTORS);
        const Filled without = gather(crowd, 9, kept);
        for (std::size_t t = 0; t < texel_count; ++t) {
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_EQ(with.gathered[c * with.stride + t],
                          without.gathered[c * with.stride + t]);
            EXPECT_EQ(without.filled[t], 0.5f);
        }
    }
}

TEST(Gather, OfAnEmptyListChangesNothing) {
    Crowd crowd;
    const test::Sites sites = crowd.sites();
    const SiteBuffers& b = sites.buffers;
    const std::uint32_t stride = test::padded(texel_count);
    const cl::Buffer light = test::upload(std::vector<float>(3 * stride, 4.0f));
    for (const cl_uint listed : {0u, 5u}) {
        SiteBuffers none = b;
        none.listed = test::upload(std::vector<cl_uint>{listed});
        test::atlas_passes().gather(test::device().queue,
                                    {listed, site_count - listed, b.stride, b.sample_stride,
                                     texel_count, stride, 0, FILL_KEPT | FILL_FORM_FACTORS},
                                    none,
                                    test::upload_points(crowd.texels, stride, GBUFFER_NORMAL + 3),
                                    crowd.seen(0, site_count, true), light, light);
        EXPECT_EQ(test::download<float>(light, 3 * stride), std::vector<float>(3 * stride, 4.0f));
    }
}

TEST(Gather, IsTheSameForEveryWidthGroupAndPart) {
    const Crowd crowd;
    for (const std::uint32_t flags :
         {std::uint32_t{FILL_FORM_FACTORS}, std::uint32_t{FILL_FORM_FACTORS | FILL_KEPT}}) {
        const Filled usual = gather(crowd, 23, flags);
        for (const int width : test::widths()) {
            BuildOptions build;
            build.packet_width = width;
            build.local_size = width == 4 ? 1 : 0;
            const AtlasPasses passes(test::programs(), build);
            const Filled whole = gather(crowd, 23, flags, passes);
            const Filled part = gather(crowd, 23, flags, passes, 96);
            for (std::size_t t = 0; t < crowd.texels.size(); ++t) {
                EXPECT_EQ(whole.filled[t], usual.filled[t]) << width;
                EXPECT_EQ(part.filled[t], t < 96 ? 0.5f : usual.filled[t]) << width;
                for (std::size_t c = 0; c < 3; ++c) {
                    const std::size_t at = c * usual.stride + t;
                    EXPECT_EQ(whole.gathered[at], usual.gathered[at]);
                    EXPECT_EQ(part.gathered[at],
                              t < 96 ? 0.25f * static_cast<float>(c) : usual.gathered[at]);
                }
            }
        }
    }
}

// One small VPL of flux P over a floor: E = P / pi cos cos' / d^2, with cos = cos' = h / d. Seen in
// its hemicube.
TEST_P(Gather, OfOneVplOverAFloorIsAPointLight) {
    const double height = 0.4, area = 1e-7;
    const glm::vec3 flux(2e-3f, 0.5f, 7.0f), up(0, 1, 0), down(0, -1, 0);
    const glm::vec3 at(0, float(height), 0);
    const test::Sites sites(
        {{at, down, float(area), glm::vec3(nan), {{at, down, down}}, flux, {glm::vec3(nan)}}});
    std::vector<SurfacePlace> texels;
    Scene world = test::plain_scene();
    test::add_floor(world, 1.0);
    const DeviceScene scene = test::on_device(world);  // as large in its local frame
    ASSERT_EQ(scene.frame().to_local(glm::dvec3(0)), glm::vec3(0));
    for (int i = 0; i < 100; ++i)
        texels.push_back(
            {scene.frame().to_local({0.07 * (i % 10) - 0.3, 0, 0.07 * (i / 10) - 0.4}), up, up});
    const AtlasPasses& passes = test::atlas_passes(GetParam());
    const std::uint32_t stride = test::padded(100);
    const SiteBuffers& b = sites.buffers;
    const cl::Buffer planes = test::upload_points(texels, stride, GBUFFER_GEOMETRIC + 3);
    const cl::Buffer seen = test::upload(std::vector<cl_uchar>(stride));
    const cl::Buffer light = test::upload(std::vector<float>(3 * stride));
    const cl::Buffer filled = test::upload(std::vector<float>(stride));
    test::see(test::hemicubes(sites, &scene), 100, planes, seen, 0, passes);
    passes.gather(test::device().queue,
                  {0, 1, b.stride, b.sample_stride, 100, stride, 0, FILL_FORM_FACTORS}, b, planes,
                  seen, light, filled);
    const auto found = test::download<float>(light, 3 * stride);
    const auto factors = test::download<float>(filled, stride);
    for (std::size_t t = 0; t < texels.size(); ++t) {
        const glm::dvec3 d = glm::dvec3(texels[t].position) - glm::dvec3(at);
        const double form = d.y * d.y / std::pow(glm::dot(d, d), 2) / test::pi;
        EXPECT_NEAR(factors[t], area * form, 1e-6 * area * form);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c * stride + t], form * double{flux[c]}, 1e-6 * form * flux[c]);
    }
}

}  // namespace
}  // namespace clgi
