// Probes of a picture: where they differ from what is shown, which pixels they flag, and what they
// mend.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "device.hpp"
#include "math_modes.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
using test::nan;

CLGI_IN_BOTH_MATHS(TransferProbes);

const ReceiverPasses& passes(Math math) { return test::shared_passes<ReceiverPasses>(math); }

// 6 x 5 pixels, probes at (1, 1), (3, 1), (5, 1), (1, 3) and so on.
constexpr std::uint32_t probe_stride = 16, picture_stride = 32;
const ProbeParams probing{6, 5, picture_stride, probe_stride, 2, 3, 2, 0.25f};

TEST_P(TransferProbes, AreComparedWithWhatIsShown) {
    std::vector<float> shown(3 * picture_stride), probes(4 * probe_stride);
    std::vector<int> ids(GBUFFER_ID_PLANES * picture_stride, 3);
    for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = static_cast<float>(i % 13) + 1.0f;
    const std::size_t pixels[] = {7, 9, 11, 19, 21, 23};
    for (std::size_t k = 0; k < 6; ++k)
        for (std::size_t c = 0; c < 3; ++c) {
            const float a = shown[c * picture_stride + pixels[k]];
            // More by a third and by half, of the larger one; channels that make up for each other.
            const float by[] = {1.3f, 1.4f, c == 0 ? 1.5f : 0.5f, 0.77f, 0.7f, 1.0f};
            probes[c * probe_stride + k] = k == 5 && c == 1 ? nan : a * by[k];
        }
    ids[GBUFFER_TRIANGLE * picture_stride + 21] = -1;
    GBuffer seen;
    seen.planes = test::empty<float>(GBUFFER_PLANES * picture_stride);
    seen.ids = test::upload(ids);
    seen.stride = picture_stride;
    const cl::Buffer values = test::upload(probes);
    const cl::Buffer states = test::upload(std::vector<cl_uint>(8, 9));
    passes(GetParam())
        .compare_probes(test::device().queue, probing, seen, test::upload(shown), values, states);
    EXPECT_EQ(test::download<cl_uint>(states, 8),
              (std::vector<cl_uint>{PROBE_AGREES, PROBE_FAILS, PROBE_FAILS, PROBE_AGREES,
                                    PROBE_NOWHERE, PROBE_FAILS, 9, 9}));
    const auto missing = test::download<float>(values, probes.size());
    for (std::size_t k = 0; k < 5; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(missing[c * probe_stride + k],
                        probes[c * probe_stride + k] - shown[c * picture_stride + pixels[k]], 1e-6);
    for (std::size_t k = 0; k < 6; ++k)
        EXPECT_EQ(missing[3 * probe_stride + k], shown[pixels[k]] +
                                                     shown[picture_stride + pixels[k]] +
                                                     shown[2 * picture_stride + pixels[k]]);
}

TEST_P(TransferProbes, ThatFailFlagPixelsAndTheOthersMend) {
    // What is missing is a linear function of the place of the probe.
    std::vector<float> missing(4 * probe_stride, 0.0f), shown(3 * picture_stride);
    const auto lacks = [](double x, double y, std::size_t c) {
        return static_cast<float>((1.0 + c) * x - 2.0 * y + 0.5 * c);
    };
    for (std::size_t k = 0; k < 6; ++k)
        for (std::size_t c = 0; c < 3; ++c)
            missing[c * probe_stride + k] = lacks(1 + 2.0 * (k % 3), 1 + 2.0 * (k / 3), c);
    for (std::size_t i = 0; i < shown.size(); ++i) shown[i] = static_cast<float>(i % 7);
    std::vector<int> ids(GBUFFER_ID_PLANES * picture_stride, 0);
    ids[GBUFFER_TRIANGLE * picture_stride + 8] = -1;
    GBuffer seen;
    seen.planes = test::empty<float>(GBUFFER_PLANES * picture_stride);
    seen.ids = test::upload(ids);
    seen.stride = picture_stride;
    const cl::Buffer values = test::upload(shown);
    const cl::Buffer flags = test::upload(std::vector<std::uint8_t>(32, 9));
    // The probe at (5, 3) fails; the one at (1, 3) sees nothing.
    const std::vector<cl_uint> states = {PROBE_AGREES,  PROBE_AGREES, PROBE_AGREES,
                                         PROBE_NOWHERE, PROBE_AGREES, PROBE_FAILS};
    passes(GetParam())
        .undersampled(test::device().queue, probing, seen, test::upload(missing),
                      test::upload(states), values, flags);
    const auto marks = test::download<std::uint8_t>(flags, 32);
    const auto found = test::download<float>(values, shown.size());
    for (std::uint32_t pixel = 0; pixel < 30; ++pixel) {
        const std::uint32_t x = pixel % 6, y = pixel / 6;
        const bool flagged = x >= 3 && y >= 1 && pixel != 8;
        EXPECT_EQ(marks[pixel], flagged ? 1 : 0) << pixel;
        // Exact where all four probes around are seen and agree; beside the border the nearest do.
        const double px = std::max(x, 1u), py = std::clamp(y, 1u, 3u);
        if (x < 3 && y > 1) continue;  // one of them sees nothing
        for (std::size_t c = 0; c < 3; ++c) {
            const std::size_t at = c * picture_stride + pixel;
            const float mend = flagged || pixel == 8 ? 0.0f : lacks(px, py, c);
            EXPECT_NEAR(found[at], shown[at] + mend, 1e-5) << pixel << ", " << c;
        }
    }
    // (2, 2): half of the square's probes at (1, 1) and (3, 1), a quarter at (3, 3).
    for (std::size_t c = 0; c < 3; ++c) {
        const float mean = (lacks(1, 1, c) + lacks(3, 1, c) + lacks(3, 3, c)) / 3.0f;
        EXPECT_NEAR(found[c * picture_stride + 14], shown[c * picture_stride + 14] + mean, 1e-5);
    }
    EXPECT_EQ(marks[30], 9);
}

// Where less is shown than at the probes, as much less is added: it is another surface.
TEST_P(TransferProbes, MendBySoMuchOfWhatIsShown) {
    // Probes show 8 in all, and miss 2, 1 and -0.5.
    std::vector<float> missing(4 * probe_stride), shown(3 * picture_stride);
    const float lacks[] = {2.0f, 1.0f, -0.5f, 8.0f};
    for (std::size_t c = 0; c < 4; ++c)
        for (std::size_t k = 0; k < 6; ++k) missing[c * probe_stride + k] = lacks[c];
    const auto level = [](std::uint32_t pixel) { return 0.5f * static_cast<float>(pixel % 9); };
    for (std::uint32_t pixel = 0; pixel < 30; ++pixel)
        for (std::size_t c = 0; c < 3; ++c)
            shown[c * picture_stride + pixel] = level(pixel) * static_cast<float>(c + 1);
    {
        GBuffer seen;
        seen.planes = test::empty<float>(GBUFFER_PLANES * picture_stride);
        seen.ids = test::upload(std::vector<int>(GBUFFER_ID_PLANES * picture_stride, 0));
        seen.stride = picture_stride;
        const cl::Buffer values = test::upload(shown);
        // The last probe sees nothing: what is left weighs less than 1.
        const std::vector<cl_uint> states = {PROBE_AGREES, PROBE_AGREES, PROBE_AGREES,
                                             PROBE_AGREES, PROBE_AGREES, PROBE_NOWHERE};
        passes(GetParam())
            .undersampled(test::device().queue, probing, seen, test::upload(missing),
                          test::upload(states), values, test::empty<std::uint8_t>(32));
        const auto found = test::download<float>(values, shown.size());
        for (std::uint32_t pixel = 0; pixel < 30; ++pixel) {
            const bool lost = pixel % 6 == 5 && pixel / 6 >= 3;  // the last probe's alone
            const float share = lost ? 0.0f : std::min(1.0f, 6.0f * level(pixel) / 8.0f);
            for (std::size_t c = 0; c < 3; ++c)
                EXPECT_NEAR(found[c * picture_stride + pixel],
                            shown[c * picture_stride + pixel] + share * lacks[c], 1e-5)
                    << pixel << ", " << c;
        }
    }
}

// Gloss counts as much as it is seen beside diffuse light, and only where there is a lobe.
TEST_P(TransferProbes, AreComparedWithTheGlossThatIsShown) {
    Scene world = test::plain_scene();
    Material metal, plastic;
    metal.metallic = 1.0f;
    metal.roughness = plastic.roughness = 0.5f;
    plastic.metallic = 0.0f;
    plastic.specular = 1.0f;
    test::add_material(world, metal);
    test::add_material(world, plastic);
    for (const std::uint32_t material : {0u, 1u, 2u})
        test::add_triangle(world, {0, 0, material}, {1, 0, material}, {0, 1, material}, material);
    world.materials[0].roughness = 1.0f;
    world.materials[0].metallic = 0.0f;
    const DeviceScene scene = test::on_device(world);
    const Reflectance shares[] = {reflectance(test::finished(0.0f, 1.0f)),
                                  reflectance(test::finished(1.0f, 0.5f)),
                                  reflectance(test::finished(0.0f, 0.5f, 1.0f))};
    ASSERT_GT(shares[1].lobe * shares[2].coat * shares[1].diffuse, 0.0f);
    // All gloss that is shown is 1. How much is it where more than a quarter of all light is
    // missing?
    const float base[] = {0.5f, 0.25f, 0.75f}, diffuse[] = {3.0f, 2.0f, 1.0f};
    const auto lobe = [&](int of, int c) {
        return (shares[of].coat + shares[of].lobe * base[c]) / test::lobe_mean(shares[of].exponent);
    };
    const auto edge = [&](int of) {
        double rest = 0.0, lobes = 0.0;
        for (int c = 0; c < 3; ++c) {
            rest += shares[of].diffuse / pi * base[c] * diffuse[c];
            lobes += lobe(of, c);
        }
        return (0.25 * rest + lobes) / (0.75 * lobes);
    };
    const std::size_t pixels[] = {7, 9, 11, 19, 21, 23};
    const int materials[] = {0, 1, 1, 2, 2, 1};
    const double gloss[] = {9.0, 0.99 * edge(1), 1.01 * edge(1), 0.99 * edge(2), 1.01 * edge(2), 1};
    std::vector<float> planes(GBUFFER_PLANES * picture_stride, 0.0f),
        light(3 * picture_stride, 0.0f), shown(3 * picture_stride, 0.0f), probes(4 * probe_stride);
    std::vector<int> ids(GBUFFER_ID_PLANES * picture_stride, -1);
    for (std::size_t k = 0; k < 6; ++k) {
        ids[GBUFFER_MATERIAL * picture_stride + pixels[k]] = materials[k];
        for (std::size_t c = 0; c < 3; ++c) {
            planes[(GBUFFER_BASE + c) * picture_stride + pixels[k]] = base[c];
            light[c * picture_stride + pixels[k]] = diffuse[c];
            shown[c * picture_stride + pixels[k]] = 1.0f;
            probes[c * probe_stride + k] = static_cast<float>(gloss[k]);
        }
    }
    // Channels that make up for each other.
    probes[probe_stride + 5] = 3.0f;
    probes[2 * probe_stride + 5] = 1.0f - 2.0f * lobe(1, 1) / lobe(1, 2);
    GBuffer seen;
    seen.planes = test::upload(planes);
    seen.ids = test::upload(ids);
    seen.stride = picture_stride;
    const cl::Buffer values = test::upload(probes);
    const auto states_after = [&](const std::vector<cl_uint>& before, const cl::Buffer& with) {
        const cl::Buffer states = test::upload(before);
        passes(GetParam())
            .compare_gloss(test::device().queue, probing, scene, seen, test::upload(light),
                           test::upload(shown), with, states);
        return test::download<cl_uint>(states, 8);
    };
    EXPECT_EQ(states_after({1, 1, 1, 1, 1, 1, 9, 9}, values),
              (std::vector<cl_uint>{PROBE_AGREES, PROBE_AGREES, PROBE_FAILS, PROBE_AGREES,
                                    PROBE_FAILS, PROBE_FAILS, 9, 9}));
    const auto missing = test::download<float>(values, probes.size());
    for (std::size_t k = 0; k < 6; ++k) {
        for (std::size_t c = 0; c < 3; ++c)
            EXPECT_NEAR(missing[c * probe_stride + k],
                        k == 0 ? 0.0f : probes[c * probe_stride + k] - 1.0f, 1e-6)
                << k;
        EXPECT_EQ(missing[3 * probe_stride + k], k == 0 ? 0.0f : 3.0f) << k;
    }
    // What has failed, or shows nothing, stays so; what is not finite fails where there is a lobe.
    probes[0] = probes[3] = nan;
    probes[4] = std::numeric_limits<float>::infinity();
    probes[2] = 1.0f, probes[probe_stride + 2] = 1.0f, probes[2 * probe_stride + 2] = 1.0f;
    EXPECT_EQ(states_after({1, 1, 2, 1, 1, 0, 9, 9}, test::upload(probes)),
              (std::vector<cl_uint>{PROBE_AGREES, PROBE_AGREES, PROBE_FAILS, PROBE_FAILS,
                                    PROBE_FAILS, PROBE_NOWHERE, 9, 9}));
}

}  // namespace
}  // namespace clgi
