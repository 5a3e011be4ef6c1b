// What records see of the sky, and how far directions of it are trusted, with buffers of the test's
// own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/passes/cache.hpp>
#include <cmath>
#include <limits>

#include "device.hpp"
#include "math_modes.hpp"
#include "record_cubes.hpp"
#include "scenes.hpp"
#include "skies.hpp"
#include "two_records.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(SkyPasses);

constexpr int columns = 6, rows = 5;

// The share of a texel in the cosine about a normal, [0,1]; fraction of all: 1 over the hemisphere.
// turn: of the picture, in turns.
std::vector<double> cosines(const glm::dvec3& normal, double turn) {
    std::vector<double> out(columns * rows, 0.0);
    constexpr int fine = 120;
    for (int y = 0; y < rows * fine; ++y) {
        const double down = pi * (y + 0.5) / (rows * fine);
        for (int x = 0; x < columns * fine; ++x) {
            // u = across / (2 pi) + 1/2 + turn
            const double across = 2 * pi * ((x + 0.5) / (columns * fine) - 0.5 - turn);
            const glm::dvec3 d(std::sin(down) * std::sin(across), std::cos(down),
                               -std::sin(down) * std::cos(across));
            const double angle =
                std::sin(down) * (pi / (rows * fine)) * (2 * pi / (columns * fine));
            out[static_cast<std::size_t>(y / fine * columns + x / fine)] +=
                std::max(glm::dot(d, normal), 0.0) * angle / pi;
        }
    }
    return out;
}

// Two records, of which the second is tilted, above a small square far below that hides hardly any
// of the sky. Only those that are asked for count.
TEST_P(SkyPasses, SeeTheSkyByItsCosine) {
    Scene world = test::plain_scene();
    test::add_floor(world, 0.001, -50.0);
    const DeviceScene scene = test::on_device(world);
    const glm::dvec3 up(0, 1, 0), tilted = glm::normalize(glm::dvec3(0.6, 0.5, -0.3));
    const CacheBuffers b =
        test::record_cubes(scene, {{{0, 0, 0}, up}, {{0.2, 0.1, 0}, tilted}}, 64);
    const CachePasses passes(test::programs(), test::usual_build());
    CacheParams params{};
    params.stride = test::record_stride;
    params.size = 64;
    params.sky_width = columns;
    params.sky_height = rows;
    params.sky_turn = 0.15f;
    for (const std::uint32_t first : {0u, 1u})
        for (const std::uint32_t count : {1u, 2u}) {
            if (first + count > 2) continue;
            params.first = first;
            params.count = count;
            const cl::Buffer sight =
                test::upload(std::vector<std::uint32_t>(columns * rows + 1, 7u));
            passes.sight(test::device().queue, params, b, sight).wait();
            const auto found = test::download<std::uint32_t>(sight, columns * rows + 1);
            EXPECT_EQ(found.back(), 7u);
            std::vector<double> wanted(columns * rows, 0.0);
            for (std::uint32_t r = first; r < first + count; ++r) {
                const std::vector<double> one = cosines(r == 0 ? up : tilted, 0.15);
                for (std::size_t k = 0; k < one.size(); ++k) wanted[k] += one[k] / count;
            }
            double sum = 0.0;
            for (std::size_t k = 0; k < wanted.size(); ++k) {
                const double share = (found[k] - 7.0) / (1u << 30);
                // Pixels belong to one texel or another.
                EXPECT_NEAR(share, wanted[k], 0.004) << first << count << " " << k;
                sum += share;
            }
            EXPECT_NEAR(sum, 1.0, 0.002);
        }
}

