// From lights to picture, pass by pass: against sums in double precision and closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "frames.hpp"
#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Receiver;

using std::numbers::pi;

glm::vec3 lobe_direction(test::Random& random) {
    glm::vec3 out(random(-1, 1), random(-1, 1), random(-1, 1));
    return glm::normalize(out + glm::vec3(0, 1e-6f, 0));
}

Vpl light_at(const glm::vec3& position, const glm::vec3& normal, const glm::vec3& flux,
             float area) {
    const float radius2 = area / static_cast<float>(pi);
    return {glm::vec4(position, radius2), glm::vec4(normal, radius2 * radius2), glm::vec4(flux, 1)};
}

Vpl light_at(const glm::vec3& position, const glm::vec3& normal, float flux, float area) {
    return light_at(position, normal, glm::vec3(flux), area);
}

CLGI_IN_ALL_MODES(Gather);
CLGI_IN_ALL_MODES(LowResolution);

TEST_P(Gather, IsTheSumInDoublePrecision) {
    test::Random random(11);
    for (const int n : {0, 1, 2, 63, 300, 2000}) {
        if (n == 2000 && test::half_error() > 0.0) continue;  // beyond 65504
        std::vector<Vpl> lights;
        for (int i = 0; i < n; ++i) {
            const glm::vec3 at(random(-1, 1), random(-1, 1), random(-1, 1));
            const glm::vec3 flux(random(0, 1), random(0, 0.5), random(0, 2));
            lights.push_back(light_at(at, lobe_direction(random), flux,
                                      static_cast<float>(std::exp2(random(-20, 0)))));
        }
        // A third of them take light away.
        const std::vector<Vpl> negative(lights.begin(), lights.begin() + n / 3);
        lights.erase(lights.begin(), lights.begin() + n / 3);
        std::vector<Receiver> receivers;
        for (int i = 0; i < 67; ++i)
            receivers.push_back(
                {glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)), lobe_direction(random)});
        for (std::size_t i = 0; i < std::min<std::size_t>(lights.size(), 3);
             ++i)  // on top of lights
            receivers.push_back({glm::vec3(lights[i].position), lobe_direction(random)});
        for (Receiver& receiver : receivers) receiver.normal = test::stored(receiver.normal);
        const auto found = test::gather(receivers, lights, negative);
        for (std::size_t r = 0; r < receivers.size(); ++r) {
            glm::dvec3 sum(0.0), condition(0.0);
            const auto add = [&](const Vpl& light, double sign) {
                const glm::dvec3 t = glm::dvec3(light.position) - glm::dvec3(receivers[r].position);
                const double square = glm::dot(t, t), s = pi * square,
                             area = pi * double{light.position.w};
                const double kernel = (s + area) / (s * (s + area) + area * area);
                condition += glm::dvec3(light.flux) * kernel;
                if (square == 0.0) return;
                const double receive = std::max(glm::dot(glm::dvec3(receivers[r].normal), t), 0.0);
                const double send = std::max(-glm::dot(glm::dvec3(light.normal), t), 0.0);
                sum += sign * glm::dvec3(light.flux) * (receive * send / square * kernel);
            };
            for (const Vpl& light : lights) add(light, 1.0);
            for (const Vpl& light : negative) add(light, -1.0);
            // 16 roundings a term, and one for every doubling of the number of terms: sums of
            // positive floats in one row grow no faster than that here. A quotient of fast math may
            // be 2.5 ulp off instead of half a one.
            const int roundings = GetParam().math == Math::fast ? 18 : 16;
            const double off = (roundings + 4 * std::ceil(std::log2(n + 1))) * std::exp2(-24);
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[r][c], sum[c],
                            off * condition[c] + test::half_error() * (std::abs(sum[c]) + 0x1p-14))
                    << n << " lights, channel " << c;
        }
    }
}

