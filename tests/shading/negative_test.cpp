// Negative VPLs against double precision: where they stand, where they send, their disc and what
// they take, per channel.                                             [Cochran07, section 3.3]
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <numbers>

#include "emitter_reference.hpp"
#include "oblique.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

struct Input {
    NegativeParams params{};
    View view{};
    std::vector<glm::vec3> position, geometric;  // of the pixels; no normal: nothing is there
    std::vector<Vpl> lights;
};

Input random_input(bool orthographic, int vpl_count) {
    test::Random random(orthographic ? 5 : 6);
    Input out;
    const Camera camera = test::oblique_camera();
    out.view.eye = glm::vec4(0.2f, -0.1f, 0.4f, orthographic ? 1.0f : 0.0f);
    out.view.right = glm::vec4(camera.right, 0.7f);
    out.view.up = glm::vec4(camera.up, 0.4f);
    out.view.forward = glm::vec4(camera.forward, 0.01f);
    out.view.window.z = 3.0f;
    out.view.width = 13;
    out.view.height = 9;
    for (std::uint32_t i = 0; i < 13 * 9; ++i) {
        const double z = random(0.2, 1.5), reach = orthographic ? 1.0 : z;
        out.position.emplace_back(glm::dvec3(out.view.eye) + z * glm::dvec3(camera.forward) +
                                  reach * random(-0.7, 0.7) * glm::dvec3(camera.right) +
                                  reach * random(-0.4, 0.4) * glm::dvec3(camera.up));
        out.geometric.push_back(i % 11 == 3 ? glm::vec3(0) : test::random_direction(random));
    }
    for (int l = 0; l < vpl_count; ++l) {
        const glm::vec3 at(random(-1, 1), random(-1, 1), random(-1, 1));
        const float radius2 = static_cast<float>(std::exp2(random(-14, -2)));
        out.lights.push_back(
            {glm::vec4(at, radius2), glm::vec4(test::random_direction(random), radius2 * radius2),
             glm::vec4(l % 5 == 2 ? glm::vec3(0) : test::random_colour(random, 0, 2), 1)});
    }
    out.params.vpl_count = static_cast<cl_uint>(vpl_count);
    out.params.negative_count = 150;
    out.params.footprint = 0.7f;
    out.params.back_facing = 0.03f;
    out.params.shift_x = 0.37f;
    out.params.shift_y = 0.81f;
    return out;
}

std::vector<Vpl> negative_vpls(Input in) {
    const std::uint32_t count = static_cast<std::uint32_t>(in.position.size());
    in.params.stride = test::padded(count);
    std::vector<float> planes(GBUFFER_PLANES * in.params.stride);
    for (std::uint32_t i = 0; i < count; ++i)
        for (int c = 0; c < 3; ++c) {
            planes[(GBUFFER_POSITION + c) * in.params.stride + i] = in.position[i][c];
            planes[(GBUFFER_GEOMETRIC + c) * in.params.stride + i] = in.geometric[i][c];
            planes[(GBUFFER_NORMAL + c) * in.params.stride + i] = c == 1 ? 1.0f : 0.0f;
        }
    const cl::Buffer negative = test::empty<Vpl>(in.params.negative_count);
    if (in.lights.empty()) in.lights.resize(1);
    test::light_passes().negative(test::device().queue, in.params, in.view, test::upload(planes),
                                  test::upload(in.lights), negative);
    return test::download<Vpl>(negative, in.params.negative_count);
}

struct Truth {
    bool doubtful = false;
    glm::dvec3 position{0}, stopped{0}, direction{0};
    double area = 0.0;
    double spread = 0.0;  // length of the sum of directions over that of its parts, [0,1]
};

