// About a million random inputs, ordinary and hostile, for what is cheap enough to be asked so
// often. Radical inverses: tests/core/halton_test.cpp; pixels of a mesh:
// tests/shading/raster_test.cpp.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "kernel_text.hpp"
#include "lighting.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double u = 0x1p-24;  // half the spacing of floats at 1

glm::vec3 any_direction(test::Random& random) {
    return glm::normalize(glm::vec3(random(-1, 1), random(-1, 1), random(-1, 1)) +
                          glm::vec3(0, 1e-6f, 0));
}

CLGI_IN_BOTH_MATHS(DiscKernel);
CLGI_IN_ALL_MODES(DiscLight);
CLGI_IN_BOTH_MATHS(TonemapOfAnything);

constexpr int launches = 16, pairs = 65536;  // a million together

// One light, and points at distances from `least` to `most`, evenly on a logarithmic scale.
std::vector<test::Receiver> around(test::Random& random, const Vpl& light, double least,
                                   double most) {
    std::vector<test::Receiver> out;
    for (int i = 0; i < pairs; ++i) {
        const auto distance = static_cast<float>(std::exp2(random(least, most)));
        out.push_back(
            {glm::vec3(light.position) + distance * any_direction(random), any_direction(random)});
    }
    return out;
}

Vpl light_at(const glm::vec3& position, const glm::vec3& normal, double area) {
    const auto radius2 = static_cast<float>(area / pi);
    return {glm::vec4(position, radius2), glm::vec4(normal, radius2 * radius2), glm::vec4(1.0f)};
}

// The floor of the kernel's denominator counts below 2^-102: some millionths of the scene from a
// light smaller than that. There it may only take away.
TEST_P(DiscKernel, IsWithinItsRoundingsOfDoublePrecision) {
    test::Random random(31);
    for (int launch = 0; launch < launches; ++launch) {
        // At the origin, where small distances are floats too, and elsewhere.
        const glm::vec3 at = launch % 2 ? 0.5f * any_direction(random) : glm::vec3(0.0f);
        const Vpl light = light_at(at, any_direction(random), std::exp2(random(-40, 0)));
        const auto receivers = around(random, light, launch % 2 ? -20 : -40, 1);
        const auto found = test::gather(receivers, {light}, {});
        double worst = 0.0, most = 0.0;
        for (int i = 0; i < pairs; ++i) {
            const glm::dvec3 t = glm::dvec3(light.position) - glm::dvec3(receivers[i].position);
            const double square = glm::dot(t, t), radius2 = light.position.w;
            const double far = square + radius2, bound = square * far + radius2 * radius2;
            const double receive = glm::dot(glm::dvec3(receivers[i].normal), t);
            const double send = -glm::dot(glm::dvec3(light.normal), t);
            const double sum = std::max(receive, 0.0) * std::max(send, 0.0) * far;
            // In shares of what the light gives at right angles; a receiver may sit on the light.
            const double share = square == 0.0 ? 0.0 : sum / (square * far);
            const double difference = found[i].x * pi * bound / far - share;
            most = std::max(most, difference);
            if (square * bound > 0x1p-102) worst = std::max(worst, std::abs(difference));
        }
        // 16 roundings, and 2 more where a quotient may be 2.5 ulp off.
        const double roundings = GetParam() == Math::fast ? 18 : 16;
        EXPECT_LE(worst, roundings * u);
        EXPECT_LE(most, roundings * u);
        EXPECT_GT(worst, 0.0);
    }
}

