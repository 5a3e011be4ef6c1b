// Transfer vectors against closed forms: open sky, walls, caps, spheres; gloss; the inner product
// with light.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <limits>
#include <numbers>

#include "mask_tools.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Blockers;
using test::Drawn;
using test::Eyes;
using test::Triangle;

using std::numbers::pi;

MaskOptions options(int size, int block, int bands = 5) {
    MaskOptions out;
    out.size = size;
    out.block = block;
    out.bands = bands;
    return out;
}

Eyes one_eye(const glm::vec3& normal) {
    Eyes out;
    out.normals[0] = glm::vec4(normal, 0.0f);
    return out;
}

// Triangles that hide all within `half_angle` of an axis: a cone's base at distance 1.
std::vector<Triangle> cap(const glm::dvec3& axis, double half_angle, int corners = 720) {
    const test::TangentFrame frame = test::frame_of(glm::vec3(axis));
    std::vector<Triangle> out;
    const auto at = [&](int k) {
        const double angle = 2 * pi * (k % corners) / corners, r = std::tan(half_angle);
        return frame.normal + r * std::cos(angle) * frame.tangent +
               r * std::sin(angle) * frame.bitangent;
    };
    for (int k = 0; k < corners; ++k) out.push_back({frame.normal, at(k), at(k + 1)});
    return out;
}

// ---- vectors -----------------------------------------------------------------------------------

CLGI_IN_BOTH_MATHS(Transfer);

// Nothing is lost without blockers, whatever the mask, the cells, the bands and the normal.
TEST_P(Transfer, WithoutBlockersIsTheClampedCosine) {
    const BuildOptions how{.math = GetParam()};
    const glm::vec3 normals[] = {{0, 0, 1},  {0, 0, -1},       {1, 0, 0},
                                 {0, -1, 0}, {.3f, -.8f, .5f}, {-.6f, .1f, -.7f}};
    for (const MaskOptions& masks : {options(32, 4), options(16, 8), options(32, 1), options(64, 2),
                                     options(32, 4, 1), options(32, 4, 9)})
        for (const glm::vec3& normal : normals) {
            const auto found = test::transfer_vectors(
                test::draw_masks({}, one_eye(normal), masks, how), CellIntegral::exact, how);
            const auto wanted =
                sh::around(glm::normalize(glm::dvec3(normal)), sh::cosine_kernel(masks.bands));
            // Sums of 2 bands - 1 values of up to 10 times the coefficients.
            for (std::size_t i = 0; i < wanted.size(); ++i)
                EXPECT_NEAR(found[0][i], wanted[i], 1e-5) << masks.bands << ", " << i;
            EXPECT_NEAR(std::sqrt(4 * pi) * found[0][0], pi, 4 * 0x1p-23 * pi);
        }
}

// Small triangles, each before a receiver of its own, block a pixel or two: what is left is the
// integral of every cell times its share of open pixels.
TEST_P(Transfer, IsTheSumOfItsCells) {
    test::Random random(29);
    std::vector<test::Triangle> triangles;
    while (triangles.size() < 80) {
        const glm::dvec3 d(random(-1, 1), random(-1, 1), random(0.3, 1));
        triangles.push_back({d, d + glm::dvec3(0.12, 0, 0), d + glm::dvec3(0, 0.12, 0)});
    }
    Eyes eyes;
    eyes.positions.resize(triangles.size(), eyes.positions[0]);
    eyes.normals.resize(triangles.size(), eyes.normals[0]);
    const BuildOptions how{.math = GetParam(), .packet_width = 1};
    for (const int block : {1, 2, 4, 8}) {
        const Drawn drawn =
            test::draw_masks(test::one_each(triangles), eyes, options(32, block), how);
        const MaskWeights weights = mask_weights(32, block);
        const auto found = test::transfer_vectors(drawn, CellIntegral::exact, how);
        const int side = 32 / block;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            std::vector<double> wanted(25, 0.0);
            for (int cell = 0; cell < side * side; ++cell) {
                if (weights.pixels[cell] == 0) continue;
                int blocked = 0;
                for (int k = 0; k < block * block; ++k)
                    blocked += drawn.bit(i, cell / side * block + k / block,
                                         cell % side * block + k % block);
                for (int term = 0; term < 25; ++term)
                    wanted[term] += weights.integrals[25 * cell + term] *
                                    (1.0 - double(blocked) / weights.pixels[cell]);
            }
            for (int term = 0; term < 25; ++term)
                EXPECT_NEAR(found[i][term], wanted[term], 1e-5) << block << ", " << i;
        }
    }
}

