// Colours of surfaces: factors, vertex colours, textures and alpha masks, against closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>

#include "drawing.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Drawing;

Texture picture(int width, int height, bool nearest) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    texture.nearest = nearest;
    texture.rgba.assign(static_cast<std::size_t>(4 * width * height), 255);
    return texture;
}

// A quad over the whole of an image, u running from u0 to u1 and v from 0 at the top to 1.
Scene textured(const Texture& texture, int width, int height, float u0 = 0.0f, float u1 = 1.0f) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    const double w = width, h = height;
    test::add_quad(scene, {glm::dvec3(0, 0, 0), {w, 0, 0}, {w, h, 0}, {0, h, 0}});
    scene.uvs = {{u0, 1, 0, 0}, {u1, 1, 0, 0}, {u1, 0, 0, 0}, {u0, 0, 0, 0}};
    scene.textures.push_back(texture);
    scene.materials[0].base_texture.texture = 0;
    return scene;
}

double decoded(double s) { return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4); }

TEST(Texture, DecodesEverySrgbByte) {
    Texture ramp = picture(16, 16, true);
    for (int i = 0; i < 256; ++i) ramp.rgba[4 * i] = static_cast<std::uint8_t>(i);
    const Drawing drawing = test::draw(textured(ramp, 16, 16), test::pixel_camera(16, 16), 16, 16);
    for (int i = 0; i < 256; ++i)  // half a float spacing, since the table comes from doubles
        EXPECT_NEAR(drawing.at(GBUFFER_BASE, i).x, decoded(i / 255.0), 6e-8) << i;
}

TEST(Texture, KeepsLinearBytes) {
    Texture ramp = picture(16, 16, true);
    ramp.srgb = false;
    for (int i = 0; i < 256; ++i) ramp.rgba[4 * i + 1] = static_cast<std::uint8_t>(i);
    const Drawing drawing = test::draw(textured(ramp, 16, 16), test::pixel_camera(16, 16), 16, 16);
    for (int i = 0; i < 256; ++i)  // two roundings
        EXPECT_NEAR(drawing.at(GBUFFER_BASE, i).y, i / 255.0, 1.2e-7) << i;
}

// Black and white of the same area, far away: half, and not the byte of half as sRGB has it.
TEST(Texture, HasLinearMipLevels) {
    Texture checker = picture(8, 8, false);
    checker.srgb = false;
    for (int i = 0; i < 64; ++i)
        if ((i + i / 8) % 2) checker.rgba[4 * i] = 0;
    const Drawing drawing = test::draw(textured(checker, 3, 3), test::pixel_camera(3, 3), 3, 3);
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(drawing.at(GBUFFER_BASE, i).x, 0.5, 0.5 / 255 + 1e-6);
}

TEST(Texture, ShowsACheckerTexelByTexel) {
    Texture checker = picture(8, 4, true);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 8; ++x)
            if ((x + y) % 2) checker.rgba[4 * (8 * y + x)] = 0;
    const Drawing drawing =
        test::draw(textured(checker, 64, 32), test::pixel_camera(64, 32), 64, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x)
            EXPECT_EQ(drawing.at(GBUFFER_BASE, 64 * y + x).x, (x / 8 + y / 8) % 2 ? 0.0f : 1.0f);
}

TEST(Texture, InterpolatesLinearLight) {
    Texture two = picture(2, 1, false);
    two.rgba[0] = 0;
    two.wrap_s = Wrap::clamp_to_edge;
    const Drawing drawing = test::draw(textured(two, 64, 8), test::pixel_camera(64, 8), 64, 8);
    for (int x = 0; x < 64; ++x) {
        const double u = (x + 0.5) / 64.0;
        const double wanted = std::min(std::max(2.0 * u - 0.5, 0.0), 1.0);
        EXPECT_NEAR(drawing.at(GBUFFER_BASE, 64 * 4 + x).x, wanted, 2e-6) << x;  // of u itself
    }
}

TEST(Texture, WrapsAsItsSamplerSays) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::mirrored_repeat, Wrap::clamp_to_edge}) {
        Texture steps = picture(4, 1, true);
        for (int x = 0; x < 4; ++x) steps.rgba[4 * x] = static_cast<std::uint8_t>(60 * x);
        steps.wrap_s = wrap;
        // From u = -3 to 5: 8 periods of 16 pixels each, 4 pixels a texel.
        const Drawing drawing =
            test::draw(textured(steps, 128, 4, -3.0f, 5.0f), test::pixel_camera(128, 4), 128, 4);
        for (int x = 0; x < 128; ++x) {
            const int texel = x / 4 - 12;
            const int folded = ((texel % 8) + 8) % 8;
            const int wanted = wrap == Wrap::repeat          ? folded % 4
                               : wrap == Wrap::clamp_to_edge ? std::min(std::max(texel, 0), 3)
                               : folded < 4                  ? folded
                                                             : 7 - folded;
            EXPECT_NEAR(drawing.at(GBUFFER_BASE, 128 + x).x, decoded(60 * wanted / 255.0), 1e-7)
                << static_cast<int>(wrap) << ", pixel " << x;
        }
    }
}