TEST_P(DiscLight, StaysFiniteAndBelowTheLightsRadiosity) {
    test::Random random(32);
    for (int launch = 0; launch < launches; ++launch) {
        const double area = std::exp2(random(-60, 10));
        const Vpl light = light_at(glm::vec3(0.0f), any_direction(random), area);
        // From the smallest denormal to a million scenes away.
        const auto found = test::gather(around(random, light, -149, 20), {light}, {});
        float lowest = 0.0f, highest = 0.0f;
        bool finite = true;
        for (const glm::vec3& irradiance : found) {
            finite = finite && std::isfinite(irradiance.x);
            lowest = std::min(lowest, irradiance.x);
            highest = std::max(highest, irradiance.x);
        }
        EXPECT_TRUE(finite) << area;
        EXPECT_EQ(lowest, 0.0f) << area;
        EXPECT_LE(highest, (1 + 18 * u + test::half_error()) / area) << area;
        EXPECT_GT(highest, 0.0f) << area;
    }
}

// Textures of all wrappings and odd sizes; each has bytes of its own, so that a texel of another
// one is found out.
struct Textures {
    Scene scene = test::plain_scene();

    Textures() {
        test::add_floor(scene, 1.0);
        test::Random random(33);
        const std::pair<int, int> sizes[] = {{1, 1}, {3, 5}, {64, 64}, {17, 1}, {256, 2}};
        for (const auto& [width, height] : sizes)
            for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge})
                for (const bool nearest : {false, true}) {
                    Texture texture;
                    texture.width = width;
                    texture.height = height;
                    texture.wrap_s = texture.wrap_t = wrap;
                    texture.nearest = nearest;
                    const int low = lowest(scene.textures.size());
                    for (int i = 0; i < 4 * width * height; ++i)
                        texture.rgba.push_back(
                            static_cast<std::uint8_t>(random.integer(low, low + 7)));
                    scene.textures.push_back(texture);
                }
    }

    static int lowest(std::size_t texture) { return static_cast<int>(8 * texture); }
};

std::vector<glm::vec4> sampled(const Scene& scene, const std::vector<glm::vec4>& places) {
    const test::Device& on = test::device();
    const DeviceScene placed = test::on_device(scene);
    cl::Program program(on.context, test::kernel_text("tests/support/texture.cl"));
    program.build(on.device, "-cl-std=CL1.2");
    cl::Kernel kernel(program, "sample_textures");
    const cl::Buffer asked = test::upload(places);
    const cl::Buffer colors = test::empty<glm::vec4>(places.size());
    for (int i = 0; i < 3; ++i) kernel.setArg(i, *placed.kernel_arguments()[6 + i]);
    kernel.setArg(3, asked);
    kernel.setArg(4, colors);
    on.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(places.size()));
    return test::download<glm::vec4>(colors, places.size());
}

double decoded(double byte) {
    const double s = byte / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

// Of any size, in any place: a few periods, whole numbers, everything a float can be.
float coordinate(test::Random& random) {
    const int kind = random.integer(0, 3);
    if (kind == 0) return static_cast<float>(random(-3, 3));
    if (kind == 1) return static_cast<float>(random.integer(-4, 4));
    if (kind == 2) return static_cast<float>(random(-3000, 3000));
    return static_cast<float>((random(0, 1) < 0.5 ? -1 : 1) * std::exp2(random(-149, 127)));
}

TEST(Texture, StaysBetweenItsDarkestAndItsBrightestTexel) {
    const Textures textures;
    const int count = static_cast<int>(textures.scene.textures.size());
    test::Random random(34);
    std::vector<glm::vec4> places(1 << 20);
    for (glm::vec4& at : places) {
        const double area = random(0, 1) < 0.2 ? 0.0 : std::exp2(random(-149, 127));
        at = {coordinate(random), coordinate(random), area, random.integer(0, count - 1)};
    }
    const auto colors = sampled(textures.scene, places);
    std::size_t outside = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const int low = Textures::lowest(static_cast<std::size_t>(places[i].w));
        for (int c = 0; c < 4; ++c) {
            const double least = c < 3 ? decoded(low) : low / 255.0;
            const double most = c < 3 ? decoded(low + 7) : (low + 7) / 255.0;
            // The table is rounded once, and three mixtures by three roundings each.
            const double slack = 10 * 2 * u * most;
            outside += !(colors[i][c] >= least - slack && colors[i][c] <= most + slack);
        }
    }
    EXPECT_EQ(outside, 0u);
}