TEST_P(Gather, StaysFiniteAndBoundedWhereALightIsTouched) {
    for (const float area : {1e-3f, 1e-12f})
        for (const float distance : {0.0f, 1e-23f, 1e-12f, 1e-6f}) {
            const Vpl light = light_at({0, 0, 0}, {0, 0, 1}, 2.0f, area);
            const auto found =
                test::gather({{{0, 0, distance}, {0, 0, -1}}}, {light, light, light}, {});
            EXPECT_TRUE(std::isfinite(found[0].x)) << distance;
            EXPECT_GE(found[0].x, 0.0f);
            EXPECT_LE(found[0].x, 3 * 2.0f / area * (1 + 1e-6f + test::half_error()))
                << "three radiosities";
        }
}

// d^6 overflows at 2e6: far away is dark, not NaN. The local frame ends at 1, so fast math, which
// may divide an infinity by itself, need not bear what lies beyond.
TEST_P(Gather, StaysFiniteFarAway) {
    for (const float distance : {1e3f, 1e6f, 3e6f, 1e9f}) {
        if (GetParam().math == Math::fast && distance > 2e6f) continue;
        const auto found = test::gather({{{0, 0, distance}, {0, 0, -1}}},
                                        {light_at({0, 0, 0}, {0, 0, 1}, 1, 1e-3f)}, {});
        EXPECT_TRUE(std::isfinite(found[0].x)) << distance;
        EXPECT_NEAR(found[0].x, 1.0 / (pi * distance * distance), 1e-6);
    }
}

TEST_P(Gather, IsExactlyZeroBehindAndInThePlane) {
    const Vpl light = light_at({0.3f, 0.7f, 0.0f}, {0, 0, 1}, 1, 1e-3f);
    test::Random random(3);
    std::vector<Receiver> receivers;
    for (int i = 0; i < 100; ++i) {
        const float x = static_cast<float>(random(-1, 1)), y = static_cast<float>(random(-1, 1));
        const float z = static_cast<float>(random(1e-6, 1));
        receivers.push_back({{x, y, -z}, {0, 0, 1}});  // behind the light
        receivers.push_back({{x, y, z}, {0, 0, 1}});   // with its back to it
        receivers.push_back({{x, y, 0}, {0, 0, 1}});   // beside it, on the same floor
    }
    for (const glm::vec3& irradiance : test::gather(receivers, {light}, {}))
        EXPECT_EQ(irradiance, glm::vec3(0.0f));
}

TEST_P(Gather, TakesNegativeLightsAway) {
    const std::vector<Vpl> some = {light_at({0, 0, 1}, {0, 0, -1}, 3, 1e-3f)};
    const std::vector<Vpl> less = {light_at({0, 0, 1}, {0, 0, -1}, 1, 1e-3f)};
    const std::vector<Receiver> receiver = {{{0, 0.2f, 0}, {0, 0, 1}}};
    const auto lit = [&](const auto& lights, const auto& negative) {
        return test::gather(receiver, lights, negative)[0].x;
    };
    const std::vector<Vpl> none;
    const float all = lit(some, none);
    EXPECT_NEAR(lit(some, less), all * 2 / 3, 1e-6f + 2 * test::half_error() * all);
    EXPECT_NEAR(lit(none, less), -all / 3, 1e-6f + 2 * test::half_error() * all);
    EXPECT_EQ(lit(some, some), 0.0f);
}

TEST(Gather, IsTheSameForEveryWorkGroupAndPacket) {
    test::Random random(5);
    std::vector<Vpl> lights;
    std::vector<Receiver> receivers;
    for (int i = 0; i < 77; ++i) {
        lights.push_back(light_at(lobe_direction(random), lobe_direction(random), 1, 1e-4f));
        receivers.push_back({0.5f * lobe_direction(random), lobe_direction(random)});
    }
    const auto usual = test::gather(receivers, lights, lights);
    for (const BuildOptions& build : {BuildOptions{.packet_width = 1, .local_size = 7},
                                      {.packet_width = 4, .local_size = 1},
                                      {.local_size = 256}}) {
        const ImagePasses passes(test::programs(), build);
        EXPECT_TRUE(test::same_bits(test::gather(receivers, lights, lights, passes), usual));
    }
}

class ImageSize : public testing::TestWithParam<std::pair<int, int>> {};

SecondOrderOptions options_for(std::pair<int, int> size) {
    SecondOrderOptions options;
    options.build = test::usual_build();
    options.width = size.first;
    options.height = size.second;
    options.emitters.vpls = 60;
    options.emitters.shadow_size = 256;
    options.negative_vpls = 40;
    return options;
}

