// The environment behind everything, texel by texel and channel by channel, against the mapping
// that clgi/scene.hpp states.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "frames.hpp"
#include "lighting.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// Every texel and channel has a value of its own.
Environment coloured_sky(int width, int height) {
    Environment sky;
    sky.width = width;
    sky.height = height;
    for (int i = 0; i < width * height; ++i)
        sky.texels.emplace_back(1 + 3 * i, 2 + 3 * i, 3 + 3 * i);
    sky.factor = {1.0f, 0.25f, 2.0f};
    return sky;
}

struct SkyPlace {
    int column = 0, row = 0;
    bool near_border = false;  // rounding may choose the next texel
};

// Points across a pixel, and down: as many as four a texel's width need, at most four.
int points_of(const Environment& sky, const View& view, double side) {
    if (view.eye.w != 0.0f) return 1;
    const double wide =
        std::max(double{view.right.w} / view.width, double{view.up.w} / view.height) * 2 * side;
    return std::clamp(static_cast<int>(std::ceil(4 * wide * sky.width / (2 * pi))), 1, 4);
}

struct SkyMean {
    glm::dvec3 texel{0.0};  // times the factor
    bool near_border = false;
};

// The middle of the picture is -Z, three quarters of its width are +X, both edges +Z; row 0 lies
// around +Y. A rotation turns the picture counter-clockwise seen from above.
SkyPlace place_of(const Environment& sky, const glm::dvec3& direction, double rotation) {
    // Back by the rotation: from above, +X is a quarter turn clockwise of -Z.
    const double clockwise = std::atan2(direction.x, -direction.z) + rotation;
    const double turns = clockwise / (2 * pi) + 0.5;
    const double across = (turns - std::floor(turns)) * sky.width;
    const double down = std::acos(glm::normalize(direction).y) / pi * sky.height;
    SkyPlace out{static_cast<int>(across), static_cast<int>(down), false};
    // Angles of floats, some roundings of up to a whole turn and of up to as many texels.
    const double slack = 16 * 0x1p-24 * (sky.width + sky.height) + 1e-6;
    out.near_border =
        std::abs(across - std::round(across)) < slack || std::abs(down - std::round(down)) < slack;
    return out;
}

// (across, down): of the pixel, from its upper left corner.
glm::dvec3 direction_of(const View& view, std::uint32_t pixel, double across, double down) {
    const glm::dvec3 forward(view.forward);
    if (view.eye.w != 0.0f) return forward;
    const double x = (pixel % view.width + across) * 2.0 / view.width - 1.0;
    const double y = 1.0 - (pixel / view.width + down) * 2.0 / view.height;
    return forward + glm::dvec3(view.right) * (x * double{view.right.w} + double{view.window.x}) +
           glm::dvec3(view.up) * (y * double{view.up.w} + double{view.window.y});
}

// Of a pixel, over the share of its area that the view says.
SkyMean mean_of(const Environment& sky, const View& view, std::uint32_t pixel, double rotation) {
    const double side = view.window.w > 0.0f ? std::sqrt(double{view.window.w}) : 1.0;
    const int points = points_of(sky, view, side);
    SkyMean out;
    for (int i = 0; i < points; ++i)
        for (int j = 0; j < points; ++j) {
            const auto at = [&](int k) { return 0.5 + side * ((k + 0.5) / points - 0.5); };
            const SkyPlace place = place_of(sky, direction_of(view, pixel, at(i), at(j)), rotation);
            out.near_border = out.near_border || place.near_border;
            out.texel += glm::dvec3(sky.texels[place.row * sky.width + place.column]);
        }
    out.texel *= glm::dvec3(sky.factor) / static_cast<double>(points * points);
    return out;
}

constexpr float before = -7.5f;  // radiance that surfaces have already

// The pass over a G-buffer in which every third pixel has a surface.
std::vector<float> filled(const Environment& sky, const View& view, float turn,
                          const ImagePasses& passes) {
    const std::uint32_t stride = test::padded(std::size_t{view.width} * view.height);
    std::vector<float> planes(GBUFFER_PLANES * stride);
    for (std::uint32_t p = 0; p < view.width * view.height; p += 3)
        planes[(GBUFFER_NORMAL + p % 9 / 3) * stride + p] = p % 2 ? 1.0f : -1.0f;
    std::vector<float> texels;
    for (const glm::vec3& texel : sky.texels)
        for (int c = 0; c < 3; ++c) texels.push_back(texel[c]);
    const cl::Buffer held = test::upload(planes), picture = test::upload(texels);
    const cl::Buffer radiance = test::upload(std::vector<float>(RADIANCE_PLANES * stride, before));
    const EnvironmentParams params{glm::vec4(sky.factor, 1.0f), static_cast<cl_uint>(sky.width),
                                   static_cast<cl_uint>(sky.height), stride, turn};
    passes.environment(test::device().queue, params, view, picture, held, radiance);
    return test::download<float>(radiance, RADIANCE_PLANES * stride);
}