TEST_P(Transfer, BehindBlockersAllAroundIsNothing) {
    const BuildOptions how{.math = GetParam()};
    for (const MaskOptions& masks : {options(32, 4), options(32, 1), options(8, 8)}) {
        const auto found = test::transfer_vectors(
            test::draw_masks(Blockers(test::icosahedron()), one_eye({.3f, -.8f, .5f}), masks, how),
            CellIntegral::exact, how);
        for (const double value : found[0]) EXPECT_NEAR(value, 0.0, 2e-5);
    }
}

// A wall beside the receiver (STABILITY 1.5): V* has the terms of half a hemisphere. The wall
// follows the columns of the mask, so cells are open or blocked and nothing is lost.
TEST_P(Transfer, BesideAWallIsHalfOfTheSky) {
    const BuildOptions how{.math = GetParam()};
    std::vector<double> wanted(25);
    const std::pair<std::array<int, 2>, double> terms[] = {
        {{0, 0}, .4431134627}, {{1, 0}, .5116633540},  {{1, 1}, -.3257350079},
        {{2, 0}, .2477079561}, {{2, 1}, -.4290427654}, {{3, 1}, -.3046971996},
        {{3, 3}, .0786724787}, {{4, 0}, -.0553891828}, {{4, 1}, -.1313669816},
        {{4, 3}, .1158547880}};
    for (const auto& [lm, value] : terms)
        wanted[static_cast<std::size_t>(sh::index(lm[0], lm[1]))] = value;
    const std::vector<Triangle> wall = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                        {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}};
    for (const MaskOptions& masks : {options(32, 4), options(16, 2), options(64, 1)}) {
        const auto found = test::transfer_vectors(test::draw_masks(Blockers(wall), {}, masks, how),
                                                  CellIntegral::exact, how);
        for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(found[0][i], wanted[i], 1e-5) << i;
    }
    // Turned with the normal: R takes z to the normal and x to the tangent.
    const glm::vec3 normal(.3f, -.8f, .5f);
    const test::TangentFrame frame = test::frame_of(normal);
    const sh::Rotation turn(glm::dmat3(frame.tangent, frame.bitangent, frame.normal), 5);
    std::vector<Triangle> turned = wall;
    for (Triangle& t : turned)
        for (glm::dvec3& p : t)
            p = p.x * frame.tangent + p.y * frame.bitangent + p.z * frame.normal;
    const auto found = test::transfer_vectors(
        test::draw_masks(Blockers(turned), one_eye(normal), {}, how), CellIntegral::exact, how);
    const std::vector<double> expected = turn(wanted);
    for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(found[0][i], expected[i], 1e-5) << i;
}