Truth truth_of(const Input& in, std::uint32_t sample) {
    Truth out;
    const double x = test::halton(sample + 1, 2, double{in.params.shift_x}) * in.view.width;
    const double y = test::halton(sample + 1, 3, double{in.params.shift_y}) * in.view.height;
    out.doubtful = std::abs(x - std::round(x)) < 1e-5 || std::abs(y - std::round(y)) < 1e-5;
    const std::size_t pixel =
        static_cast<std::size_t>(y) * in.view.width + static_cast<std::size_t>(x);
    const glm::dvec3 p(in.position[pixel]), n(in.geometric[pixel]);
    out.position = p;
    glm::dvec3 toward(0);
    double weights = 0.0;
    for (const Vpl& light : in.lights) {
        const glm::dvec3 t = glm::dvec3(light.position) - p;
        const double d = glm::length(t), behind = -glm::dot(n, t);
        const double leaving = -glm::dot(glm::dvec3(light.normal), t);
        const double least = double{in.params.back_facing};
        out.doubtful |= std::abs(behind - least) < 1e-6 || std::abs(leaving) < 1e-6;
        if (behind <= least || leaving <= 0.0) continue;
        const double s = pi * d * d, disc = pi * double{light.position.w};
        const double k = (s + disc) / (s * (s + disc) + disc * disc);
        const glm::dvec3 back = glm::dvec3(light.flux) * (behind / d * leaving / d * k);
        const double weight = 0.2126 * back.x + 0.7152 * back.y + 0.0722 * back.z;
        out.stopped += back;
        toward += t / d * weight;
        weights += weight;
    }
    out.spread = weights > 0.0 ? glm::length(toward) / weights : 0.0;
    if (out.spread > 0.0) out.direction = -glm::normalize(toward);
    // The picture's share of the surface at p, whose slant is bounded at 0.1.
    const glm::dvec3 d = p - glm::dvec3(in.view.eye), forward(in.view.forward);
    const double window = 4.0 * double{in.view.right.w} * double{in.view.up.w};
    const double z = glm::dot(d, forward);
    const glm::dvec3 ray = in.view.eye.w == 0.0f ? glm::normalize(d) : forward;
    const double slant = std::max(std::abs(glm::dot(n, ray)), 0.1);
    // Solid angle of the window's share times distance squared over the cosine at the surface.
    const double across =
        in.view.eye.w == 0.0f ? window * std::pow(z / glm::length(d), 3) * glm::dot(d, d) : window;
    out.area = across / slant / in.params.negative_count;
    return out;
}

class Negative : public testing::TestWithParam<bool> {};

TEST_P(Negative, TakesWhatItsSurfaceStops) {
    constexpr double u = 0x1p-24;
    for (const int lights : {1, 2, 60}) {
        const Input in = random_input(GetParam(), lights);
        const auto found = negative_vpls(in);
        int compared = 0, sent = 0;
        for (std::uint32_t i = 0; i < found.size(); ++i) {
            const Truth truth = truth_of(in, i);
            if (truth.doubtful) continue;
            ++compared;
            const Vpl& light = found[i];
            if (truth.spread == 0.0) {
                EXPECT_EQ(light.flux, glm::vec4(0)) << i;
                EXPECT_EQ(light.position, glm::vec4(0)) << i;
                EXPECT_EQ(light.normal, glm::vec4(0)) << i;
                continue;
            }
            ++sent;
            EXPECT_EQ(light.flux.w, 1.0f);
            // Cosines of at least 0.03 are some 8 spacings off.
            const double off = 8 * u * (8 + 1 / 0.03), radius2 = 0.7 * truth.area / pi;
            EXPECT_NEAR(light.position.w, radius2, radius2 * off) << i;
            EXPECT_NEAR(light.normal.w, radius2 * radius2, radius2 * radius2 * 2 * off) << i;
            for (int c = 0; c < 3; ++c) {
                EXPECT_EQ(light.position[c], static_cast<float>(truth.position[c])) << i;
                EXPECT_NEAR(light.normal[c], truth.direction[c], off / truth.spread) << i;
                const double flux = truth.stopped[c] * truth.area;
                EXPECT_NEAR(light.flux[c], flux, flux * 8 * off) << i << " channel " << c;
            }
        }
        EXPECT_GT(compared, 130);
        EXPECT_GT(sent, lights == 1 ? 5 : 15);
    }
}

TEST_P(Negative, AreNoneWithoutLights) {
    for (const Vpl& light : negative_vpls(random_input(GetParam(), 0)))
        EXPECT_EQ(light.flux, glm::vec4(0));
}

// A light too dim for the square of its weight counts by its direction all the same.
TEST_P(Negative, KeepsTheDirectionOfDimLight) {
    Input in = random_input(GetParam(), 60);
    const auto bright = negative_vpls(in);
    for (Vpl& light : in.lights) light.flux *= 0x1p-80f;
    const auto dim = negative_vpls(in);
    for (std::size_t i = 0; i < dim.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(dim[i].normal[c], bright[i].normal[c], 1e-5) << i;
            EXPECT_NEAR(dim[i].flux[c] * 0x1p80, bright[i].flux[c], 1e-5f * bright[i].flux[c]);
        }
}

INSTANTIATE_TEST_SUITE_P(Cameras, Negative, testing::Bool());

}  // namespace
}  // namespace clgi
