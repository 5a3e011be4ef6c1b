// What the path tracer takes for the texture of a pixel.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>
#include <utility>

#include "coverage.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr int charts = 16;  // along a side of the texture, 4 x 4 texels each
constexpr glm::u8vec3 inside(40, 90, 160), outside(255, 250, 245);

// A texture whose charts have one colour in their middle and another around it.
Texture chart_texture() {
    Texture out;
    out.width = out.height = 4 * charts;
    out.srgb = false;
    out.nearest = true;
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            const bool middle = (x % 4 == 1 || x % 4 == 2) && (y % 4 == 1 || y % 4 == 2);
            const glm::u8vec3 color = middle ? inside : outside;
            out.rgba.insert(out.rgba.end(), {color.x, color.y, color.z, 255});
        }
    return out;
}

// A lit floor of charts x charts squares, each with a chart of its own, from far above.
TEST(ReferencePixel, HasTheMeanOfWhatItShowsAndNotOfOtherPartsOfTheTexture) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    scene.textures.push_back(chart_texture());
    scene.materials[0].base_texture.texture = 0;
    const double side = 2.0 / charts;
    for (int y = 0; y < charts; ++y)
        for (int x = 0; x < charts; ++x) {
            const double left = -1.0 + x * side, low = -1.0 + y * side;
            test::add_quad(scene, {glm::dvec3(left, 0.0, low + side),
                                   {left + side, 0.0, low + side},
                                   {left + side, 0.0, low},
                                   {left, 0.0, low}});
            // The middle of another chart, so that neighbours are no neighbours in the texture.
            const float u = static_cast<float>((x * 7 + y * 3) % charts) / charts;
            const float v = static_cast<float>((y * 5 + x) % charts) / charts;
            const float a = 1.25f / (4 * charts), b = 2.75f / (4 * charts);
            for (const auto& [s, t] : {std::pair(a, b), {b, b}, {b, a}, {a, a}})
                scene.uvs.emplace_back(u + s, v + t, 0.0f, 0.0f);
        }
    Light sun;
    sun.kind = Light::Kind::directional;
    sun.direction = glm::vec3(0.0f, -1.0f, 0.0f);
    sun.intensity = glm::vec3(3.14159265f);
    scene.lights.push_back(sun);
    Camera camera;
    camera.position = {0.0, 3.0, 0.0};
    camera.forward = {0.0f, -1.0f, 0.0f};
    camera.right = {1.0f, 0.0f, 0.0f};
    camera.up = {0.0f, 0.0f, -1.0f};
    camera.vertical_fov = 2.0f * std::atan(0.3f);  // inside the floor

    reference::Options options;
    options.effects = reference::parse_effects("direct");
    options.width = options.height = 3;  // a pixel covers several squares
    options.samples = 64;
    const reference::Picture picture = reference::PathTracer(scene).render(camera, options);
    for (const glm::vec3& radiance : picture.radiance)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(radiance[c], static_cast<float>(inside[c]) / 255.0f,
                        1e-4f);  // rough: albedo
}

// The box filter against the exact area of what pixels show, for a picture and for its check.
TEST(ReferencePixel, IsLookedThroughAsAWhole) {
    constexpr int width = 23, height = 17, samples = 4096;
    const std::vector<glm::dvec2> corners = {{3.3, 2.1}, {19.7, 4.9}, {17.2, 14.6}, {6.9, 12.3}};
    const glm::vec3 radiance(1.0f, 2.0f, 4.0f);
    const Scene scene = test::glowing_quad(corners, radiance);
    const Camera camera = test::pixel_camera(width, height);
    const std::vector<double> exact = test::coverage(corners, width, height);
    const reference::PathTracer tracer(scene);
    reference::Options options;
    options.width = width;
    options.height = height;
    options.samples = samples;
    const auto centers = tracer.render(camera, options).radiance;
    options.filter = reference::Filter::box;
    const auto whole = tracer.render(camera, options).radiance;
    std::vector<glm::vec3> truth;
    for (std::size_t i = 0; i < exact.size(); ++i) {
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(whole[i][c] / radiance[c], exact[i], 4.0 * 0.5 / std::sqrt(samples)) << i;
            EXPECT_TRUE(centers[i][c] == 0.0f || centers[i][c] == radiance[c]) << i;
        }
        truth.push_back(static_cast<float>(exact[i]) * radiance);
    }
    reference::VerifyOptions check;
    check.pixels = width * height;
    check.samples = samples;
    const double by_centers = tracer.verify(camera, width, height, truth, check).error.value;
    EXPECT_LT(tracer.verify(camera, width, height, centers, check).error.value, 1e-6);
    check.filter = reference::Filter::box;
    EXPECT_LT(tracer.verify(camera, width, height, truth, check).error.value, 0.02);
    EXPECT_GT(by_centers, 0.1);
    EXPECT_GT(tracer.verify(camera, width, height, centers, check).error.value, 0.1);
}

}  // namespace
}  // namespace clgi