// A wall close by hides half of the hemisphere from a record that looks along it.
TEST_P(SkyPasses, SeeNoSkyBehindWalls) {
    Scene world = test::plain_scene();
    test::add_quad(
        world,
        {glm::dvec3(100, -100, -0.01), {-100, -100, -0.01}, {-100, 100, -0.01}, {100, 100, -0.01}});
    const DeviceScene scene = test::on_device(world);
    const CacheBuffers b = test::record_cubes(scene, {{{0, 0, 0}, {0, 1, 0}}}, 64);
    const CachePasses passes(test::programs(), test::usual_build());
    CacheParams params{};
    params.count = 1;
    params.stride = test::record_stride;
    params.size = 64;
    params.sky_width = 2;
    params.sky_height = 1;
    params.sky_turn = -0.25f;  // texels are the halves with z > 0 and z < 0
    const cl::Buffer sight = test::upload(std::vector<std::uint32_t>(2, 0u));
    passes.sight(test::device().queue, params, b, sight).wait();
    const auto found = test::download<std::uint32_t>(sight, 2);
    const auto [least, most] = std::minmax(found[0], found[1]);
    EXPECT_NEAR(most / double(1u << 30), 0.5, 0.005);
    EXPECT_LT(least / double(1u << 30), 0.02);
}

struct Blocks {
    static constexpr std::uint32_t width = 19, height = 13, stride = 272, across = 3, down = 2;
    static constexpr std::uint32_t pixels = width * height;
    static CacheCorrectParams params(float scale, float total) {
        CacheCorrectParams out{};
        out.width = width;
        out.height = height;
        out.stride = stride;
        out.scale = scale;
        out.total = total;
        return out;
    }

    std::vector<double> sums = std::vector<double>(5 * stride, 0.0);
    std::vector<double> shares = std::vector<double>(across * down, 0.0);

    double total = 0.0, squares = 0.0, before = 0.0;

    // One correction more, of so many directions; again: those of the last one. points: x, y and z
    // of what pixels show.
    void add(const std::vector<float>& points, const std::vector<float>& found, double scale,
             double weight, bool again) {
        total += weight;
        if (again)
            squares -= before * before;
        else
            before = 0.0;
        before += weight;
        squares += before * before;
        std::vector<double> together(shares.size(), 0.0), apart(shares.size(), 0.0);
        for (std::uint32_t p = 0; p < pixels; ++p) {
            double d = 0.0, sum = 0.0;
            const double weights[] = {0.2126, 0.7152, 0.0722};
            for (std::uint32_t c = 0; c < 3; ++c) {
                const double value = found[c * stride + p];
                bool good = true;
                for (std::uint32_t k = 0; k < 3; ++k)
                    good = good && std::isfinite(found[k * stride + p]) &&
                           std::abs(points[k * stride + p]) <= 1.0f + static_cast<float>(k);
                sums[c * stride + p] += good ? scale * value : 0.0;
                d += good ? weights[c] * scale * value : 0.0;
                sum += weights[c] * sums[c * stride + p];
            }
            double& of_these = sums[4 * stride + p];
            if (again)
                sums[3 * stride + p] -= of_these * of_these;
            else
                of_these = 0.0;
            of_these += d;
            sums[3 * stride + p] += of_these * of_these;
            const std::size_t block = p / width / 8 * across + p % width / 8;
            together[block] += sum * sum;
            apart[block] += sums[3 * stride + p];
        }
        for (std::size_t k = 0; k < shares.size(); ++k) {
            // Of corrections with variances s / m: E sum m^2 d^2 = Q B + M s.
            const double pairs = total * total - squares;
            const double mean = pairs > 0.0 ? (together[k] - apart[k]) / pairs : 0.0;
            const double of_one = (apart[k] - squares * mean) / total;
            const double noise = of_one / total * (1.0 + 4.0 * squares / (total * total));
            shares[k] = mean > noise && mean > 0.0 ? 1.0 - std::max(noise, 0.0) / mean : 0.0;
        }
    }
};