View view_along(const glm::dvec3& forward, float extent, bool orthographic) {
    Camera camera = test::camera_at({0, 0, 0}, forward, 1.0f);
    View view{};
    view.eye = glm::vec4(0.3f, -0.2f, 0.1f, orthographic ? 1.0f : 0.0f);
    view.right = glm::vec4(camera.right, extent);
    view.up = glm::vec4(camera.up, 0.7f * extent);
    view.forward = glm::vec4(camera.forward, 0.01f);
    view.window = glm::vec4(0.3f * extent, -0.2f * extent, 1.0f, 0.0f);
    view.width = 53;
    view.height = 37;
    return view;
}

TEST(BackgroundTexels, AreThoseOfTheStatedMapping) {
    std::size_t checked = 0, mixed = 0;
    std::set<int> points;
    for (const auto& [orthographic, share, columns] : {std::tuple(false, 0.0f, 29),
                                                       {false, 0.0625f, 29},
                                                       {false, 1.0f, 61},
                                                       {false, 1.0f, 97},
                                                       {false, 0.25f, 97},
                                                       {true, 0.0f, 29}})
        for (const glm::dvec3& forward :
             {glm::dvec3(0.3, 0.2, -1), {-1, -0.4, 0.5}, {0.2, 1, 0.1}, {0.6, -1, 0.7}})
            for (const float turn : {0.0f, 0.3125f, 0.9375f}) {
                View view = view_along(forward, 2.0f, orthographic);
                view.window.w = share;
                const Environment sky = coloured_sky(columns, columns / 2 - 1);
                points.insert(points_of(sky, view, share > 0.0f ? std::sqrt(share) : 1.0));
                const std::uint32_t stride = test::padded(std::size_t{view.width} * view.height);
                const auto radiance = filled(sky, view, turn, test::image_passes());
                for (std::uint32_t p = 0; p < view.width * view.height; ++p) {
                    const SkyMean mean = mean_of(sky, view, p, 2 * pi * double{turn});
                    for (int c = 0; c < 3; ++c) {
                        const float found = radiance[c * stride + p];
                        if (p % 3 == 0) {
                            ASSERT_EQ(found, before) << p;
                        } else if (!mean.near_border) {
                            ASSERT_NEAR(found, mean.texel[c], 1e-6 * mean.texel[c])
                                << p << ", channel " << c << ", turn " << turn;
                            ++checked;
                            mixed += std::fmod(mean.texel[2] / 2 - 3, 3) != 0.0;
                        }
                    }
                }
            }
    EXPECT_GT(checked, 170000u);
    EXPECT_GT(mixed, 10000u);
    EXPECT_EQ(points, std::set<int>({1, 2, 3, 4}));
}

TEST(BackgroundTexels, ReachAllEdgesOfThePicture) {
    // A texel or two in all: whatever is rounded, columns and rows stay inside.
    for (const auto& [width, height] : {std::pair(1, 1), {2, 1}, {1, 2}, {3, 2}})
        for (const glm::dvec3& forward : {glm::dvec3(0, 1, 1e-4), {0, -1, 1e-4}, {0, 0, 1}}) {
            const Environment sky = coloured_sky(width, height);
            const View view = view_along(forward, 0.4f, false);
            const std::uint32_t stride = test::padded(std::size_t{view.width} * view.height);
            const auto radiance = filled(sky, view, 0.9999999f, test::image_passes());
            for (std::uint32_t p = 1; p < view.width * view.height; p += 3) {
                const SkyMean mean = mean_of(sky, view, p, 2 * pi * double{0.9999999f});
                if (mean.near_border) continue;
                EXPECT_EQ(radiance[2 * stride + p], mean.texel.z);
            }
        }
}

// The whole way from Environment::rotation to the picture.
TEST(BackgroundTexels, TurnAsTheEnvironmentSays) {
    for (const double rotation : {0.0, 0.5, -1.3, 0.5 * pi, 7.0}) {
        Scene scene;
        scene.environment = coloured_sky(29, 13);
        scene.environment->rotation = static_cast<float>(rotation);
        const Camera camera = test::camera_at({0, 0, 0}, {0.5, 0.3, -0.8}, 1.4f);
        SecondOrderOptions options;
        options.width = 43;
        options.height = 31;
        const test::Frame frame = test::render(scene, camera, options);
        const View view = make_view(camera, frame.place, 43, 31);
        std::size_t checked = 0;
        for (std::uint32_t p = 0; p < frame.pixels; ++p) {
            const Environment& sky = *scene.environment;
            const SkyMean mean = mean_of(sky, view, p, double{sky.rotation});
            if (mean.near_border) continue;
            ++checked;
            ASSERT_EQ(frame.radiance[p], glm::vec3(mean.texel)) << p << ", rotation " << rotation;
        }
        EXPECT_GT(checked, 1200u);
    }
}

}  // namespace
}  // namespace clgi
