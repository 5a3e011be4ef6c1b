// Interpolation of low-resolution irradiance, every weight and every flag, against double
// precision.
//
//   weight_i  = bilinear_i / (0.01 + d_i)^2, sum 1                  points i around pixel p
//   d_i       = max(1 - n.n_i, 0) + s (|n.(q_i - p)| + |n_i.(q_i - p)|)
//   flag      = sum weight_i (d_i + s^2 |q_i - p|^2) >= threshold, where p exists
//
// s: position_scale. Points are the first pixels of their cells; rows and columns past the edge
// repeat the last one.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "lighting.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

struct UpsampleInput {
    RefineParams params{};
    std::uint32_t low_width = 0, low_height = 0;
    std::vector<float> planes, points, low;  // of POINT_PLANES, POINT_PLANES, IRRADIANCE_PLANES

    glm::dvec3 full(int plane, std::uint32_t pixel) const {
        return {planes[plane * params.stride + pixel], planes[(plane + 1) * params.stride + pixel],
                planes[(plane + 2) * params.stride + pixel]};
    }
    glm::dvec3 point(int plane, std::uint32_t at) const {
        return {points[plane * params.low_stride + at],
                points[(plane + 1) * params.low_stride + at],
                points[(plane + 2) * params.low_stride + at]};
    }
};

// Tilted curved surfaces with edges between them and holes, and other light at every point and in
// every channel, some of it negative.
UpsampleInput random_input(std::uint32_t width, std::uint32_t height, std::uint32_t step) {
    test::Random random(width * 1000 + height * 10 + step);
    UpsampleInput out;
    const std::uint32_t pixels = width * height;
    out.low_width = (width + step - 1) / step;
    out.low_height = (height + step - 1) / step;
    out.params = {width,
                  height,
                  test::padded(pixels),
                  test::padded(std::size_t{out.low_width} * out.low_height),
                  0.11f,
                  7.0f,
                  step,
                  0};
    const std::uint32_t stride = out.params.stride, low_stride = out.params.low_stride;
    out.planes.resize(POINT_PLANES * stride);
    out.points.resize(POINT_PLANES * low_stride);
    for (std::uint32_t y = 0; y < height; ++y)
        for (std::uint32_t x = 0; x < width; ++x) {
            const std::uint32_t p = y * width + x;
            if ((x / 5 + 2 * (y / 3)) % 9 == 4) continue;  // nothing: zeros
            const bool step_down = (x + 2 * y) / 11 % 2 == 1;
            const double u = 0.011 * x, v = 0.013 * y;
            const glm::dvec3 at(u + 0.3 * v, v - 0.2 * u, 0.4 * u + 0.25 * v * v - 0.2 * step_down);
            const glm::dvec3 normal =
                glm::normalize(glm::dvec3(-0.5 - 0.2 * step_down + random(-0.05, 0.05),
                                          0.3 + 0.4 * step_down, 0.8 + random(-0.05, 0.05)));
            for (int c = 0; c < 3; ++c) {
                out.planes[c * stride + p] = static_cast<float>(at[c] + random(-0.003, 0.003));
                out.planes[(3 + c) * stride + p] = static_cast<float>(normal[c]);
            }
        }
    for (std::uint32_t y = 0; y < out.low_height; ++y)
        for (std::uint32_t x = 0; x < out.low_width; ++x)
            for (int plane = 0; plane < POINT_PLANES; ++plane)
                out.points[plane * low_stride + y * out.low_width + x] =
                    out.planes[plane * stride + step * (y * width + x)];
    for (std::uint32_t i = 0; i < IRRADIANCE_PLANES * low_stride; ++i)
        out.low.push_back(static_cast<float>(random(-1.0, 1.0 + i / low_stride)));
    return out;
}

struct Pixel {
    glm::dvec3 irradiance;
    double difference;
    bool own;  // a low-resolution point itself
};

Pixel blended(const UpsampleInput& in, std::uint32_t x, std::uint32_t y) {
    const std::uint32_t step = in.params.step, p = y * in.params.width + x;
    const double s = in.params.position_scale;
    const double right = x % step / static_cast<double>(step);
    const double down = y % step / static_cast<double>(step);
    const glm::dvec3 at = in.full(0, p), normal = in.full(3, p);
    double sum = 0.0, difference = 0.0;
    glm::dvec3 irradiance(0.0);
    for (std::uint32_t i = 0; i < 4; ++i) {
        const std::uint32_t column = std::min(x / step + i % 2, in.low_width - 1);
        const std::uint32_t row = std::min(y / step + i / 2, in.low_height - 1);
        const std::uint32_t q = row * in.low_width + column;
        const glm::dvec3 apart = in.point(0, q) - at, other = in.point(3, q);
        const double d = std::max(1.0 - glm::dot(normal, other), 0.0) +
                         s * (std::abs(glm::dot(normal, apart)) + std::abs(glm::dot(other, apart)));
        const double weight =
            (i % 2 ? right : 1 - right) * (i / 2 ? down : 1 - down) / std::pow(0.01 + d, 2);
        sum += weight;
        difference += weight * (d + s * s * glm::dot(apart, apart));
        for (int c = 0; c < 3; ++c) irradiance[c] += weight * in.low[c * in.params.low_stride + q];
    }
    const bool seen = glm::dot(normal, normal) > 0.0;
    return {irradiance / sum, seen ? difference / sum : 0.0, x % step == 0 && y % step == 0};
}

