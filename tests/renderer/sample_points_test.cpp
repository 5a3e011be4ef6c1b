// The points of its pixels that a picture's samples look through.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/shared/halton.h>
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <vector>

#include "geometry.hpp"
#include "renderer/samples.hpp"

namespace clgi {
namespace {

// Within the pixel, the centre at 0.
std::vector<glm::dvec2> sample_points(std::uint32_t count) {
    std::vector<glm::dvec2> out;
    for (std::uint32_t k = 0; k < count; ++k)
        out.emplace_back(renderer::sampled(Camera(), k).offset);
    return out;
}

TEST(SamplePoints, BeginAtTheCentreAndAddToTheCamerasOffset) {
    Camera camera;
    camera.offset = {0.25f, -3.0f};
    EXPECT_EQ(renderer::sampled(camera, 0).offset, camera.offset);
    const glm::vec2 other = renderer::sampled(Camera(), 5).offset;
    EXPECT_NE(other, glm::vec2(0.0f));
    EXPECT_EQ(renderer::sampled(camera, 5).offset, camera.offset + other);
}

// As Sobol's: one in each of n rectangles of equal shape, whatever the shape.
TEST(SamplePoints, FillEveryElementaryRectangleOnce) {
    for (int bits = 0; bits <= 10; ++bits) {
        const std::vector<glm::dvec2> points = sample_points(1u << bits);
        for (int across = 0; across <= bits; ++across) {
            std::vector<int> filled(points.size(), 0);
            for (const glm::dvec2& point : points) {
                const double column = std::floor((point.x + 0.5) * std::exp2(across));
                const double row = std::floor((point.y + 0.5) * std::exp2(bits - across));
                ASSERT_TRUE(point.x >= -0.5 && point.x < 0.5 && point.y >= -0.5 && point.y < 0.5);
                ++filled[static_cast<std::size_t>(row * std::exp2(across) + column)];
            }
            EXPECT_EQ(std::count(filled.begin(), filled.end(), 1), 1 << bits)
                << bits << " " << across;
        }
    }
}

// Edges of all directions through the pixel, whose area is the mean of many points. Ratios of
// errors: 0.75, 0.73 and 0.85 with 4, 16 and 64 samples; Sobol points that are not scrambled err
// nearly as much as Halton points.
TEST(SamplePoints, ErrLessAtEdgesThanHaltonPoints) {
    test::Random random(7);
    constexpr int grid = 150, edges = 1000;
    std::vector<glm::dvec2> halton;
    for (std::uint32_t k = 0; k < 64; ++k)
        halton.push_back(
            glm::fract(glm::dvec2(radical_inverse(k, 2), radical_inverse(k, 3)) + 0.5) - 0.5);
    const std::vector<glm::dvec2> points = sample_points(64);
    double ours[3] = {}, theirs[3] = {};
    for (int e = 0; e < edges; ++e) {
        const double angle = random(0.0, 2.0 * glm::pi<double>()), off = random(-0.6, 0.6);
        const auto inside = [&](const glm::dvec2& at) {
            return at.x * std::cos(angle) + at.y * std::sin(angle) < off ? 1.0 : 0.0;
        };
        double area = 0.0;
        for (int i = 0; i < grid * grid; ++i)
            area +=
                inside((glm::dvec2(i % grid, i / grid) + 0.5) / double{grid} - 0.5) / (grid * grid);
        double sums[2] = {};
        for (std::size_t k = 0, row = 0; k < 64; ++k) {
            sums[0] += inside(points[k]);
            sums[1] += inside(halton[k]);
            const double count = static_cast<double>(k + 1);
            if (count != 4.0 && count != 16.0 && count != 64.0) continue;
            ours[row] += std::pow(sums[0] / count - area, 2) / edges;
            theirs[row++] += std::pow(sums[1] / count - area, 2) / edges;
        }
    }
    for (int row = 0; row < 3; ++row)
        EXPECT_LT(std::sqrt(ours[row]), 0.9 * std::sqrt(theirs[row])) << row;
}

}  // namespace
}  // namespace clgi
