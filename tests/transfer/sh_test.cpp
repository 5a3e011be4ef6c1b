// Spherical harmonics on the host, against polynomials, quadrature and closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/advanced/sh.hpp>
#include <numbers>

#include "scenes.hpp"
#include "sphere_rule.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
const glm::dvec3 up(0, 0, 1);

using Numbers = std::vector<double>;

glm::dvec3 random_direction(test::Random& random) {
    const double z = random(-1, 1), azimuth = random(0, 2 * pi), ring = std::sqrt(1 - z * z);
    return {ring * std::cos(azimuth), ring * std::sin(azimuth), z};
}

// Direction at an angle from +z, towards +x.
glm::dvec3 tilted(double degrees) {
    return {std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180)};
}

// The integral of f Y_i over the sphere.
template <typename Function>
Numbers project(const Function& f, int bands, int order) {
    Numbers out(static_cast<std::size_t>(sh::terms(bands)));
    for (const auto& node : test::sphere_rule(order)) {
        const Numbers y = sh::evaluate(node.direction, bands);
        for (std::size_t i = 0; i < y.size(); ++i) out[i] += node.weight * f(node.direction) * y[i];
    }
    return out;
}

void expect_near(const Numbers& found, const Numbers& wanted, double tolerance) {
    ASSERT_EQ(found.size(), wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], wanted[i], tolerance) << "of term or band " << i;
}

// The coefficients of a kernel around +z, of order 0.
Numbers zonal(const Numbers& kernel) {
    const Numbers all = sh::around(up, kernel);
    Numbers out;
    for (int l = 0; l < static_cast<int>(kernel.size()); ++l)
        out.push_back(all[static_cast<std::size_t>(sh::index(l, 0))]);
    return out;
}

TEST(Sh, NumbersTermsBandByBand) {
    EXPECT_EQ(sh::index(0, 0), 0);
    EXPECT_EQ(sh::index(1, -1), 1);
    EXPECT_EQ(sh::index(4, 4), 24);
    EXPECT_EQ(sh::terms(5), 25);
    for (int l = 0; l < 9; ++l)
        for (int m = -l; m <= l; ++m) EXPECT_EQ(sh::degree(sh::index(l, m)), l);
    EXPECT_EQ(sh::bands_of(81), 9);
}

// Written out by degree and order, with the signs of the basis.
TEST(Sh, IsTheKnownPolynomials) {
    test::Random random(1);
    for (int k = 0; k < 100; ++k) {
        const glm::dvec3 s = random_direction(random);
        const double x = s.x, y = s.y, z = s.z;
        const Numbers wanted = {0.2820947918,
                                0.4886025119 * y,
                                0.4886025119 * z,
                                0.4886025119 * x,
                                1.0925484306 * x * y,
                                1.0925484306 * y * z,
                                0.3153915653 * (3 * z * z - 1),
                                1.0925484306 * x * z,
                                0.5462742153 * (x * x - y * y),
                                0.5900435899 * y * (3 * x * x - y * y),
                                2.8906114426 * x * y * z,
                                0.4570457995 * y * (5 * z * z - 1),
                                0.3731763326 * z * (5 * z * z - 3),
                                0.4570457995 * x * (5 * z * z - 1),
                                1.4453057213 * z * (x * x - y * y),
                                0.5900435899 * x * (x * x - 3 * y * y)};
        expect_near(sh::evaluate(s, 4), wanted, 1e-9);
        EXPECT_NEAR(sh::evaluate(s, 5)[20], 0.1057855469 * (35 * z * z * z * z - 30 * z * z + 3),
                    1e-9);
    }
}

