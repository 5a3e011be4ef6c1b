// What the path tracer takes for the texture of a pixel.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>
#include <utility>

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

}  // namespace
}  // namespace clgi
