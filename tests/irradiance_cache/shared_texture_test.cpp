// Light of surfaces that share a texture with others, as in an atlas of a whole scene.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "cache_pictures.hpp"
#include "math_modes.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

constexpr glm::vec3 lamp_of_atlas(3.0f, 2.0f, 1.0f);
constexpr int atlas_side = 256;

// Shines in its middle, a quarter of its side; black around that.
Texture atlas_of_a_lamp() {
    Texture out;
    out.width = out.height = atlas_side;
    for (int y = 0; y < atlas_side; ++y)
        for (int x = 0; x < atlas_side; ++x) {
            const bool shines = std::max(std::abs(x - 127.5), std::abs(y - 127.5)) < 32.0;
            out.rgba.insert(out.rgba.end(), 3, shines ? 255 : 0);
            out.rgba.push_back(255);
        }
    return out;
}

// A floor, and a second material that shines by the texture.
Scene floor_and_lamp(const Material& floor, double half, const Texture& texture) {
    Scene scene;
    scene.materials = {floor};
    test::add_floor(scene, half);
    Material glows;
    glows.base_color = glm::vec4(0, 0, 0, 1);
    glows.emission = lamp_of_atlas;
    glows.emission_texture.texture = 0;
    glows.double_sided = true;
    test::add_material(scene, glows);
    scene.textures = {texture};
    scene.uvs.resize(scene.positions.size(), glm::vec4(0.0f));
    return scene;
}

// A small floor that the camera looks at, and a metre above it wide wings of a ceiling that is
// black. The far ends of their charts are nearest to what shines.
Scene below_a_ceiling(const Material& floor) {
    Scene scene = floor_and_lamp(floor, 0.1, atlas_of_a_lamp());
    constexpr std::uint32_t material = 1;
    for (const double way : {-1.0, 1.0}) {
        const double near = 0.5 * way, far = 10.5 * way;
        test::add_quad(scene,
                       {glm::dvec3(near, 1, -10), {far, 1, -10}, {far, 1, 10}, {near, 1, 10}},
                       material);
        for (const glm::vec2 uv : {glm::vec2(0.02f), {0.3f, 0.02f}, {0.3f, 0.98f}, {0.02f, 0.98f}})
            scene.uvs.emplace_back(uv, 0.0f, 0.0f);
    }
    scene.cameras = {test::camera_at({0, 0.8, 0.001}, {0, 0, 0}, 0.1f)};
    return scene;
}

IrradianceCacheOptions by_coarse_hemicubes() {
    IrradianceCacheOptions out = cache_options(100, 0);
    out.emission = true;
    out.face = 8;
    return out;
}

CLGI_IN_BOTH_MATHS(SharedTextures);

// Between the wings a square metre of lamp: E = 4 L a / A atan(a / A), A^2 = 1 + a^2, a: half its
// side.
TEST_P(SharedTextures, LeaveTheLightOfALampAsItIs) {
    Material floor;
    floor.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    Scene scene = below_a_ceiling(floor);
    const auto lamp = static_cast<std::uint32_t>(scene.materials.size() - 1);
    test::add_quad(
        scene, {glm::dvec3(-0.5, 1, -0.5), {0.5, 1, -0.5}, {0.5, 1, 0.5}, {-0.5, 1, 0.5}}, lamp);
    for (const glm::vec2 uv : {glm::vec2(0.42f), {0.58f, 0.42f}, {0.58f, 0.58f}, {0.42f, 0.58f}})
        scene.uvs.emplace_back(uv, 0.0f, 0.0f);
    const CachePicture found = pictured(scene, by_coarse_hemicubes());
    const double half = 0.5, long_side = std::sqrt(1.0 + half * half);
    const double factor = 4.0 * half / long_side * std::atan(half / long_side);
    for (int c = 0; c < 3; ++c) {
        const double wanted = 0.5 / pi * factor * lamp_of_atlas[c];
        EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted, 0.03 * wanted) << c;
    }
}