TEST(Sh, IsOrthonormal) {
    std::vector<Numbers> gram(81, Numbers(81));
    for (const auto& node : test::sphere_rule(12)) {
        const Numbers y = sh::evaluate(node.direction, 9);
        for (std::size_t i = 0; i < 81; ++i)
            for (std::size_t j = 0; j < 81; ++j) gram[i][j] += node.weight * y[i] * y[j];
    }
    double worst = 0.0;
    for (std::size_t i = 0; i < 81; ++i)
        for (std::size_t j = 0; j < 81; ++j)
            worst = std::max(worst, std::abs(gram[i][j] - (i == j ? 1.0 : 0.0)));
    EXPECT_LT(worst, 2e-14);  // the rule itself has 1e-14
}

TEST(Sh, HasOrderZeroAloneAtThePoles) {
    for (const double z : {1.0, -1.0}) {
        const Numbers found = sh::evaluate({0, 0, z}, 9);
        float single[81];
        sh::evaluate(glm::vec3(0, 0, z), 9, single);
        for (int l = 0; l < 9; ++l)
            for (int m = -l; m <= l; ++m) {
                const auto i = static_cast<std::size_t>(sh::index(l, m));
                if (m != 0) {
                    EXPECT_EQ(found[i], 0.0);
                    EXPECT_EQ(single[i], 0.0f);
                } else {
                    const double wanted = std::sqrt((2 * l + 1) / (4 * pi)) * std::pow(z, l);
                    EXPECT_NEAR(found[i], wanted, 4e-15);
                    EXPECT_NEAR(single[i], wanted, 2e-6);
                }
            }
    }
}

// |Y| is below 1.5; a unit direction is rounded by 1e-7, and its polynomials have degree 8.
TEST(Sh, IsCloseInSinglePrecision) {
    test::Random random(2);
    double worst = 0.0;
    for (int k = 0; k < 2000; ++k) {
        const glm::vec3 s(random_direction(random));
        float single[81];
        sh::evaluate(s, 9, single);
        const Numbers wanted = sh::evaluate(glm::dvec3(s), 9);
        for (std::size_t i = 0; i < 81; ++i)
            worst = std::max(worst, std::abs(single[i] - wanted[i]));
    }
    EXPECT_LT(worst, 2e-6);
}

TEST(Sh, RefusesWhatItHasNotGot) {
    EXPECT_THROW(sh::evaluate(up, 0), Error);
    EXPECT_THROW(sh::evaluate(up, 10), Error);
    EXPECT_THROW(sh::bands_of(24), Error);
    EXPECT_THROW(sh::bands_of(100), Error);
    EXPECT_THROW(sh::cap_kernel(-0.1, 3), Error);
    EXPECT_THROW(sh::power_kernel(std::nan(""), 3), Error);
    EXPECT_THROW(sh::convolve({1, 1}, Numbers(9)), Error);
    EXPECT_THROW(sh::Rotation(glm::dmat3(1.01), 3), Error);
    EXPECT_THROW(sh::Rotation(glm::dmat3(std::nan("")), 3), Error);
    EXPECT_THROW(sh::Rotation(glm::dmat3(1), 3)(Numbers(16)), Error);
    EXPECT_THROW(sh::least_smoothing({-1, 0, 0, 0}, 0.0), Error);
    EXPECT_THROW(sh::least_smoothing({1, std::nan(""), 0, 0}, 0.0), Error);
}

// ---- kernels -----------------------------------------------------------------------------------

TEST(ShKernel, OfTheCosineIsThePapersTable) {
    expect_near(
        sh::cosine_kernel(9),
        {pi, 2.0943951024, 0.7853981634, 0, -0.1308996939, 0, 0.0490873852, 0, -0.0245436926},
        1e-10);
    const Numbers c = zonal(sh::cosine_kernel(5));
    expect_near(c, {0.8862269255, 1.0233267079, 0.4954159122, 0, -0.1107783657}, 1e-10);
    const Numbers kept = {0.375, 0.875, 0.9921875, 0.9921875, 0.998046875};
    double energy = 0.0;
    for (std::size_t l = 0; l < 5; ++l) {
        energy += c[l] * c[l] / (2 * pi / 3);
        EXPECT_NEAR(energy, kept[l], 1e-14);
    }
}

