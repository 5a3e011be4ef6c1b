// Kernels built with -cl-denorms-are-zero: bounds hold where denormals are flushed.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <limits>
#include <numbers>

#include "math_modes.hpp"
#include "oblique.hpp"
#include "opencl_calls.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double u = 0x1p-24;

// Kernels of its own: those of other tests are built without the option.
struct Flushing {
    Flushing() { test::calls.build_option = " -cl-denorms-are-zero"; }
    ~Flushing() { test::calls.clear(); }
    Programs programs{test::device().context, test::device().device};
    ImagePasses passes{programs, test::usual_build()};
};

CLGI_IN_BOTH_MATHS(DenormalsInFloats);
CLGI_IN_ALL_MODES(Denormals);

// A light at the origin that looks along z, 1 lumen.
Vpl light_of(float area) {
    const float radius2 = area / static_cast<float>(pi);
    return {glm::vec4(0, 0, 0, radius2), glm::vec4(0, 0, 1, radius2 * radius2), glm::vec4(1.0f)};
}

// Otherwise the tests below would show nothing. The option is a hint; PoCL takes it.
TEST_P(DenormalsInFloats, AreFlushedByPocl) {
    const cl::Platform platform(test::device().device.getInfo<CL_DEVICE_PLATFORM>());
    const bool pocl =
        platform.getInfo<CL_PLATFORM_NAME>().rfind("Portable Computing Language", 0) == 0;
    test::Shading in;
    in.params.exposure = 1.0f;
    in.params.effects = COMBINE_EMISSION | COMBINE_INDIRECT;
    test::ShadedPixel pixel;
    pixel.normal = pixel.geometric = {0, 0, 1};
    pixel.base = glm::vec3(1e-30f);
    pixel.irradiance = glm::vec3(1e-10f);
    in.pixels.assign(3, pixel);
    in.emitters.resize(1);
    in.views.resize(1);
    in.visibility.resize(1);
    in.materials.resize(1);
    if (GetParam() == Math::strict) {
        EXPECT_GT(test::combine(in).radiance[0].x, 0.0f);
    }
    if (!pocl) return;  // others may
    EXPECT_EQ(test::combine(in, Flushing().passes).radiance[0].x, 0.0f);
}

// Squares of distances and radii are denormal or flushed at many of these places.
TEST_P(Denormals, LeaveTheGatherWithinItsBounds) {
    const Flushing flushing;
    for (const float area : {1e-3f, 1e-12f, 1e-30f}) {
        std::vector<test::Receiver> receivers;
        for (int power = -40; power <= 5; ++power)
            receivers.push_back({{0.0f, 0.0f, std::pow(10.0f, static_cast<float>(power))},
                                 test::stored(glm::normalize(glm::vec3(0.3f, 0.2f, -0.9f)))});
        const Vpl light = light_of(area);
        const auto found = test::gather(receivers, {light}, {}, flushing.passes);
        for (std::size_t i = 0; i < found.size(); ++i) {
            const double d = receivers[i].position.z, square = d * d, r2 = light.position.w;
            const double far = square + r2, bound = square * far + r2 * r2;
            const double wanted = -double{receivers[i].normal.z} * far / (pi * bound);
            ASSERT_TRUE(std::isfinite(found[i].x)) << d;
            EXPECT_GE(found[i].x, 0.0f);
            EXPECT_LE(found[i].x, (1 + 18 * u + test::half_error()) / double{area});
            if (test::half_error() > 0.0 && wanted > 65504.0) continue;
            // Below, the floor of the denominator counts, or d^2 is 0.
            if (square > 0x1p-100 && square * bound > 0x1p-100) {
                EXPECT_NEAR(found[i].x, wanted,
                            (18 * u + test::half_error()) * wanted + test::half_error() * 0x1p-14)
                    << d << ", " << area;
            }
        }
    }
}

// A pixel under the sun whose other light, or whose colour, is denormal.
TEST_P(Denormals, AreNoLightInPictures) {
    const Flushing flushing;
    Scene scene = test::oblique_room();
    scene.lights = {test::oblique_sun()};
    const DeviceScene placed = test::on_device(scene);
    const EmitterSet set = make_emitters(placed, {.vpls = 1, .shadow_size = 8});
    test::Shading in;
    in.emitters = set.emitters;
    in.views = set.views;
    in.materials = scene.materials;
    in.visibility.resize(set.pixels, ~std::uint64_t{0});
    in.view = make_view(test::oblique_camera(), placed.frame(), 40, 30);
    in.params.exposure = 1.0f;
    in.params.texel_bias = 1.5f;
    in.params.effects = COMBINE_DIRECT | COMBINE_INDIRECT | COMBINE_EMISSION | COMBINE_SPECULAR;
    const float least = 1e-41f;
    for (int i = 0; i < 33; ++i) {
        test::ShadedPixel pixel;
        pixel.position = {0.01f * static_cast<float>(i), 0.02f, -0.03f};
        pixel.normal = pixel.geometric = glm::normalize(glm::vec3(-0.2f, 0.9f, 0.3f));
        pixel.base = i % 3 == 1 ? glm::vec3(least) : glm::vec3(0.6f, 0.4f, 0.7f);
        pixel.irradiance = i % 3 == 2 ? glm::vec3(least) : glm::vec3(1.0f, 2.0f, 3.0f);
        pixel.emission = glm::vec3(least);
        pixel.material = 3;
        in.pixels.push_back(pixel);
    }
    const test::Combined found = test::combine(in, flushing.passes);
    EXPECT_EQ(found.non_finite, 0u);
    for (std::size_t i = 0; i < in.pixels.size(); ++i) {
        const test::ShadedTruth truth = test::shaded_truth(in, test::stored(in.pixels[i]));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.radiance[i][c], truth.radiance[c],
                        truth.bound[c] + double{std::numeric_limits<float>::min()})
                << i;
        EXPECT_GT(found.radiance[i].y, 0.0f);
    }
}

}  // namespace
}  // namespace clgi