// Where all that hemicubes see is black nothing arrives, and where a lobe's rays meet it nothing is
// reflected, at grazing angles either.
TEST_P(SharedTextures, LeaveDarkWhatIsDark) {
    Material diffuse;
    diffuse.base_color = glm::vec4(0.5f, 0.5f, 0.5f, 1.0f);
    for (const Material& floor : {diffuse, test::finished(1.0f, 0.5f, 1.0f)}) {
        Scene scene = below_a_ceiling(floor);
        scene.cameras = {test::camera_at({-2.0, 0.25, 0.001}, {0, 0, 0}, 0.05f)};
        const CachePicture found = pictured(scene, by_coarse_hemicubes());
        EXPECT_GT(found.status.seen, 20u);
        for (const glm::vec3& value : found.radiance) ASSERT_EQ(value, glm::vec3(0.0f));
    }
}

// Form factor of a rectangle from the origin, one metre below its plane: x0..x1 by y0..y1.
double rectangle_above(double x0, double x1, double y0, double y1) {
    const auto corner = [](double x, double y) {
        const double along = std::sqrt(1.0 + x * x), across = std::sqrt(1.0 + y * y);
        return (x / along * std::atan(y / along) + y / across * std::atan(x / across)) / (2.0 * pi);
    };
    return corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0);
}

// A lamp's quarters shine in four colours, where its texture has them: of coordinates far from 0,
// of a texture whose sides differ, which repeats along one and is mirrored along the other, and of
// texels that are far smaller than a pixel of a hemicube.
TEST_P(SharedTextures, ShineWhereTheirTexelsLie) {
    constexpr int width = 1024, height = 256;
    constexpr std::uint8_t byte = 153;  // 0.6; of sRGB 0.3185 (IEC 61966-2-1)
    constexpr glm::vec3 quarters[2][2] = {{{1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 1, 0}}};
    for (const bool linear : {false, true}) {
        Texture texture;
        texture.width = width;
        texture.height = height;
        texture.wrap_t = Wrap::mirrored_repeat;
        texture.srgb = !linear;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x) {
                const glm::vec3 color = quarters[2 * y / height][2 * x / width];
                for (int c = 0; c < 3; ++c)
                    texture.rgba.push_back(static_cast<std::uint8_t>(byte * color[c]));
                texture.rgba.push_back(255);
            }
        Material floor;
        floor.base_color = glm::vec4(0.8f, 0.6f, 0.4f, 1.0f);
        Scene scene = floor_and_lamp(floor, 0.02, texture);
        test::add_quad(scene,
                       {glm::dvec3(0.2, 1, 0.1), {1.4, 1, 0.1}, {1.4, 1, 0.9}, {0.2, 1, 0.9}}, 1);
        // Its rows from 0.1 on are those of the texture from below.
        for (const glm::vec2 uv :
             {glm::vec2(-5.0f, 7.0f), {-4.0f, 7.0f}, {-4.0f, 8.0f}, {-5.0f, 8.0f}})
            scene.uvs.emplace_back(uv, 0.0f, 0.0f);
        scene.cameras = {test::camera_at({0, 0.5, 0.001}, {0, 0, 0}, 0.04f)};
        IrradianceCacheOptions options = by_coarse_hemicubes();
        options.face = 32;
        const glm::dvec3 found = mean_radiance(pictured(scene, options).radiance);
        glm::dvec3 wanted(0.0);
        for (int row = 0; row < 2; ++row)
            for (int column = 0; column < 2; ++column)
                wanted += glm::dvec3(quarters[1 - row][column]) *
                          rectangle_above(0.2 + 0.6 * column, 0.8 + 0.6 * column, 0.1 + 0.4 * row,
                                          0.5 + 0.4 * row);
        wanted *=
            (linear ? 0.6 : 0.3185) * glm::dvec3(lamp_of_atlas) * glm::dvec3(floor.base_color);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], wanted[c], 0.03 * wanted[c]) << c;
    }
}

}  // namespace
}  // namespace clgi