// A disc over the receiver: E = pi cos^2 a, and terms of STABILITY 1.5. What is lost is that of
// pixels at the disc's edge, and that light is taken to be even over a cell.
TEST_P(Transfer, UnderADiscIsARing) {
    const BuildOptions how{.math = GetParam()};
    const std::pair<double, std::array<double, 5>> cases[] = {
        {10, {.85950391, .97739179, .43701280, -.06752876, -.18501022}},
        {30, {.66467019, .66467019, .09289048, -.38073768, -.42061161}},
        {45, {.44311346, .36180063, -.12385398, -.41449469, -.26309862}}};
    struct Case {
        MaskOptions masks;
        double most[3];  // per cent, a tenth above what was measured
    };
    const Case kinds[] = {{options(16, 4), {6.3, 9.5, 26.4}}, {options(32, 4), {1.0, 3.1, 8.8}},
                          {options(32, 2), {1.0, 2.3, 4.0}},  {options(32, 1), {0.13, 1.9, 3.4}},
                          {options(64, 4), {0.4, 1.0, 2.4}},  {options(128, 4), {.07, .26, .57}},
                          {options(128, 1), {.1, .18, .38}}};
    for (int k = 0; k < 3; ++k) {
        const auto& [degrees, terms] = cases[k];
        std::vector<double> wanted(25);
        for (int l = 0; l < 5; ++l) wanted[sh::index(l, 0)] = terms[l];
        const Blockers blockers(cap({0, 0, 1}, degrees * pi / 180));
        for (const Case& kind : kinds) {
            const auto found = test::transfer_vectors(
                test::draw_masks(blockers, {}, kind.masks, how), CellIntegral::exact, how);
            const double error = 100 * test::relative_l2(found[0], wanted);
            std::printf("[          ] disc of %g degrees, R = %d, B = %d: %.2f %%\n", degrees,
                        kind.masks.size, kind.masks.block, error);
            EXPECT_LT(error, kind.most[k])
                << degrees << ", " << kind.masks.size << ", " << kind.masks.block;
        }
    }
}

// E = pi (1 - sin^2 a cos theta) under a sphere of angular radius a, wholly above the horizon.
TEST_P(Transfer, UnderASphere) {
    const BuildOptions how{.math = GetParam()};
    for (const glm::vec3& normal : {glm::vec3(0, 0, 1), glm::vec3(.3f, -.8f, .5f)}) {
        const test::TangentFrame frame = test::frame_of(normal);
        for (const double theta : {0.0, 20.0, 45.0, 58.0}) {
            const double t = theta * pi / 180, a = pi / 6;
            const glm::dvec3 axis = std::cos(t) * frame.normal +
                                    std::sin(t) * glm::normalize(frame.tangent + frame.bitangent);
            // Corners on the sphere: flat triangles are inside it by a hundredth of a radius.
            const Blockers blockers(test::placed(test::icosphere(4), 1.0, 2.0 * axis));
            const auto found = test::transfer_vectors(
                test::draw_masks(blockers, one_eye(normal), {}, how), CellIntegral::exact, how);
            const double wanted = pi * (1 - std::sin(a) * std::sin(a) * std::cos(t));
            EXPECT_NEAR(std::sqrt(4 * pi) * found[0][0], wanted, 0.015 * pi) << theta;
        }
    }
}

// Overlapping discs block what their union blocks, not the sum.
TEST_P(Transfer, FusesOverlappingBlockers) {
    const BuildOptions how{.math = GetParam()};
    const std::vector<Triangle> one = cap({0, 0, 1}, 0.6), larger = cap({0, 0, 1}, 0.9);
    std::vector<Triangle> both = one;
    both.insert(both.end(), larger.begin(), larger.end());
    const auto vector = [&](const std::vector<Triangle>& triangles) {
        return test::transfer_vectors(test::draw_masks(Blockers(triangles), {}, {}, how),
                                      CellIntegral::exact, how);
    };
    EXPECT_EQ(vector(both), vector(larger));
}