constexpr std::uint8_t untouched = 0xaa;

struct Output {
    std::vector<float> irradiance;    // [IRRADIANCE_PLANES][stride]
    std::vector<std::uint8_t> flags;  // [width * height] and 16 more
};

Output upsample(const UpsampleInput& in, const ImagePasses& passes) {
    const std::size_t pixels = std::size_t{in.params.width} * in.params.height;
    const cl::Buffer planes = test::upload(in.planes), points = test::upload(in.points),
                     low = test::upload(in.low);
    const cl::Buffer flags = test::upload(std::vector<std::uint8_t>(pixels + 16, untouched));
    const cl::Buffer irradiance =
        test::upload(std::vector<float>(IRRADIANCE_PLANES * in.params.stride, 77.0f));
    passes.upsample(test::device().queue, in.params, planes, points, low, irradiance, flags);
    return {test::download<float>(irradiance, IRRADIANCE_PLANES * in.params.stride),
            test::download<std::uint8_t>(flags, pixels + 16)};
}

const std::pair<std::uint32_t, std::uint32_t> sizes[] = {{1, 1},   {2, 5},   {37, 29},
                                                         {64, 20}, {61, 17}, {100, 9}};

TEST(Upsample, BlendsEveryChannelAsInDoublePrecision) {
    std::size_t marked = 0, unmarked = 0, wrong_flags = 0;
    double worst = 0.0;
    for (const auto& [width, height] : sizes)
        for (const std::uint32_t step : {2u, 4u}) {
            const UpsampleInput in = random_input(width, height, step);
            const Output out = upsample(in, test::image_passes());
            for (std::uint32_t y = 0; y < height; ++y)
                for (std::uint32_t x = 0; x < width; ++x) {
                    const std::uint32_t p = y * width + x;
                    const Pixel wanted = blended(in, x, y);
                    for (int c = 0; c < 3; ++c) {
                        const float found = out.irradiance[c * in.params.stride + p];
                        worst = std::max(worst, std::abs(found - wanted.irradiance[c]));
                        if (wanted.own) {
                            EXPECT_EQ(found, in.low[c * in.params.low_stride +
                                                    y / step * in.low_width + x / step]);
                        }
                    }
                    const double threshold = in.params.threshold;
                    if (std::abs(wanted.difference - threshold) < 1e-4 * threshold) continue;
                    (wanted.difference > threshold ? marked : unmarked) += 1;
                    wrong_flags += out.flags[p] != (wanted.difference > threshold ? 1 : 0);
                }
            for (std::size_t i = 0; i < 16; ++i)
                EXPECT_EQ(out.flags[std::size_t{width} * height + i], untouched);
        }
    EXPECT_EQ(wrong_flags, 0u);
    EXPECT_GT(marked, 1000u);
    EXPECT_GT(unmarked, 1000u);
    // d has some roundings of 7 * 2^-24 and counts twice over 0.01 + d: about 1e-4 of a weight at
    // worst, where all distances cancel. Found: 6e-6.
    EXPECT_LT(worst, 3e-5);
}

TEST(Upsample, MarksWhatReachesTheThresholdExactly) {
    // Parallel normals, no distance: every difference is exactly 0, and so is the threshold.
    UpsampleInput in = random_input(8, 8, 4);
    for (std::size_t i = 0; i < in.planes.size(); ++i)
        in.planes[i] = i / in.params.stride == 5 ? 1.0f : 0.0f;
    for (std::size_t i = 0; i < in.points.size(); ++i)
        in.points[i] = i / in.params.low_stride == 5 ? 1.0f : 0.0f;
    in.params.threshold = 0.0f;
    for (std::size_t p = 0; p < 64; ++p) EXPECT_EQ(upsample(in, test::image_passes()).flags[p], 1);
    in.params.threshold = 1e-30f;
    for (std::size_t p = 0; p < 64; ++p) EXPECT_EQ(upsample(in, test::image_passes()).flags[p], 0);
}

TEST(Upsample, IsTheSameForEveryPacketWidth) {
    for (const int lanes : test::widths()) {
        const ImagePasses passes(test::programs(), {.packet_width = lanes});
        for (const auto& [width, height] : sizes)
            for (const std::uint32_t step : {2u, 4u}) {
                const UpsampleInput in = random_input(width, height, step);
                const Output usual = upsample(in, test::image_passes());
                const Output other = upsample(in, passes);
                EXPECT_TRUE(other.flags == usual.flags) << lanes << ": " << width;
                EXPECT_TRUE(other.irradiance == usual.irradiance) << lanes << ": " << width;
            }
    }
}

}  // namespace
}  // namespace clgi
