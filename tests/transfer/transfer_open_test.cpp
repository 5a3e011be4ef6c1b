// Light of an environment that nothing blocks: the pass, against sums in double precision.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "device.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
using test::nan;

CLGI_IN_BOTH_MATHS(TransferOpen);

// Of the clamped cosine (STABILITY 1.5).
constexpr double cosine_bands[9] = {3.1415926536, 2.0943951024,  0.7853981634,
                                    0.0,          -0.1308996939, 0.0,
                                    0.0490873852, 0.0,           -0.0245436926};

// Receivers with normals alone, of any length, and light that differs in every term and channel.
struct Lit {
    explicit Lit(std::uint32_t receivers, int wanted_bands = 5, std::uint64_t seed = 3)
        : count(receivers),
          bands(wanted_bands),
          stride(plane_stride(std::max(receivers, 1u))),
          planes(RECEIVER_PLANES * std::size_t{stride}, nan) {
        test::Random random(seed);
        for (std::uint32_t i = 0; i < count; ++i)
            set(i, glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)) *
                       static_cast<float>(std::pow(10.0, random(-3, 3))));
        for (int i = 0; i < sh::terms(bands); ++i)
            light.emplace_back(random(-1, 1), random(-1, 1), random(-1, 1), nan);
        light[0] = {5.0f, 9.0f, 14.0f, 0.0f};  // mostly positive
    }
    void set(std::uint32_t i, const glm::vec3& normal) {
        for (int k = 0; k < 3; ++k)
            planes[(RECEIVER_NORMAL + k) * std::size_t{stride} + i] = normal[k];
    }
    glm::dvec3 normal(std::uint32_t i) const {
        glm::dvec3 out;
        for (int k = 0; k < 3; ++k)
            out[k] = double{planes[(RECEIVER_NORMAL + k) * std::size_t{stride} + i]};
        return out;
    }

    // [3][stride]
    std::vector<float> run(const BuildOptions& how, std::uint32_t flags = SHADE_CLAMP,
                           sh::Window window = sh::Window::none) {
        const TransferPasses passes(test::programs(), how, bands);
        OpenParams params = open_params(bands, window, RECEIVER_NORMAL, count, stride);
        EXPECT_EQ(params.flags, std::uint32_t{SHADE_CLAMP});
        params.flags = flags;
        const cl::Buffer out = test::upload(std::vector<float>(3 * std::size_t{stride}, -7.0f));
        const cl::Buffer counted = test::upload(std::vector<cl_uint>{0});
        passes.open(test::device().queue, params, test::upload(planes), test::upload(light), out,
                    counted);
        non_finite = test::download<cl_uint>(counted, 1)[0];
        return test::download<float>(out, 3 * std::size_t{stride});
    }

    glm::dvec3 truth(std::uint32_t i, sh::Window window = sh::Window::none) const {
        const std::vector<double> basis = sh::evaluate(glm::normalize(normal(i)), bands);
        glm::dvec3 sum(0.0);
        for (int t = 0; t < sh::terms(bands); ++t) {
            const int l = sh::degree(t);
            const double hann =
                window == sh::Window::hann ? 0.5 * (1.0 + std::cos(pi * l / bands)) : 1.0;
            sum += hann * cosine_bands[l] * basis[static_cast<std::size_t>(t)] *
                   glm::dvec3(light[static_cast<std::size_t>(t)]);
        }
        return sum;
    }

    std::uint32_t count;
    int bands;
    std::uint32_t stride;
    std::vector<float> planes;
    std::vector<glm::vec4> light;
    cl_uint non_finite = 0;
};

TEST_P(TransferOpen, IsTheSumOverBandsForNormalsOfAnyLength) {
    for (const int bands : {1, 5, 9})
        for (const sh::Window window : {sh::Window::none, sh::Window::hann}) {
            Lit lit(67, bands);
            const std::vector<float> found = lit.run({.math = GetParam()}, 0, window);
            EXPECT_EQ(lit.non_finite, 0u);
            for (std::uint32_t i = 0; i < lit.count; ++i) {
                const glm::dvec3 wanted = lit.truth(i, window);
                // Terms are at most 14 in magnitude; 81 of them are rounded to 2e-6 each.
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(double{found[std::size_t{lit.stride} * c + i]}, wanted[c], 3e-5)
                        << bands << " bands, receiver " << i << ", channel " << c;
            }
        }
}