TEST(Texture, FadesToItsMeanFarAway) {
    Texture checker = picture(64, 64, false);
    for (int i = 0; i < 64 * 64; ++i)
        if ((i + i / 64) % 2) checker.rgba[4 * i] = 0;
    const Drawing drawing = test::draw(textured(checker, 4, 4), test::pixel_camera(4, 4), 4, 4);
    for (int p = 0; p < 16; ++p)  // levels are stored in bytes: half of one is 0.0046 near 0.5
        EXPECT_NEAR(drawing.at(GBUFFER_BASE, p).x, 0.5f, 0.0046f);
}

TEST(Texture, FollowsItsTransformAndUvSet) {
    Texture steps = picture(4, 1, true);
    for (int x = 0; x < 4; ++x) steps.rgba[4 * x] = static_cast<std::uint8_t>(60 * x);
    Scene scene = textured(steps, 16, 4);
    for (glm::vec4& uv : scene.uvs) uv = {0.3f, 0.4f, uv.x, uv.y};
    scene.materials[0].base_texture.uv_set = 1;
    scene.materials[0].base_texture.transform[0][0] = 0.5f;   // half as fast
    scene.materials[0].base_texture.transform[2][0] = 0.25f;  // from the second texel
    const Drawing drawing = test::draw(scene, test::pixel_camera(16, 4), 16, 4);
    for (int x = 0; x < 16; ++x)
        EXPECT_NEAR(drawing.at(GBUFFER_BASE, x).x, decoded(60 * (1 + x / 8) / 255.0), 1e-7) << x;
}

TEST(Color, IsFactorTimesVertexColor) {
    Scene scene = test::plain_scene({0.8f, 0.5f, 0.25f});
    test::add_quad(scene, {glm::dvec3(0, 0, 0), {32, 0, 0}, {32, 32, 0}, {0, 32, 0}});
    scene.colors = {{0, 1, 1, 1}, {1, 1, 1, 1}, {1, 1, 0, 1}, {0, 1, 0, 1}};
    const Drawing drawing = test::draw(scene, test::pixel_camera(32, 32), 32, 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) {
            const glm::vec3 albedo = drawing.at(GBUFFER_BASE, 32 * y + x);
            EXPECT_NEAR(albedo.x, 0.8 * (x + 0.5) / 32, 1e-6);
            EXPECT_NEAR(albedo.y, 0.5, 1e-6);
            EXPECT_NEAR(albedo.z, 0.25 * (y + 0.5) / 32, 1e-6);
        }
}

TEST(Mask, LetsThroughWhereAlphaIsBelowItsCutoff) {
    Texture holes = picture(8, 8, true);
    for (int i = 0; i < 64; ++i) holes.rgba[4 * i + 3] = static_cast<std::uint8_t>(4 * i);
    Scene scene = textured(holes, 32, 32);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].alpha_cutoff = 0.5f;
    const auto wall = test::add_material(scene, Material{});
    test::add_quad(scene, {glm::dvec3(0, 0, -5), {32, 0, -5}, {32, 32, -5}, {0, 32, -5}}, wall);
    scene.uvs.resize(scene.positions.size());
    for (const int width : {1, 4, 8}) {
        const DeviceScene placed = test::on_device(scene);
        const Drawing drawing =
            test::draw(placed, make_view(test::pixel_camera(32, 32), placed.frame(), 32, 32),
                       GBufferPasses(test::programs(), {.packet_width = width}));
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 32; ++x) {
                const int alpha = 4 * (8 * (y / 4) + x / 4);
                EXPECT_EQ(drawing.triangle(32 * y + x) < 2, alpha >= 127.5) << x << ", " << y;
            }
    }
}

TEST(Mask, LetsLightThroughAsItLetsSight) {
    Texture holes = picture(2, 1, true);
    holes.rgba[3] = 0;
    Scene scene = textured(holes, 4, 4);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    const Drawing drawing = test::draw(scene, test::pixel_camera(4, 4), 4, 4);
    for (int p = 0; p < 16; ++p) EXPECT_EQ(drawing.triangle(p) >= 0, p % 4 >= 2);
}

}  // namespace
}  // namespace clgi