// Mean vectors of masks against the sum over pixels in double precision, any cells and normals.
TEST_P(Transfer, IsTheSumOverOpenPixels) {
    const BuildOptions how{.math = GetParam()};
    test::Random random(31);
    std::vector<Triangle> triangles;
    for (int i = 0; i < 12; ++i) triangles.push_back(test::random_triangle(random));
    Eyes eyes;
    eyes.positions.resize(21, eyes.positions[0]);
    eyes.normals.clear();
    for (int i = 0; i < 21; ++i)
        eyes.normals.emplace_back(random(-1, 1), random(-1, 1), random(-1, 1), 0);
    for (const CellIntegral integral :
         {CellIntegral::exact, CellIntegral::centre, CellIntegral::monte_carlo})
        for (const MaskOptions& masks : {options(16, 1, 3), options(32, 2, 5), options(32, 4, 5),
                                         options(64, 4, 4), options(64, 8, 9)}) {
            const Drawn drawn = test::draw_masks(Blockers(triangles), eyes, masks, how);
            const auto found = test::transfer_vectors(drawn, integral, how);
            const MaskWeights weights =
                mask_weights(masks.size, masks.block, masks.bands, integral);
            const std::size_t terms = static_cast<std::size_t>(sh::terms(masks.bands));
            const int side = masks.size / masks.block;
            for (std::size_t i = 0; i < 21; ++i) {
                std::vector<double> local(terms);
                for (const test::Pixel& p : test::disc_pixels(masks.size)) {
                    if (drawn.bit(i, p.column, p.row)) continue;
                    const std::size_t cell = static_cast<std::size_t>(
                        p.column / masks.block * side + p.row / masks.block);
                    for (std::size_t k = 0; k < terms; ++k)
                        local[k] += weights.integrals[cell * terms + k] / weights.pixels[cell];
                }
                const test::TangentFrame frame = test::frame_of(glm::vec3(eyes.normals[i]));
                const sh::Rotation turn(glm::dmat3(frame.tangent, frame.bitangent, frame.normal),
                                        masks.bands);
                const std::vector<double> wanted = turn(local);
                for (std::size_t k = 0; k < terms; ++k)
                    ASSERT_NEAR(found[i][k], wanted[k], 3e-5) << masks.size << ", " << k;
            }
        }
}

// ---- gloss -------------------------------------------------------------------------------------

// integral of Y_i (n + 2) / (2 pi) cos^n(angle to r) cos over the open hemisphere, by midpoints.
// What is blocked are directions with x above 0 in the receiver's frame, if it has a wall.
std::vector<double> lobe(const test::TangentFrame& frame, const glm::dvec3& mirrored,
                         double exponent, bool wall) {
    std::vector<double> out(25);
    constexpr int fine = 600;
    for (int i = 0; i < (wall ? fine / 2 : fine); ++i)
        for (int j = 0; j < fine; ++j) {
            const double x = (2 * i + 1.0) / fine - 1, y = (2 * j + 1.0) / fine - 1;
            if (x * x + y * y >= 1) continue;
            const glm::dvec3 s = x * frame.tangent + y * frame.bitangent +
                                 std::sqrt(1 - x * x - y * y) * frame.normal;
            const double cosine = glm::dot(s, mirrored);
            if (cosine <= 0) continue;
            const double weight =
                (exponent + 2) / (2 * pi) * std::pow(cosine, exponent) * 4.0 / fine / fine;
            const std::vector<double> value = sh::evaluate(s, 5);
            for (int k = 0; k < 25; ++k) out[k] += weight * value[k];
        }
    return out;
}

