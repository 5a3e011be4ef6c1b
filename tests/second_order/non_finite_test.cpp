// Numbers that are not finite, wherever they come from: the picture is finite and they are counted.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frames.hpp"
#include "math_modes.hpp"
#include "oblique.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

using test::ShadedPixel;
using test::Shading;

constexpr float infinity = std::numeric_limits<float>::infinity();
const float nan_value = std::numeric_limits<float>::quiet_NaN();

// One sun, all effects, 33 pixels of one lit glossy surface.
Shading lit_surface() {
    Scene scene = test::oblique_room();
    scene.lights = {test::oblique_sun()};
    const DeviceScene placed = test::on_device(scene);
    const EmitterSet set = make_emitters(placed, {.vpls = 1, .shadow_size = 8});
    Shading out;
    out.emitters = set.emitters;
    out.views = set.views;
    out.materials = scene.materials;
    out.visibility.resize(set.pixels, ~std::uint64_t{0});
    out.view = make_view(test::oblique_camera(), placed.frame(), 40, 30);
    out.params.exposure = 1.0f;
    out.params.texel_bias = 1.5f;
    out.params.effects = COMBINE_DIRECT | COMBINE_INDIRECT | COMBINE_EMISSION | COMBINE_SPECULAR;
    for (int i = 0; i < 33; ++i) {
        ShadedPixel pixel;
        pixel.position = {0.01f * static_cast<float>(i), 0.02f, -0.03f};
        pixel.normal = pixel.geometric = glm::normalize(glm::vec3(-0.2f, 0.9f, 0.3f));
        pixel.base = {0.6f, 0.4f, 0.7f};
        pixel.emission = {0.1f, 0.2f, 0.3f};
        pixel.irradiance = {1.0f, 2.0f, 3.0f};
        pixel.material = 3;
        out.pixels.push_back(pixel);
    }
    return out;
}

// In packets and in scalars, which compilers treat differently in fast math.
void expect_counted(const Shading& in, const std::string& what) {
    for (const int width : {0, 1}) {
        BuildOptions build = test::usual_build();
        if (width > 0) build.packet_width = width;
        const test::Combined found = test::combine(in, ImagePasses(test::programs(), build));
        EXPECT_GT(found.non_finite, 0u) << what << ": not counted";
        for (const glm::vec3& radiance : found.radiance)
            for (int c = 0; c < 3; ++c)
                EXPECT_TRUE(std::isfinite(radiance[c]) && radiance[c] >= 0.0f) << what;
    }
}

struct Place {
    const char* name;
    glm::vec3 ShadedPixel::*member;
};

class NonFinite : public testing::TestWithParam<Place> {};
CLGI_IN_ALL_MODES(NonFiniteIrradiance);
CLGI_IN_ALL_MODES(NonFiniteIndirectLight);

TEST_P(NonFinite, IsCountedAndMended) {
    EXPECT_EQ(test::combine(lit_surface()).non_finite, 0u);
    for (const float value : {nan_value, -nan_value, infinity})
        for (int channel = 0; channel < 3; ++channel) {
            Shading in = lit_surface();
            (in.pixels[17].*GetParam().member)[channel] = value;
            expect_counted(in, std::string(GetParam().name) + " " + std::to_string(value) +
                                   " in channel " + std::to_string(channel));
        }
}

INSTANTIATE_TEST_SUITE_P(Planes, NonFinite,
                         testing::Values(Place{"irradiance", &ShadedPixel::irradiance},
                                         Place{"emission", &ShadedPixel::emission},
                                         Place{"base", &ShadedPixel::base},
                                         Place{"position", &ShadedPixel::position},
                                         Place{"normal", &ShadedPixel::normal},
                                         Place{"geometric", &ShadedPixel::geometric}),
                         [](const auto& given) { return std::string(given.param.name); });

// More was taken away than there can be: that is not a dark place but a broken sum.
TEST_P(NonFiniteIrradiance, IsCountedBelowZeroToo) {
    for (int channel = 0; channel < 3; ++channel) {
        Shading in = lit_surface();
        in.pixels[17].irradiance[channel] = -infinity;
        expect_counted(in, "channel " + std::to_string(channel));
    }
}

// A pixel beside the broken one keeps its value.
TEST_P(NonFiniteIrradiance, LeavesItsNeighboursAsTheyAre) {
    Shading in = lit_surface();
    const auto usual = test::combine(in).radiance;
    in.pixels[17].irradiance.y = nan_value;
    const auto found = test::combine(in).radiance;
    for (std::size_t i = 0; i < usual.size(); ++i)
        EXPECT_TRUE(i == 17 || found[i] == usual[i]) << i;
}

TEST(NonFiniteEmission, BecomesNothingOrTheLargestNumber) {
    for (const auto& [value, wanted] : {std::pair(nan_value, 0.0f),
                                        {infinity, std::numeric_limits<float>::max()},
                                        {-infinity, 0.0f}})
        for (int channel = 0; channel < 3; ++channel) {
            Shading in = lit_surface();
            in.pixels[17].emission[channel] = value;
            const test::Combined found = test::combine(in);
            EXPECT_EQ(found.non_finite, 1u) << "packets";
            EXPECT_EQ(found.radiance[17][channel], wanted) << value;
        }
}

TEST(NonFiniteEmitter, IsCounted) {
    for (const float value : {nan_value, infinity})
        for (int channel = 0; channel < 3; ++channel) {
            Shading in = lit_surface();
            in.emitters[0].intensity[channel] = value;
            expect_counted(in, "intensity " + std::to_string(value));
        }
}

// From an indirect light through the gather to the picture.
TEST_P(NonFiniteIndirectLight, IsCountedInThePicture) {
    const glm::vec3 normal = lit_surface().pixels[0].normal;
    for (const bool negative : {false, true})
        for (const float value : {nan_value, infinity})
            for (int channel = 0; channel < 3; ++channel) {
                Shading in = lit_surface();
                Vpl light{glm::vec4(0.1f, 0.6f, 0.1f, 1e-3f), glm::vec4(-normal, 1e-6f),
                          glm::vec4(1.0f)};
                light.flux[channel] = value;
                std::vector<test::Receiver> receivers;
                for (const ShadedPixel& pixel : in.pixels)
                    receivers.push_back({pixel.position, pixel.normal});
                const std::vector<Vpl> lights{light}, none;
                const auto irradiance =
                    test::gather(receivers, negative ? none : lights, negative ? lights : none);
                for (std::size_t i = 0; i < in.pixels.size(); ++i)
                    in.pixels[i].irradiance = irradiance[i];
                expect_counted(
                    in, std::string(negative ? "negative " : "positive ") + std::to_string(value));
            }
}

}  // namespace
}  // namespace clgi