TEST(ShKernel, OfAPowerIsItsIntegral) {
    for (const double exponent : {0.0, 0.5, 1.0, 2.0, 7.3, 40.0, 10000.0}) {
        const Numbers found = sh::power_kernel(exponent, 9);
        for (int l = 0; l < 9; ++l) {
            double wanted = 0.0;  // z = t^2, so that the root of z is a polynomial
            for (const auto& t : test::gauss(400, 0.0, 1.0))
                wanted += 2 * pi * t.weight * 2 * t.at * std::pow(t.at * t.at, exponent) *
                          std::legendre(static_cast<unsigned>(l), t.at * t.at);
            EXPECT_NEAR(found[static_cast<std::size_t>(l)], wanted, 1e-12) << exponent << ", " << l;
        }
    }
}

TEST(ShKernel, OfTheHemisphereIsTheTable) {
    expect_near(zonal(sh::power_kernel(0.0, 7)),
                {1.7724538509, 1.5349900619, 0, -0.5861840125, 0, 0.3674102739, 0}, 1e-10);
    expect_near(sh::power_kernel(0.0, 7), sh::cap_kernel(0.5 * pi, 7), 1e-14);
}

// Light from everywhere: the lobe of docs/materials.md reflects all of it at normal incidence.
TEST(ShKernel, OfThePhongLobeKeepsEnergy) {
    for (const double n : {0.0, 1.0, 30.0, 10000.0})
        EXPECT_NEAR((n + 2) / (2 * pi) * sh::power_kernel(n + 1, 1)[0], 1.0, 1e-14);
    expect_near(sh::phong_kernel(3.0, 3), {5.0 / 4, 1.0, 5.0 * 3 / (4 * 6)}, 1e-14);
    EXPECT_NEAR(sh::phong_kernel(0.0, 1)[0], 2.0, 1e-14);  // 1 / pi over 2 pi
}

TEST(ShKernel, OfACapIsTheTable) {
    expect_near(zonal(sh::cap_kernel(5 * pi / 180, 5)),
                {.00674472, .01165997, .01499568, .01764179, .01985137}, 6e-9);
    expect_near(zonal(sh::cap_kernel(30 * pi / 180, 5)),
                {.23746379, .38374752, .42904277, .40300151, .32378697}, 6e-9);
    // A point in the limit, without cancellation: k_l / solid angle -> 1.
    for (const double k : sh::cap_kernel(1e-6, 9)) EXPECT_NEAR(k / (pi * 1e-12), 1.0, 1e-10);
    expect_near(sh::cap_kernel(pi, 4), {4 * pi, 0, 0, 0}, 1e-14);
}

// A ball above the horizon hides pi sin^2 a cos theta of irradiance.
TEST(ShKernel, OfABallTakesItsIrradiance) {
    const double k = sh::cap_kernel(30 * pi / 180, 2)[1];
    EXPECT_NEAR(pi - k * std::cos(45 * pi / 180), 2.58623229, 5e-9);
}

// ---- light and irradiance
// ------------------------------------------------------------------------

double irradiance_of(const Numbers& radiance, const glm::dvec3& normal) {
    std::vector<glm::dvec3> coefficients;
    for (const double c : radiance) coefficients.push_back({c, 2 * c, 0});
    const glm::dvec3 found = sh::irradiance(coefficients, normal);
    EXPECT_DOUBLE_EQ(found.y, 2 * found.x);
    EXPECT_EQ(found.z, 0.0);
    return found.x;
}