TEST_P(Transfer, OfGlossIsTheLobeAroundTheMirroredView) {
    const BuildOptions how{.math = GetParam()};
    const glm::vec3 normal(.3f, -.8f, .5f), eye(1.5f, -1.2f, 2.0f), place(.2f, .3f, -.1f);
    const test::TangentFrame frame = test::frame_of(normal);
    const glm::dvec3 view = glm::normalize(glm::dvec3(eye) - glm::dvec3(place));
    const glm::dvec3 mirrored = 2 * glm::dot(view, frame.normal) * frame.normal - view;
    std::vector<Triangle> octants = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                     {{{1, 0, 0}, {0, -1, 0}, {0, 0, 1}}}};
    for (Triangle& t : octants)
        for (glm::dvec3& p : t)
            p = glm::dvec3(place) + p.x * frame.tangent + p.y * frame.bitangent +
                p.z * frame.normal;
    Eyes eyes = one_eye(normal);
    eyes.positions[0] = glm::vec4(place, 1.0f);
    for (const bool wall : {false, true})
        for (const double exponent : {0.0, 1.0, 6.0, 24.0}) {
            const std::vector<double> wanted = lobe(frame, mirrored, exponent, wall);
            for (const MaskOptions& masks : {options(32, 4), options(32, 1)}) {
                const Drawn drawn =
                    test::draw_masks(wall ? Blockers(octants) : Blockers(), eyes, masks, how);
                const MaskWeights weights = mask_weights(masks.size, masks.block);
                const cl::Buffer lobes = test::empty<float>(25 * 16);
                test::mask_passes(masks, how)
                    .integrate_gloss(
                        test::device().queue, drawn.receivers, test::upload(weights.values),
                        test::upload(weights.directions),
                        test::upload(std::vector<float>(16, static_cast<float>(exponent))),
                        glm::vec4(eye, 0.0f), lobes);
                const auto values = test::download<float>(lobes, 25 * 16);
                std::vector<double> found;
                for (int k = 0; k < 25; ++k) found.push_back(values[16 * k]);
                const double error = test::relative_l2(found, wanted);
                std::printf("[          ] gloss, n = %g, B = %d%s: %.4f\n", exponent, masks.block,
                            wall ? ", wall" : "", error);
                // Light is even over a cell; lobes of exponent 0 end at an edge.
                EXPECT_LT(error, (masks.block == 1 ? 0.006 : 0.07) + (exponent == 0.0 ? 0.03 : 0.0))
                    << exponent;
            }
        }
}

// ---- light -------------------------------------------------------------------------------------

TEST_P(Transfer, TimesLightIsIrradianceOfEachChannel) {
    const BuildOptions how{.math = GetParam()};
    test::Random random(3);
    constexpr std::uint32_t count = 19, stride = 32;
    std::vector<float> vectors(25 * stride);
    std::vector<glm::vec4> light(25);
    for (float& value : vectors) value = static_cast<float>(random(-1, 1));
    for (glm::vec4& c : light) c = glm::vec4(random(-1, 1), random(-3, 3), random(-.2, .2), 77);
    ReceiverBuffers r;
    r.count = count;
    r.stride = stride;
    vectors[7 * stride + 4] = std::numeric_limits<float>::quiet_NaN();
    vectors[9 * stride + 9] = -std::numeric_limits<float>::infinity();
    vectors[9 * stride + 13] = std::numeric_limits<float>::infinity();
    vectors[9 * stride + 19] = std::numeric_limits<float>::quiet_NaN();  // of nobody
    for (const std::uint32_t flags : {0u, static_cast<std::uint32_t>(SHADE_CLAMP)}) {
        const cl::Buffer irradiance = test::empty<float>(3 * stride);
        const cl::Buffer lost = test::upload(std::vector<cl_uint>{0});
        BuildOptions narrow = how;
        narrow.packet_width = 4;
        test::mask_passes({}, narrow)
            .shade(test::device().queue, r, test::upload(vectors), test::upload(light), flags,
                   irradiance, lost);
        const auto found = test::download<float>(irradiance, 3 * stride);
        int negative = 0;
        for (std::uint32_t i = 0; i < count; ++i)
            for (int c = 0; c < 3; ++c) {
                double wanted = 0.0;
                for (int k = 0; k < 25; ++k)
                    wanted += double(vectors[k * stride + i]) * light[k][c];
                if (i == 4 || i == 9 || i == 13) {
                    EXPECT_FALSE(std::isfinite(found[c * stride + i])) << i << ", " << flags;
                    continue;
                }
                negative += wanted < 0;
                EXPECT_NEAR(found[c * stride + i], flags ? std::max(wanted, 0.0) : wanted, 1e-5);
            }
        EXPECT_GT(negative, 5);
        EXPECT_EQ(test::download<cl_uint>(lost, 1)[0], 3u);  // packets
    }
}

}  // namespace
}  // namespace clgi