// What stays and what changes by turns, in blocks that the picture cuts off.
TEST_P(SkyPasses, TrustWhatSamplesAgreeAbout) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    Blocks wanted;
    using B = Blocks;
    const cl::Buffer sums = test::upload(std::vector<float>(5 * B::stride, 0.0f)),
                     shares = test::upload(std::vector<float>(B::across * B::down + 1, -3.0f));
    test::Random random(3);
    for (std::uint32_t sample = 1; sample <= 12; ++sample) {
        std::vector<float> found(3 * B::stride, 9.0f);
        for (std::uint32_t p = 0; p < B::pixels; ++p)
            for (std::uint32_t c = 0; c < 3; ++c) {
                const double place = p % B::width / double{B::width};
                found[c * B::stride + p] = static_cast<float>(
                    place * (1.0 + c) + (1.0 - place) * random(-2.0, 2.0) - (c == 1 ? 0.5 : 0.0));
            }
        if (sample == 2) found[B::stride + 40] = std::numeric_limits<float>::quiet_NaN();
        if (sample == 3) found[41] = std::numeric_limits<float>::infinity();
        // A box of 1, 2 and 3; some lie on its sides, some beyond one of them.
        std::vector<float> points(GBUFFER_PLANES * B::stride, 0.0f);
        for (std::uint32_t p = 0; p < B::pixels; ++p) {
            const std::uint32_t axis = p % 3;
            const float side = 1.0f + static_cast<float>(axis);
            const float beyond = (p + sample) % 7 == 0 ? 1.25f : 1.0f;
            points[axis * B::stride + p] = (p % 2 == 0 ? side : -side) * beyond;
        }
        const float weight = sample < 5 ? 2.0f : sample % 2 == 0 ? 8.0f : 3.0f;
        const bool again = sample == 7 || sample == 11 || sample == 12;
        wanted.add(points, found, 6.0, double{weight}, again);
        CacheCorrectParams of = Blocks::params(6.0f, static_cast<float>(wanted.total));
        of.squares = static_cast<float>(wanted.squares);
        of.again = again ? 1 : 0;
        of.low = {-1, -2, -3, 9};
        of.high = {1, 2, 3, 9};
        passes.gauge(queue, of, points_of(points, B::stride), test::upload(found), sums, shares);
        queue.finish();
        const auto got = test::download<float>(shares, B::across * B::down + 1);
        for (std::size_t k = 0; k < wanted.shares.size(); ++k) {
            EXPECT_NEAR(got[k], wanted.shares[k], 2e-4) << sample << " " << k;
            if (sample == 1) {
                EXPECT_EQ(got[k], 0.0f);
            }
        }
        EXPECT_EQ(got.back(), -3.0f);
    }
    const auto [least, most] = std::minmax_element(wanted.shares.begin(), wanted.shares.end());
    EXPECT_LT(*least, 0.3);
    EXPECT_GT(*most, 0.9);
    const auto got = test::download<float>(sums, 5 * B::stride);
    for (std::size_t plane = 0; plane < 5; ++plane)
        for (std::size_t p = 0; p < B::stride; ++p) {
            const double value = wanted.sums[plane * B::stride + p];
            EXPECT_NEAR(got[plane * B::stride + p], value, 1e-4 + 1e-6 * std::abs(value));
        }
}

// Shares are linear between the middles of blocks, and constant beyond the outermost.
TEST_P(SkyPasses, CorrectByTheSharesAround) {
    const CachePasses passes(test::programs(), test::usual_build());
    using B = Blocks;
    test::Random random(4);
    std::vector<float> sums(5 * B::stride), light(3 * B::stride);
    for (float& one : sums) one = static_cast<float>(random(-1.0, 1.0));
    for (float& one : light) one = static_cast<float>(random(0.0, 5.0));
    const std::vector<float> shares = {0.1f, 0.9f, 0.4f, 0.6f, 0.0f, 1.0f};
    const cl::Buffer irradiance = test::upload(light);
    passes
        .correct(test::device().queue, B::params(2, 5), test::upload(sums), test::upload(shares),
                 irradiance)
        .wait();
    const auto got = test::download<float>(irradiance, 3 * B::stride);
    const auto along = [](double pixel, std::uint32_t blocks) {
        return std::clamp((pixel + 0.5) / 8.0 - 0.5, 0.0, blocks - 1.0);
    };
    for (std::uint32_t p = 0; p < B::stride; ++p) {
        double share = 0.0;
        if (p < B::pixels)
            for (std::uint32_t k = 0; k < shares.size(); ++k) {
                const double x = along(p % B::width, B::across), y = along(p / B::width, B::down);
                share += std::max(0.0, 1.0 - std::abs(x - k % B::across)) *
                         std::max(0.0, 1.0 - std::abs(y - k / B::across)) * double{shares[k]};
            }
        for (std::uint32_t c = 0; c < 3; ++c) {
            const double wanted = light[c * B::stride + p] + share / 5 * sums[c * B::stride + p];
            EXPECT_NEAR(got[c * B::stride + p], wanted, 1e-5) << p << " " << c;
        }
    }
}