// The nearest texel in exact arithmetic; close to a border the device may round into the next.
TEST(Texture, FindsTheNearestTexelOfAMillion) {
    const Textures textures;
    test::Random random(35);
    const int count = static_cast<int>(textures.scene.textures.size());
    std::vector<glm::vec4> places(1 << 20);
    for (glm::vec4& at : places)
        at = {coordinate(random), coordinate(random), 0.0f,
              2 * random.integer(0, count / 2 - 1) + 1};
    const auto colors = sampled(textures.scene, places);
    std::size_t wrong = 0, checked = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Texture& texture = textures.scene.textures[static_cast<std::size_t>(places[i].w)];
        const int size[2] = {texture.width, texture.height};
        int texel[2];
        bool at_border = false;
        for (int axis = 0; axis < 2; ++axis) {
            const bool clamped = texture.wrap_s == Wrap::clamp_to_edge;
            double s = places[i][axis];
            if (!clamped) s -= 2 * std::floor(0.5 * s);
            const double x = std::clamp(s, -2.0, 3.0) * size[axis];
            // u in [0, 2), times the size, less and plus a half: four roundings of 3 * size.
            at_border = at_border || std::abs(x - std::round(x)) < 4 * u * 3 * size[axis] + 1e-30;
            const int whole = static_cast<int>(std::floor(x)), period = 2 * size[axis];
            const int folded = ((whole % period) + period) % period;
            texel[axis] = clamped                          ? std::clamp(whole, 0, size[axis] - 1)
                          : texture.wrap_s == Wrap::repeat ? folded % size[axis]
                          : folded < size[axis]            ? folded
                                                           : period - 1 - folded;
        }
        if (at_border) continue;
        ++checked;
        const std::uint8_t* bytes = &texture.rgba[4 * (texel[1] * texture.width + texel[0])];
        for (int c = 0; c < 3; ++c) wrong += std::abs(colors[i][c] - decoded(bytes[c])) > u;
        wrong += std::abs(colors[i].w - bytes[3] / 255.0) > 2 * u;
    }
    EXPECT_EQ(wrong, 0u);
    // Inside a texel lie half of all coordinates where the texture repeats, in two thirds of the
    // textures, and a quarter where it is clamped.
    EXPECT_GT(checked, places.size() * 3 / 16);
}

// Every bit pattern may come: a byte that the standard's curve names, or for NaN any byte.
TEST_P(TonemapOfAnything, EncodesAMillionRandomBitPatterns) {
    const std::uint32_t count = 349536, stride = count;  // three planes
    test::Random random(36);
    std::vector<float> radiance(RADIANCE_PLANES * stride);
    for (float& value : radiance) {
        // Half of them where the curve is neither 0 nor 1.
        const bool ordinary = random(0, 1) < 0.5;
        const auto bits = static_cast<std::uint32_t>(random(0, 0x1p32));
        std::memcpy(&value, &bits, sizeof value);
        if (ordinary) value = static_cast<float>(std::exp2(random(-14, 0)));
    }
    const cl::Buffer preview = test::empty<cl_uint>(count);
    test::image_passes().tonemap(test::device().queue, {count, 1, stride, 1.0f},
                                 test::upload(radiance), preview);
    const auto words = test::download<cl_uint>(preview, count);
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
        wrong += words[i] >> 24 != 255;
        for (int c = 0; c < 3; ++c) {
            const double value = radiance[c * stride + i];
            if (std::isnan(value)) continue;
            const double linear = std::clamp(value, 0.0, 1.0);
            const double s =
                linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
            // The nearest byte; where it is all but a tie, either: pow may be 16 ulp off.
            wrong += std::abs((words[i] >> (8 * c) & 255) - 255 * s) > 0.5 + 255 * 34 * u;
        }
    }
    EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace clgi