void expect_full_resolution(std::pair<int, int> size) {
    const Scene scene = cornell({.light = LightSource::spot});
    SecondOrderOptions options = options_for(size);
    options.discontinuity_threshold = 0.0f;
    const test::Frame zero = test::render(scene, scene.cameras[0], options);
    options.discontinuity_threshold =
        1e-30f;  // through every pass: no pixel matches its points so well
    const test::Frame almost = test::render(scene, scene.cameras[0], options);
    options.low_resolution_step = 1;
    const test::Frame full = test::render(scene, scene.cameras[0], options);
    EXPECT_TRUE(test::same_bits(zero.radiance, full.radiance));
    EXPECT_TRUE(test::same_bits(almost.radiance, full.radiance));
    EXPECT_EQ(zero.status.refined_pixels, full.pixels);
}

TEST_P(ImageSize, IsFullResolutionBitForBitAtThresholdZero) { expect_full_resolution(GetParam()); }

TEST_P(LowResolution, IsFullResolutionAtThresholdZero) { expect_full_resolution({33, 20}); }

INSTANTIATE_TEST_SUITE_P(Sizes, ImageSize,
                         testing::Values(std::pair(1, 1), std::pair(3, 5), std::pair(33, 20),
                                         std::pair(641, 479)));

TEST_P(LowResolution, ErrsMoreTheHigherItsThreshold) {
    const Scene scene = cornell({.light = LightSource::spot});
    SecondOrderOptions options = options_for({121, 93});
    options.direct = false;
    options.discontinuity_threshold = 0.0f;
    const test::Frame full = test::render(scene, scene.cameras[0], options);
    double before = 0.0;
    std::size_t refined = full.pixels;
    for (const float threshold :
         {0.002f, 0.02f, 0.2f, 1.0f, std::numeric_limits<float>::infinity()}) {
        options.discontinuity_threshold = threshold;
        const test::Frame frame = test::render(scene, scene.cameras[0], options);
        double square = 0.0;
        for (std::size_t p = 0; p < frame.pixels; ++p)
            square += std::pow(frame.radiance[p].x - full.radiance[p].x, 2);
        // A pixel interpolated more is an error more: the same pixels err at higher thresholds.
        EXPECT_GE(square, before) << threshold;
        EXPECT_LE(frame.status.refined_pixels, refined) << threshold;
        before = square;
        refined = frame.status.refined_pixels;
    }
    EXPECT_GT(before, 0.0);
    EXPECT_EQ(refined, 0u);
}

TEST(Tonemap, EncodesAsTheStandardSays) {
    const std::uint32_t count = 1000, stride = 1008;
    std::vector<float> radiance(RADIANCE_PLANES * stride);
    for (std::uint32_t i = 0; i < count; ++i) {
        radiance[i] = static_cast<float>(i) / count;
        radiance[stride + i] = 1e-6f * static_cast<float>(i * i);
        radiance[2 * stride + i] = static_cast<float>(i) - 500.0f;
    }
    const cl::Buffer preview = test::upload(std::vector<cl_uint>(count + 64, 77u));
    const float exposure = 0.7f;
    test::image_passes().tonemap(test::device().queue, {count / 8, 8, stride, exposure},
                                 test::upload(radiance), preview);
    const auto words = test::download<cl_uint>(preview, count + 64);
    for (std::uint32_t i = count; i < words.size(); ++i) EXPECT_EQ(words[i], 77u) << "past the end";
    for (std::uint32_t i = 0; i < count; ++i) {
        for (int c = 0; c < 3; ++c) {
            const double linear =
                std::min(std::max(double{radiance[c * stride + i] * exposure}, 0.0), 1.0);
            const double s =
                linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
            // The nearest byte; where it is all but a tie, either.
            EXPECT_NEAR(words[i] >> (8 * c) & 255, 255 * s, 0.5 + 1e-3) << i;
        }
        EXPECT_EQ(words[i] >> 24, 255u);
    }
}