TEST_P(TransferOpen, HasNoNegativeLightIfClamped) {
    Lit lit(40);
    lit.light[0] = {0.1f, 0.2f, 0.3f, 0.0f};
    const std::vector<float> clamped = lit.run({.math = GetParam()});
    const std::vector<float> whole = lit.run({.math = GetParam()}, 0);
    int negative = 0;
    for (int c = 0; c < 3; ++c)
        for (std::uint32_t i = 0; i < lit.count; ++i) {
            const std::size_t at = std::size_t{lit.stride} * c + i;
            EXPECT_EQ(clamped[at], std::max(whole[at], 0.0f));
            negative += whole[at] < 0.0f;
        }
    EXPECT_GT(negative, 10);
    EXPECT_LT(negative, 110);
}

TEST_P(TransferOpen, IsTheSameInPacketsAndGroupsOfAnySize) {
    for (const std::uint32_t count : {0u, 1u, 33u}) {
        Lit lit(count, 5, 8);
        const std::vector<float> wanted = lit.run({.math = GetParam(), .packet_width = 1});
        for (const auto& [width, local] : {std::pair(4, 7u), {8, 1u}, {16, 64u}}) {
            const std::vector<float> found =
                lit.run({.math = GetParam(), .packet_width = width, .local_size = local});
            // Fast math divides and takes roots otherwise in packets of another width.
            for (int c = 0; c < 3; ++c)
                for (std::uint32_t i = 0; i < count; ++i)
                    EXPECT_NEAR(found[std::size_t{lit.stride} * c + i],
                                wanted[std::size_t{lit.stride} * c + i],
                                GetParam() == Math::strict ? 0.0f : 2e-5f);
        }
        for (int c = 0; c < 3; ++c)
            for (std::uint32_t i = 0; i < count; ++i)
                EXPECT_NEAR(double{wanted[std::size_t{lit.stride} * c + i]},
                            std::max(lit.truth(i)[c], 0.0), 3e-5);
    }
}

// No surface, no light; what is no number stays so and is counted, a packet at a time.
TEST_P(TransferOpen, CountsWhatIsNotFiniteAndLeavesEmptyPixelsBlack) {
    Lit lit(35);
    lit.set(3, glm::vec3(0.0f));
    lit.set(4, {nan, 0.0f, 1.0f});
    lit.set(6, {-nan, 0.0f, 1.0f});  // no more negative than the other
    lit.set(34, {0.0f, nan, 0.0f});
    for (const std::uint32_t flags : {0u, std::uint32_t{SHADE_CLAMP}}) {
        const std::vector<float> found = lit.run({.math = GetParam(), .packet_width = 16}, flags);
        EXPECT_EQ(lit.non_finite, 2u);
        for (int c = 0; c < 3; ++c) {
            const float* plane = found.data() + std::size_t{lit.stride} * c;
            EXPECT_EQ(plane[3], 0.0f);
            EXPECT_TRUE(std::isnan(plane[4]));
            EXPECT_TRUE(std::isnan(plane[6]));
            EXPECT_TRUE(std::isnan(plane[34]));
            EXPECT_NEAR(double{plane[5]}, std::max(lit.truth(5)[c], flags ? 0.0 : -1e9), 3e-5);
        }
    }
    lit.set(4, {1.0f, 0.0f, 0.0f});
    lit.set(6, {1.0f, 0.0f, 0.0f});
    lit.set(34, {1.0f, 0.0f, 0.0f});
    lit.light[6].y = std::numeric_limits<float>::infinity();
    lit.run({.math = GetParam(), .packet_width = 16});
    EXPECT_EQ(lit.non_finite, 3u);  // all packets
}

TEST(TransferOpenSizes, AreChecked) {
    const TransferPasses passes(test::programs(), {}, 5);
    const Lit lit(20);
    const std::size_t stride = lit.stride;
    const auto refuses = [&](const OpenParams& params, std::size_t planes, std::size_t terms,
                             std::size_t out) {
        try {
            passes.open(test::device().queue, params, test::empty<char>(planes),
                        test::empty<char>(terms), test::empty<char>(out), test::empty<cl_uint>(1));
        } catch (const Error& error) {
            return std::string(error.what()).find("transfer.open") != std::string::npos;
        }
        return false;
    };
    const OpenParams params = open_params(5, sh::Window::none, RECEIVER_NORMAL, 20, lit.stride);
    EXPECT_FALSE(refuses(params, 48 * stride, 400, 12 * stride));
    EXPECT_TRUE(refuses(params, 48 * stride - 1, 400, 12 * stride));
    EXPECT_TRUE(refuses(params, 48 * stride, 399, 12 * stride));
    EXPECT_TRUE(refuses(params, 48 * stride, 400, 12 * stride - 1));
    OpenParams narrow = params;
    narrow.stride = 19;
    EXPECT_TRUE(refuses(narrow, 48 * stride, 400, 12 * stride));
}

}  // namespace
}  // namespace clgi