TEST(ShIrradiance, OfSimpleSkiesIsExact) {
    const Numbers constant = project([](const glm::dvec3&) { return 1.0; }, 5, 8);
    EXPECT_NEAR(constant[0], 3.5449077018, 1e-10);
    const Numbers slope = project([](const glm::dvec3& s) { return 1.0 + s.z; }, 5, 8);
    EXPECT_NEAR(slope[0], 3.54490770, 5e-9);
    EXPECT_NEAR(slope[2], 2.04665342, 5e-9);
    test::Random random(3);
    for (int k = 0; k < 50; ++k) {
        const glm::dvec3 n = random_direction(random);
        EXPECT_NEAR(irradiance_of(constant, n), pi, 1e-12);
        EXPECT_NEAR(irradiance_of(slope, n), pi + 2 * pi / 3 * n.z, 1e-12);
    }
    EXPECT_NEAR(irradiance_of(slope, up), 5.23598776, 5e-9);
    EXPECT_NEAR(irradiance_of(slope, -up), 1.04719755, 5e-9);
}

TEST(ShIrradiance, OfHalfASkyIsTheTable) {
    const struct {
        double degrees, two, four;
    } rows[] = {{0, 2.07803264, 2.09030449},
                {45, 1.58723788, 1.58225245},
                {90, .66267970, .66728164},
                {135, .10627691, .10129147},
                {180, -.01636246, -.00409062}};
    for (const auto& row : rows)
        for (const glm::dvec3& axis : {up, glm::normalize(glm::dvec3(0.3, -2, 0.7))}) {
            const glm::dvec3 aside = glm::normalize(glm::cross(axis, glm::dvec3(1, 2, 3)));
            const glm::dvec3 n =
                std::cos(row.degrees * pi / 180) * axis + std::sin(row.degrees * pi / 180) * aside;
            EXPECT_NEAR(irradiance_of(sh::around(axis, sh::cosine_kernel(3)), n), row.two, 6e-9);
            EXPECT_NEAR(irradiance_of(sh::around(axis, sh::cosine_kernel(5)), n), row.four, 6e-9);
        }
}

// Least and largest value on the great circle through the axis.
struct Extremes {
    double least = HUGE_VAL, most = -HUGE_VAL, where = 0;  // degrees of the least
};

Extremes extremes(const Numbers& coefficients) {
    Extremes out;
    for (int k = 0; k <= 36000; ++k) {
        const double v = sh::value(coefficients, tilted(0.005 * k));
        out.most = std::max(out.most, v);
        if (v < out.least) out.where = 0.005 * k;
        out.least = std::min(out.least, v);
    }
    return out;
}

Numbers point_irradiance(int bands, sh::Window window) {
    return sh::convolve(sh::window(window, bands), sh::around(up, sh::cosine_kernel(bands)));
}

TEST(ShWindow, RingsAsTheTableSays) {
    using sh::Window;
    const struct {
        int bands;
        Window window;
        double peak, least;
    } rows[] = {{2, Window::none, .75, -.25},
                {3, Window::none, 1.0625, -.03958333},
                {5, Window::none, .96875, -.03125},
                {9, Window::none, .98632812, -.01367187},
                {2, Window::hann, .5, 0},
                {5, Window::hann, .897836, -.015822},
                {5, Window::lanczos, .932327, -.013041},
                {9, Window::lanczos, .978442, -.006070}};
    for (const auto& row : rows) {
        const Numbers light = point_irradiance(row.bands, row.window);
        const Extremes found = extremes(light);
        EXPECT_NEAR(sh::value(light, up), row.peak, 6e-7);
        EXPECT_NEAR(found.least, row.least, 6e-7);
        if (row.bands == 3) {
            EXPECT_NEAR(found.where, 122.231, 0.006);
        }
    }
    const struct {
        Window window;
        double ratio;
    } radiance[] = {{Window::none, -.1517}, {Window::hann, -.0381}, {Window::lanczos, -.0560}};
    for (const auto& row : radiance) {
        const Extremes found =
            extremes(sh::convolve(sh::window(row.window, 5), sh::around(up, Numbers(5, 1.0))));
        EXPECT_NEAR(found.least / found.most, row.ratio, 6e-5);
    }
}