TEST(Tonemap, TakesWhateverItIsGiven) {
    const float hard[] = {
        std::numeric_limits<float>::infinity(), std::nanf(""), -1.0f, 1e38f, 1e-45f, 0.0f};
    std::vector<float> radiance(RADIANCE_PLANES * 16);
    for (std::size_t i = 0; i < std::size(hard); ++i) radiance[i] = hard[i];
    const cl::Buffer preview = test::empty<cl_uint>(std::size(hard));
    test::image_passes().tonemap(test::device().queue, {std::size(hard), 1, 16, 1.0f},
                                 test::upload(radiance), preview);
    const auto words = test::download<cl_uint>(preview, std::size(hard));
    EXPECT_EQ(words[0] & 255, 255u);
    EXPECT_EQ(words[2] & 255, 0u);
    EXPECT_EQ(words[3] & 255, 255u);
    EXPECT_EQ(words[4] & 255, 0u);
    EXPECT_EQ(words[5] & 255, 0u);
}

// Eleven samples one after the other, of which one is as large as numbers get; and the luminance of
// the mean before some of them.
TEST(Accumulate, IsTheMean) {
    constexpr std::uint32_t pixels = 37, stride = 48, samples = 11;
    test::Random random(5);
    std::vector<double> sums(RADIANCE_PLANES * stride, 0.0);
    std::map<std::uint32_t, std::vector<double>> kept;  // by plane
    std::vector<float> radiance(RADIANCE_PLANES * stride);
    const cl::Buffer mean = test::upload(std::vector<float>(MEAN_PLANES * stride, 0.0f));
    for (std::uint32_t k = 1; k <= samples; ++k) {
        const std::uint32_t keep = k == 5 ? MEAN_BEFORE : k == 7 ? MEAN_BEFORE + 1 : 0;
        for (std::size_t i = 0; keep != 0 && i < pixels; ++i)
            kept[keep].push_back(
                (0.2126 * sums[i] + 0.7152 * sums[stride + i] + 0.0722 * sums[2 * stride + i]) /
                (k - 1.0));
        for (std::size_t i = 0; i < radiance.size(); ++i) {
            radiance[i] = static_cast<float>(random(0.0, 1.0 + static_cast<double>(i % 5)));
            if (k == 3 && i == 4) radiance[i] = std::numeric_limits<float>::max();
            sums[i] += double{radiance[i]};
        }
        test::image_passes().accumulate(test::device().queue,
                                        {pixels, stride, 1.0f / static_cast<float>(k), keep},
                                        test::upload(radiance), mean);
    }
    const auto found = test::download<float>(mean, MEAN_PLANES * stride);
    for (std::uint32_t i = 0; i < pixels; ++i) {
        for (std::uint32_t c = 0; c < RADIANCE_PLANES; ++c) {
            const double wanted = sums[c * stride + i] / samples;
            EXPECT_NEAR(found[c * stride + i], wanted, 1e-6 * wanted) << i;
        }
        for (const auto& [plane, wanted] : kept)
            EXPECT_NEAR(found[plane * stride + i], wanted[i], 2e-6 * wanted[i])
                << plane << ' ' << i;
    }
}

// All channels as large as numbers get: what is kept of their mean is a number, as the weights of
// luminance are 1 together.
TEST(Accumulate, KeepsFiniteNumbers) {
    constexpr std::uint32_t stride = 16;
    const float most = std::numeric_limits<float>::max();
    const cl::Buffer mean = test::upload(std::vector<float>(MEAN_PLANES * stride, most));
    const cl::Buffer radiance = test::upload(std::vector<float>(RADIANCE_PLANES * stride, most));
    test::image_passes().accumulate(test::device().queue, {stride, stride, 0.5f, MEAN_BEFORE + 1},
                                    radiance, mean);
    const auto found = test::download<float>(mean, MEAN_PLANES * stride);
    for (const float value : found) EXPECT_NEAR(value / most, 1.0, 1e-6);
    for (const std::uint32_t plane : {1u, std::uint32_t{MEAN_PLANES}})
        EXPECT_THROW(test::image_passes().accumulate(test::device().queue,
                                                     {stride, stride, 0.5f, plane}, radiance, mean),
                     Error);
}

}  // namespace
}  // namespace clgi