// A second light of the records is shown by the same shares, in its own channels: between both
// records, on the second, on none that faces as the point, and in the background.
TEST_P(SkyPasses, ShowTwoLightsAtOnce) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    const TwoRecords two;
    std::vector<float> planes(GBUFFER_PLANES * plane, 0.0f), other(3 * plane, 0.0f);
    for (std::uint32_t i = 0; i < 3; ++i) {
        planes[GBUFFER_POSITION * plane + i] = i == 1 ? 1.0f : 0.0f;
        planes[(GBUFFER_NORMAL + 1) * plane + i] = i == 2 ? -1.0f : 1.0f;
    }
    for (std::uint32_t i = 0; i < 2; ++i)
        for (std::uint32_t c = 0; c < 3; ++c)
            other[c * plane + i] = -two.values[1 - i][(c + 1) % 3];
    const GBuffer points = points_of(planes, plane);
    const auto none = [] { return test::upload(std::vector<float>(3 * plane, -1.0f)); };
    const cl::Buffer alone = none(), first = none(), doubt = none();
    const CachePasses::More more{test::upload(other), none()};
    passes.show(queue, {4, plane, 0, 0}, two.tree, two.b, points, alone, doubt);
    passes.show(queue, {4, plane, 1, 0}, two.tree, two.b, points, first, doubt, more).wait();
    EXPECT_TRUE(test::download<float>(first, 3 * plane) == test::download<float>(alone, 3 * plane));
    const auto second = test::download<float>(more.irradiance, 3 * plane);
    for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint32_t from = (c + 1) % 3;
        EXPECT_NEAR(second[c * plane], -0.5f * (two.values[0][from] + two.values[1][from]), 1e-5f);
        EXPECT_NEAR(second[c * plane + 1], -two.values[0][from], 0.05f);
        EXPECT_EQ(second[c * plane + 2], 0.0f);
        EXPECT_EQ(second[c * plane + 3], 0.0f);
        EXPECT_EQ(second[c * plane + next_packet], -1.0f);
    }
}

TEST(SkyPassChecks, RefuseBuffersThatAreTooSmall) {
    const CachePasses passes(test::programs(), test::usual_build());
    const cl::CommandQueue& queue = test::device().queue;
    using B = Blocks;
    const cl::Buffer planes = test::empty<float>(5 * B::stride), few = test::empty<float>(4);
    const CacheCorrectParams of = B::params(1, 1);
    const GBuffer points{test::empty<float>(GBUFFER_PLANES * B::stride), {}};
    EXPECT_NO_THROW(passes.gauge(queue, of, points, planes, planes, planes));
    EXPECT_NO_THROW(passes.correct(queue, of, planes, planes, planes));
    for (int k = 0; k < 3; ++k) {
        const auto at = [&](int i) { return i == k ? few : planes; };
        EXPECT_THROW(passes.gauge(queue, of, points, at(0), at(1), at(2)), Error);
        EXPECT_THROW(passes.correct(queue, of, at(0), at(1), at(2)), Error);
    }
    CacheCorrectParams narrow = of;
    narrow.stride = 240;
    for (const CacheCorrectParams& wrong : {B::params(0, 1), B::params(1, 0), narrow})
        EXPECT_THROW(passes.gauge(queue, wrong, points, planes, planes, planes), Error);
    EXPECT_THROW(passes.gauge(queue, of, {few, {}}, planes, planes, planes), Error);
    CacheParams params{};
    params.count = 1;
    params.size = 8;
    params.stride = 16;
    params.sky_width = params.sky_height = 2;
    CacheBuffers b;
    b.planes = test::empty<float>(RECORD_PLANES * 16);
    b.views = test::upload(std::vector<View>(5, View{}));  // of no pixels
    b.visibility = test::upload(std::vector<std::uint64_t>(3 * 64, 0));
    EXPECT_NO_THROW(passes.sight(queue, params, b, few));
    params.sky_width = 3;
    EXPECT_THROW(passes.sight(queue, params, b, few), Error);
    queue.finish();
}

}  // namespace
}  // namespace clgi
