// Direct light at given points: what is not finite is counted and shown, and its neighbours keep
// their light; what is there is added to, or not.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lighting.hpp"
#include "math_modes.hpp"
#include "oblique.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t points = 37, stride = 48, broken = 21;

struct Lit {
    std::vector<glm::vec3> irradiance;
    std::uint32_t non_finite = 0;
};

// One sun, `points` of one open surface; `value` at the place `broken` of a plane.
struct Surface {
    Surface() {
        Scene scene = test::oblique_room();
        scene.lights = {test::oblique_sun()};
        set = make_emitters(test::on_device(scene), {.vpls = 1, .shadow_size = 8});
        visibility.assign(set.pixels, ~std::uint64_t{0});
        const glm::vec3 normal = glm::normalize(glm::vec3(-0.2f, 0.9f, 0.3f));
        for (std::uint32_t i = 0; i < points; ++i)
            for (int c = 0; c < 3; ++c) {
                planes[(GBUFFER_POSITION + c) * stride + i] = 0.01f * static_cast<float>(i - c);
                planes[(GBUFFER_NORMAL + c) * stride + i] = normal[c];
                planes[(GBUFFER_GEOMETRIC + c) * stride + i] = normal[c];
            }
    }

    // add: to `before`, which is there.
    Lit lit(bool add = false, float before = 0.0f) const {
        const test::Device& on = test::device();
        const cl::Buffer irradiance =
            test::upload_irradiance(std::vector<float>(IRRADIANCE_PLANES * stride, before));
        const cl::Buffer non_finite = test::upload(std::vector<cl_uint>(1));
        const EmitterBuffers sources{test::upload(set.emitters), test::upload(set.views),
                                     test::upload(visibility)};
        const auto emitters = static_cast<std::uint32_t>(set.emitters.size());
        test::light_passes().direct(
            on.queue, {stride, points, emitters, 1.0f, 2, add ? 1u : 0u, 0, 0}, sources,
            test::upload_planes(planes, stride), irradiance, non_finite);
        const auto found = test::read_irradiance(irradiance, stride);
        Lit out;
        out.non_finite = test::download<cl_uint>(non_finite, 1)[0];
        for (std::uint32_t i = 0; i < points; ++i)
            out.irradiance.emplace_back(found[i], found[stride + i], found[2 * stride + i]);
        return out;
    }

    EmitterSet set;
    std::vector<std::uint64_t> visibility;
    std::vector<float> planes = std::vector<float>(GBUFFER_PLANES * stride);
};

CLGI_IN_ALL_MODES(DirectLight);

TEST_P(DirectLight, CountsAndShowsWhatIsNotFinite) {
    const Surface open;
    const Lit usual = open.lit();
    EXPECT_EQ(usual.non_finite, 0u);
    EXPECT_GT(usual.irradiance[broken].x, 0.0f);
    const float infinity = std::numeric_limits<float>::infinity();
    for (const int plane : {GBUFFER_POSITION, GBUFFER_NORMAL, GBUFFER_GEOMETRIC})
        for (int c = 0; c < 3; ++c)
            for (const float value : {std::nanf(""), -std::nanf(""), infinity, -infinity}) {
                Surface surface;
                surface.planes[(plane + c) * stride + broken] = value;
                const Lit found = surface.lit();
                EXPECT_EQ(found.non_finite, 1u) << plane + c << ' ' << value;
                for (std::uint32_t i = 0; i < points; ++i) {
                    if (i == broken)
                        EXPECT_TRUE(std::isnan(found.irradiance[i].x) &&
                                    std::isnan(found.irradiance[i].y) &&
                                    std::isnan(found.irradiance[i].z))
                            << plane + c << ' ' << value;
                    else
                        EXPECT_EQ(found.irradiance[i], usual.irradiance[i]) << i;
                }
            }
}

TEST(DirectLight, TakesThePlaceOfWhatIsThereOrIsAddedToIt) {
    const Surface surface;
    const Lit usual = surface.lit(), over = surface.lit(false, 3.5f), sum = surface.lit(true, 3.5f);
    for (std::uint32_t i = 0; i < points; ++i) {
        EXPECT_GT(usual.irradiance[i].x, 0.0f);
        EXPECT_EQ(over.irradiance[i], usual.irradiance[i]) << i;
        EXPECT_EQ(sum.irradiance[i], usual.irradiance[i] + 3.5f) << i;
    }
}

// A source of too much light breaks every point that it reaches, in its channel at least.
TEST(DirectLight, OfASourceThatIsNotFiniteIsCounted) {
    for (int c = 0; c < 3; ++c) {
        Surface surface;
        surface.set.emitters[0].intensity[c] = std::numeric_limits<float>::infinity();
        const Lit found = surface.lit();
        EXPECT_GT(found.non_finite, 0u);
        for (const glm::vec3& e : found.irradiance) EXPECT_TRUE(std::isnan(e[c]));
    }
}

}  // namespace
}  // namespace clgi
