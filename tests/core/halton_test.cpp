// Radical inverses against exact fractions, on the host and on the device.
// SPDX-License-Identifier: MIT
#include <clgi/shared/halton.h>
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "device.hpp"
#include "kernel_text.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

struct Fraction {
    std::uint64_t top, bottom;
    double value() const {
        return static_cast<double>(static_cast<long double>(top) /
                                   static_cast<long double>(bottom));
    }
};

// Digit by digit, in integers.
Fraction exact(std::uint64_t index, std::uint64_t base) {
    Fraction out{0, 1};
    for (; index > 0; index /= base) {
        out.top = out.top * base + index % base;
        out.bottom *= base;
    }
    return out;
}

std::vector<float> on_device(const std::vector<cl_uint>& indices, cl_uint base, bool fast = false) {
    const test::Device& on = test::device();
    const auto built = [&](Math math) {
        cl::Program program(on.context, test::kernel_text("tests/support/halton.cl"));
        program.build(on.device, compiler_options(on.device, {math}).c_str());
        return program;
    };
    static const cl::Program strict = built(Math::strict), relaxed = built(Math::fast);
    cl::Kernel kernel(fast ? relaxed : strict, "halton");
    const cl::Buffer asked = test::upload(indices);  // a kernel does not keep its arguments alive
    const cl::Buffer values = test::empty<float>(indices.size());
    kernel.setArg(0, base);
    kernel.setArg(1, asked);
    kernel.setArg(2, values);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(indices.size()));
    return test::download<float>(values, indices.size());
}

std::vector<cl_uint> hard_indices() {
    std::vector<cl_uint> out = {0,           1,           2,           3,
                                12345,       1000000,     0x7fffffffu, 0x80000000u,
                                0x80000001u, 0xfffffffeu, 0xffffffffu};
    for (const std::uint64_t base : {2, 3, 5})  // one digit more begins
        for (std::uint64_t power = base; power <= 0xffffffffu; power *= base)
            for (int step = -1; step <= 1; ++step)
                out.push_back(static_cast<cl_uint>(power + step));
    test::Random random(7);
    for (int i = 0; i < 3000; ++i)
        out.push_back(static_cast<cl_uint>(random(2147480000.0, 4294967295.0)));
    for (int i = 0; i < 3000; ++i) out.push_back(static_cast<cl_uint>(random(0.0, 20000.0)));
    return out;
}

double ulp(double value) {
    const float near = static_cast<float>(value);
    return double{std::nextafter(near, 2.0f)} - near;
}

TEST(Halton, BeginsAsWrittenInThePapers) {
    const float two[] = {1 / 2.f, 1 / 4.f, 3 / 4.f, 1 / 8.f, 5 / 8.f, 3 / 8.f, 7 / 8.f, 1 / 16.f};
    const float three[] = {1 / 3.f, 2 / 3.f, 1 / 9.f, 4 / 9.f, 7 / 9.f,
                           2 / 9.f, 5 / 9.f, 8 / 9.f, 1 / 27.f};
    const float five[] = {1 / 5.f, 2 / 5.f, 3 / 5.f, 4 / 5.f, 1 / 25.f, 6 / 25.f, 11 / 25.f};
    for (uint i = 0; i < std::size(two); ++i) EXPECT_EQ(radical_inverse(i + 1, 2), two[i]);
    for (uint i = 0; i < std::size(three); ++i) EXPECT_EQ(radical_inverse(i + 1, 3), three[i]);
    for (uint i = 0; i < std::size(five); ++i) EXPECT_EQ(radical_inverse(i + 1, 5), five[i]);
}

TEST(Halton, HasTheDigitsOfTheTable) {
    const struct {
        std::uint64_t index, base;
        Fraction wanted;
    } rows[] = {{12345, 2, {9987, 16384}},
                {12345, 3, {4849, 19683}},
                {12345, 5, {2973, 15625}},
                {1000000, 2, {9263, 1048576}},
                {1000000, 3, {575656, 1594323}},
                {1000000, 5, {112, 1953125}},
                {0x7fffffff, 3, {1387926781, 3486784401}},
                {0x7fffffff, 5, {3464728091, 6103515625}},
                {0x80000000, 2, {1, 4294967296}},
                {0x80000000, 3, {2550188248, 3486784401}},
                {0x80000000, 5, {4685431216, 6103515625}},
                {0xffffffff, 3, {2132907247, 10460353203}},
                {0xffffffff, 5, {1060315563, 6103515625}}};
    for (const auto& row : rows) {
        const double wanted = row.wanted.value();
        EXPECT_DOUBLE_EQ(exact(row.index, row.base).value(), wanted);
        EXPECT_NEAR(radical_inverse(static_cast<uint>(row.index), static_cast<uint>(row.base)),
                    wanted, 2.0 * ulp(wanted))
            << row.index << " in base " << row.base;
    }
}

