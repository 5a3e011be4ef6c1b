// Rotated coefficients are those of the rotated function.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/advanced/sh.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

#include "scenes.hpp"
#include "sphere_rule.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

using Numbers = std::vector<double>;

glm::dvec3 turned_direction(test::Random& random) {
    const double z = random(-1, 1), azimuth = random(0, 2 * pi), ring = std::sqrt(1 - z * z);
    return {ring * std::cos(azimuth), ring * std::sin(azimuth), z};
}

glm::dmat3 random_rotation(test::Random& random) {
    return glm::dmat3(glm::rotate(glm::dmat4(1), random(0, 2 * pi), turned_direction(random)));
}

Numbers random_coefficients(test::Random& random, int bands) {
    Numbers out;
    for (int i = 0; i < sh::terms(bands); ++i) out.push_back(random(-1, 1));
    return out;
}

template <typename A, typename B>
double farthest(const std::vector<A>& a, const std::vector<B>& b) {
    EXPECT_EQ(a.size(), b.size());
    double worst = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        worst = std::max(worst, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
    return worst;
}

// Of a sum of 81 terms below 1.5 each, and of one of 81 floats.
TEST(ShRotation, MovesWhatTheFunctionShows) {
    test::Random random(1);
    double worst = 0.0, worst_single = 0.0;
    for (int k = 0; k < 200; ++k) {
        const glm::dmat3 turn = random_rotation(random);
        const Numbers f = random_coefficients(random, 9);
        const sh::Rotation rotation(turn, 9);
        const Numbers turned = rotation(f);
        const std::vector<float> single = rotation(std::vector<float>(f.begin(), f.end()));
        const Numbers from_single(single.begin(), single.end());
        for (int i = 0; i < 20; ++i) {
            const glm::dvec3 s = turned_direction(random);
            const double wanted = sh::value(f, s);
            worst = std::max(worst, std::abs(sh::value(turned, turn * s) - wanted));
            worst_single =
                std::max(worst_single, std::abs(sh::value(from_single, turn * s) - wanted));
        }
    }
    EXPECT_LT(worst, 1e-12);
    EXPECT_LT(worst_single, 1e-5);
}

// Entry for entry: the integral of Y_to(R s) Y_from(s).
TEST(ShRotation, IsTheIntegralOfTheBasis) {
    test::Random random(2);
    glm::dmat3 mirror(1);
    mirror[1][1] = -1;
    for (const glm::dmat3& turn : {random_rotation(random), random_rotation(random), mirror,
                                   random_rotation(random) * mirror}) {
        const sh::Rotation rotation(turn, 9);
        Numbers wanted(static_cast<std::size_t>(sh::rotation_block(9)));
        for (const auto& node : test::sphere_rule(10)) {
            const Numbers from = sh::evaluate(node.direction, 9);
            const Numbers to = sh::evaluate(turn * node.direction, 9);
            std::size_t at = 0;
            for (int l = 0; l < 9; ++l)
                for (int m = -l; m <= l; ++m)
                    for (int n = -l; n <= l; ++n)
                        wanted[at++] += node.weight *
                                        to[static_cast<std::size_t>(sh::index(l, m))] *
                                        from[static_cast<std::size_t>(sh::index(l, n))];
        }
        EXPECT_LT(farthest(rotation.blocks(), wanted), 2e-14);
        EXPECT_EQ(rotation.entry(3, -2, 1), rotation.blocks()[10 + 25 + 7 * 1 + 4]);
    }
}

TEST(ShRotation, ByNothingIsNothing) {
    const sh::Rotation rotation(glm::dmat3(1), 9);
    for (int l = 0; l < 9; ++l)
        for (int m = -l; m <= l; ++m)
            for (int n = -l; n <= l; ++n)
                EXPECT_NEAR(rotation.entry(l, m, n), m == n ? 1.0 : 0.0, m == n ? 2e-15 : 0.0);
}

TEST(ShRotation, OfTwoInARowIsOneOfTheirProduct) {
    test::Random random(4);
    for (int k = 0; k < 50; ++k) {
        const glm::dmat3 a = random_rotation(random), b = random_rotation(random);
        const Numbers f = random_coefficients(random, 9);
        EXPECT_LT(farthest(sh::Rotation(b, 9)(sh::Rotation(a, 9)(f)), sh::Rotation(b * a, 9)(f)),
                  1e-13);
        EXPECT_LT(farthest(sh::Rotation(glm::transpose(a), 9)(sh::Rotation(a, 9)(f)), f), 1e-13);
    }
}

// All 24 rotations that permute the axes: an entry that is 0 is exactly 0, so that a light that
// has no share in a term gets none.
TEST(ShRotation, ByQuarterTurnsLeavesZerosExact) {
    const glm::dvec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    int count = 0;
    for (const glm::dvec3& x : axes)
        for (const glm::dvec3& y : axes) {
            if (glm::dot(x, y) != 0.0) continue;
            const glm::dmat3 turn(x, y, glm::cross(x, y));
            ++count;
            const sh::Rotation rotation(turn, 9), back(glm::transpose(turn), 9);
            for (int l = 0; l < 9; ++l)
                for (int m = -l; m <= l; ++m)
                    for (int n = -l; n <= l; ++n) {
                        const double entry = rotation.entry(l, m, n);
                        EXPECT_TRUE(entry == 0.0 || std::abs(entry) > 1e-3) << entry;
                        EXPECT_NEAR(entry, back.entry(l, n, m), 4e-15);
                        if (l == 1) {
                            EXPECT_EQ(entry, std::round(entry));
                        }
                    }
        }
    EXPECT_EQ(count, 24);
}

TEST(ShRotation, TurnsColours) {
    const glm::dmat3 quarter(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1));
    std::vector<glm::vec3> f(4, glm::vec3(0.0f));
    f[3] = {1, 2, 3};  // x
    const auto turned = sh::Rotation(quarter, 5)(f);
    EXPECT_EQ(turned[1], glm::vec3(1, 2, 3));  // y
    EXPECT_EQ(turned[3], glm::vec3(0.0f));
}

}  // namespace
}  // namespace clgi
