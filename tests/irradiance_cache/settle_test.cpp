// What directions of the sky say about records, against the definition in double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <clgi/passes/cache.hpp>
#include <cmath>
#include <limits>
#include <random>

#include "lighting.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t count = 37;

using Planes = std::vector<float>;

double luminance_of(const std::array<double, 3>& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

// Records differ by how far their hemicubes err, and by the noise of what directions bring.
TEST(Settle, IsThatOfTheDefinition) {
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    const std::uint32_t stride = test::padded(count);
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    const auto at = [&](int c, std::uint32_t i) {
        return static_cast<std::size_t>(c) * stride + i;
    };
    Planes base(3 * stride), bright(3 * stride), shown(3 * stride);
    for (int c = 0; c < 3; ++c)
        for (std::uint32_t i = 0; i < count; ++i) {
            bright[at(c, i)] = 3.0f + c;
            base[at(c, i)] = bright[at(c, i)] + 1.0f + 0.5f * c;
            shown[at(c, i)] = 2.0f + c + 0.1f * i;
        }
    CacheBuffers b;
    b.base = test::upload(base);
    b.bright = test::upload(bright);
    b.shown = test::upload(shown);
    const cl::Buffer sums = test::upload(Planes(4 * stride)),
                     settled = test::upload(Planes(3 * stride));
    std::vector<std::array<double, 3>> sum(count, {0, 0, 0});
    std::vector<double> squares(count, 0.0);
    double total = 0.0, of_parts = 0.0;
    const float scale = 32.0f;
    int corrected = 0, kept = 0;
    for (int part = 0; part < 24; ++part) {
        const double directions = part < 12 ? 8.0 : 32.0;
        Planes found(3 * stride);
        for (std::uint32_t i = 0; i < count; ++i) {
            const double error = 0.05 * (i % 7), noise = 0.02 * (i % 5);
            std::array<double, 3> mb{};
            for (int c = 0; c < 3; ++c) {
                const double of_sky = 1.0 + 0.5 * c;
                float& one = found[at(c, i)];
                one = static_cast<float>(-directions / double{scale} *
                                         (of_sky * (1.0 + error) + noise * normal(random)));
                if (i == 13) one = 0.0f;  // no direction lights it
                // A record whose light is no number for once has none of this part.
                if (i == 11 && part == 3) one = c ? 1.0f : std::numeric_limits<float>::infinity();
                mb[c] = i == 11 && part == 3 ? 0.0 : -double{one} * double{scale};
                sum[i][c] += mb[c];
            }
            squares[i] += luminance_of(mb) * luminance_of(mb);
        }
        b.next = test::upload(found);
        total += directions;
        of_parts += directions * directions;
        const CacheSettleParams params{
            count, stride, scale, static_cast<float>(total), static_cast<float>(of_parts), 0, 0, 0};
        passes.settle(queue, params, b, sums, settled);
        const Planes out = test::download<float>(settled, 3 * stride);
        for (std::uint32_t i = 0; i < count; ++i) {
            std::array<double, 3> off{}, mean{};
            for (int c = 0; c < 3; ++c) {
                mean[c] = sum[i][c] / total;
                off[c] = mean[c] - (1.0 + 0.5 * c);
            }
            const double all = total * total, e = luminance_of(off), lit = luminance_of(mean);
            const double of_middle = lit > 0.0 ? (lit + lit - e) / (2.0 * lit) : 0.0;
            const double noise = std::max(squares[i] - of_parts * lit * lit, 0.0) / all *
                                 (1.0 + 4.0 * of_parts / all) * of_middle;
            const bool sure = lit > 0.0 && e * e > 4.0 * noise && all >= 12.0 * of_parts;
            const double share = sure ? 1.0 - 4.0 * noise / (e * e) : 0.0;
            (share > 0.5 ? corrected : kept) += 1;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(out[at(c, i)], double{shown[at(c, i)]} + share * off[c], 2e-3)
                    << part << ", record " << i << ", channel " << c;
        }
    }
    EXPECT_GT(corrected, 150);
    EXPECT_GT(kept, 150);
}

// Of a small window few directions see anything: one of fifty, which brings fifty times as much.
// All hemicubes are right, so whatever the directions happen to say, records keep their light in
// the mean.
TEST(Settle, KeepsTheLightOfAllRecordsTogether) {
    constexpr std::uint32_t many = 8192;
    constexpr double seen = 0.02;
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    std::mt19937 random(3);
    std::binomial_distribution<int> hits(8, seen);
    CacheBuffers b;
    b.base = b.shown = test::upload(Planes(3 * many, 1.0f));
    b.bright = test::upload(Planes(3 * many));
    const cl::Buffer sums = test::upload(Planes(4 * many)),
                     settled = test::upload(Planes(3 * many));
    for (int part = 1; part <= 40; ++part) {
        Planes found(3 * many);
        for (std::uint32_t i = 0; i < many; ++i)
            found[i] = found[many + i] = found[2 * many + i] =
                static_cast<float>(-hits(random) / seen);
        b.next = test::upload(found);
        passes.settle(queue, {many, many, 1.0f, 8.0f * part, 64.0f * part, 0, 0, 0}, b, sums,
                      settled);
        if (part < 12) continue;
        const Planes out = test::download<float>(settled, 3 * many);
        double mean = 0.0;
        for (std::uint32_t i = 0; i < many; ++i) mean += double{out[i]} / many;
        EXPECT_NEAR(mean, 1.0, 0.01) << part;
    }
}

TEST(Settle, RefusesWhatDoesNotFit) {
    const CachePasses passes(test::programs(), test::usual_build());
    const std::uint32_t stride = test::padded(count);
    const cl::Buffer planes = test::upload(Planes(4 * stride)), few = test::upload(Planes(stride));
    CacheBuffers b;
    b.next = b.base = b.bright = b.shown = planes;
    const auto settle = [&](const CacheSettleParams& of, const cl::Buffer& sums) {
        passes.settle(test::device().queue, of, b, sums, planes).wait();
    };
    const CacheSettleParams right{count, stride, 1.0f, 1.0f, 1.0f, 0, 0, 0};
    EXPECT_NO_THROW(settle(right, planes));
    EXPECT_THROW(settle(right, few), Error);
    EXPECT_THROW(settle({count, stride, 0.0f, 1.0f, 1.0f, 0, 0, 0}, planes), Error);
    EXPECT_THROW(settle({count, stride, 1.0f, 0.0f, 1.0f, 0, 0, 0}, planes), Error);
    EXPECT_THROW(settle({stride + 1, stride, 1.0f, 1.0f, 1.0f, 0, 0, 0}, planes), Error);
    for (cl::Buffer* of : {&b.next, &b.base, &b.bright, &b.shown}) {
        const cl::Buffer whole = *of;
        *of = few;
        EXPECT_THROW(settle(right, planes), Error);
        *of = whole;
    }
}

}  // namespace
}  // namespace clgi