// Two roundings of integers and one division, on a list of indices: on all of them it is 2.4 ulp.
TEST(Halton, IsWithinTwoUlpAndBelowOneEverywhere) {
    const auto indices = hard_indices();
    for (const cl_uint base : {2u, 3u, 5u}) {
        const auto found = on_device(indices, base);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const double wanted = exact(indices[i], base).value();
            for (const float value : {found[i], radical_inverse(indices[i], base)}) {
                EXPECT_LE(std::abs(value - wanted), 2.0 * ulp(wanted))
                    << indices[i] << " base " << base;
                EXPECT_LT(value, 1.0f);
                EXPECT_GE(value, 0.0f);
            }
        }
    }
}

// With u half the spacing of floats at 1: the numerator is rounded by 1 u of itself, the power of
// the base by 0.53 u (of 3), 0.34 u (of 5) or 0.89 u (of 7), and the quotient by half an ulp. A u
// of a number is one ulp at most: 2.1, 1.9 and 2.4 ulp.
TEST(Halton, IsWithinTwoAndAHalfUlpAndBelowOneForAMillionRandomIndices) {
    test::Random random(17);
    std::vector<cl_uint> indices(1 << 18);
    for (const cl_uint base : {2u, 3u, 5u, 7u}) {
        for (cl_uint& index : indices) index = static_cast<cl_uint>(random(0.0, 0x1p32));
        const auto found = on_device(indices, base);
        std::size_t far = 0, outside = 0;
        for (std::size_t i = 0; i < indices.size(); ++i) {
            const double wanted = exact(indices[i], base).value();
            for (const float value : {found[i], radical_inverse(indices[i], base)}) {
                far += std::abs(value - wanted) > 2.5 * ulp(wanted);
                outside += !(value >= 0.0f && value < 1.0f);
            }
        }
        EXPECT_EQ(far, 0u) << "base " << base;
        EXPECT_EQ(outside, 0u) << "base " << base;
    }
}

TEST(Halton, StopsShortOfOneWhereTheFractionRoundsToIt) {
    for (const auto& [index, base] : {std::pair(33554431u, 2u),
                                      {43046720u, 3u},
                                      {14348906u, 3u},
                                      {48828124u, 5u},
                                      {0x7fffffffu, 2u},
                                      {0xffffffffu, 2u},
                                      {0xffffff80u, 2u}}) {
        EXPECT_LT(radical_inverse(index, base), 1.0f) << index;
        for (const bool fast : {false, true})
            EXPECT_LT(on_device({index}, base, fast)[0], 1.0f) << index;
    }
}

TEST(Halton, IsZeroAtIndexZero) { EXPECT_EQ(radical_inverse(0, 3), 0.0f); }

// With the pole left out the heights of a whole power of three balance exactly.
TEST(Halton, BalancesOverPowersOfTheBase) {
    for (const uint count : {80u, 242u, 728u}) {
        double sum = 0.0;
        for (uint i = 1; i <= count; ++i) sum += 2.0 * radical_inverse(i, 3) - 1.0;
        EXPECT_NEAR(sum / count, 0.0, 6e-8);  // float spacing of a value below 1
    }
}

// The largest difference between the share of points in a box at the origin and its area. It is
// found at a box whose sides end at points, closed or open.
double star_discrepancy(int count) {
    std::vector<std::pair<double, double>> points;
    for (int i = 1; i <= count; ++i)
        points.emplace_back(exact(static_cast<std::uint64_t>(i), 2).value(),
                            exact(static_cast<std::uint64_t>(i), 3).value());
    std::vector<double> xs{1.0}, ys{1.0};
    for (const auto& [x, y] : points) xs.push_back(x), ys.push_back(y);
    double worst = 0.0;
    for (const double x : xs)
        for (const double y : ys) {
            int open = 0, closed = 0;
            for (const auto& p : points) {
                open += p.first < x && p.second < y;
                closed += p.first <= x && p.second <= y;
            }
            worst = std::max({worst, x * y - double(open) / count, double(closed) / count - x * y});
        }
    return worst;
}

TEST(Halton, HasTheDiscrepancyOfTheTable) {
    const std::pair<int, double> rows[] = {
        {16, 0.17361111}, {64, 0.05208333}, {100, 0.05023920}, {128, 0.03317901}};
    for (const auto& [count, wanted] : rows)
        EXPECT_NEAR(star_discrepancy(count), wanted, 5e-9) << count;
    for (int i = 1; i <= 128; ++i)  // of the floats that are used
        EXPECT_NEAR(radical_inverse(static_cast<uint>(i), 3),
                    exact(static_cast<std::uint64_t>(i), 3).value(), 1.2e-7);
}

TEST(Halton, PutsOnePointInEveryElementaryBox) {
    std::vector<cl_uint> indices(72);
    std::iota(indices.begin(), indices.end(), 72u);
    for (const bool fast : {false, true}) {
        const auto twos = on_device(indices, 2, fast), threes = on_device(indices, 3, fast);
        std::vector<int> hits(8 * 9);
        for (std::size_t i = 0; i < indices.size(); ++i) {
            EXPECT_EQ(twos[i], radical_inverse(indices[i], 2));
            ++hits[static_cast<std::size_t>(twos[i] * 8) * 9 +
                   static_cast<std::size_t>(threes[i] * 9 + 1e-5f)];
        }
        for (const int count : hits) EXPECT_EQ(count, 1);
    }
}

}  // namespace
}  // namespace clgi