TEST(ShWindow, SmoothsNoMoreThanTheBoundNeeds) {
    const Numbers light = sh::around(glm::normalize(glm::dvec3(1, -2, 0.4)), Numbers(5, 1.0));
    const auto least = [&](double smoothing) {
        double out = HUGE_VAL;
        for (const auto& node : test::sphere_rule(60))
            out = std::min(out, sh::value(sh::convolve(sh::smoothing_window(smoothing, 5), light),
                                          node.direction));
        return out;
    };
    for (const double bound : {-0.1, -0.01, 0.0, 0.05}) {
        const double smoothing = sh::least_smoothing(light, bound);
        EXPECT_GT(smoothing, 0.0);
        EXPECT_GE(least(smoothing), bound - 1e-3);  // between the directions of the grid
        EXPECT_LT(least(0.98 * smoothing), bound);
    }
    EXPECT_EQ(sh::least_smoothing(light, -1.0), 0.0);
    // A single band's factor, by hand.
    EXPECT_NEAR(sh::smoothing_window(0.25, 2)[1], 0.5, 1e-15);
}

// ---- what a surface beside a wall receives -----------------------------------------------------

// Cosine-weighted visibility beside a wall that rises at b degrees from +x towards +z.
Numbers beside_wall(double degrees) {
    Numbers out(25);
    for (const auto& turn : test::gauss(40, degrees * pi / 180, pi))
        for (const auto& from_y : test::gauss(40, 0, pi)) {
            const double ring = std::sin(from_y.at);
            const glm::dvec3 s(ring * std::cos(turn.at), std::cos(from_y.at),
                               ring * std::sin(turn.at));
            const Numbers y = sh::evaluate(s, 5);
            for (std::size_t i = 0; i < 25; ++i)
                out[i] += turn.weight * from_y.weight * ring * s.z * y[i];
        }
    return out;
}

TEST(ShTransfer, BesideAWallIsTheTable) {
    Numbers wanted(25);
    const auto set = [&](int l, int m, double c) {
        wanted[static_cast<std::size_t>(sh::index(l, m))] = c;
    };
    set(0, 0, .4431134627), set(1, 0, .5116633540), set(1, 1, -.3257350079);
    set(2, 0, .2477079561), set(2, 1, -.4290427654), set(3, 1, -.3046971996);
    set(3, 3, .0786724787), set(4, 0, -.0553891828), set(4, 1, -.1313669816);
    set(4, 3, .1158547880);
    expect_near(beside_wall(90), wanted, 1e-10);
    for (const double degrees : {0.0, 60.0, 90.0, 120.0, 180.0})
        EXPECT_NEAR(std::sqrt(4 * pi) * beside_wall(degrees)[0],
                    pi * (1 + std::cos(degrees * pi / 180)) / 2, 1e-12);
}

// What a disc in front of the surface leaves: the integral of z over the rest of the hemisphere.
TEST(ShTransfer, BehindADiscIsTheTable) {
    const struct {
        double degrees;
        Numbers wanted;
    } rows[] = {{10, {.85950391, .97739179, .43701280, -.06752876, -.18501022}},
                {30, {.66467019, .66467019, .09289048, -.38073768, -.42061161}},
                {45, {.44311346, .36180063, -.12385398, -.41449469, -.26309862}}};
    for (const auto& row : rows) {
        Numbers found(5);
        const double cosine = std::cos(row.degrees * pi / 180);
        for (const auto& z : test::gauss(20, 0, cosine)) {
            const Numbers y = sh::evaluate(tilted(std::acos(z.at) * 180 / pi), 5);
            for (int l = 0; l < 5; ++l)
                found[static_cast<std::size_t>(l)] +=
                    2 * pi * z.weight * z.at * y[static_cast<std::size_t>(sh::index(l, 0))];
        }
        expect_near(found, row.wanted, 6e-9);
        EXPECT_NEAR(std::sqrt(4 * pi) * found[0], pi * cosine * cosine, 1e-12);
    }
}

}  // namespace
}  // namespace clgi
