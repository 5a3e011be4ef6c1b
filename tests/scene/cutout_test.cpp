// Which pixels an alpha mask leaves, with up to 16 texels across a pixel and every part of alpha at
// work, against double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "patchwork.hpp"
#include "surface_reference.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Looking;
using test::looking;
using test::Random;
using test::SurfaceTruth;

constexpr float cutoff = 0.42f;

// Noise in squares of 1, 2, 4, 8 and 16 texels: coarse levels would have other holes.
Texture mask_texture(int width, int height, Random& random) {
    Texture texture;
    texture.width = width;
    texture.height = height;
    std::vector<double> alpha(static_cast<std::size_t>(width) * height, 128.0);
    for (int side = 1; side <= 16; side *= 2) {
        const int across = (width + side - 1) / side, down = (height + side - 1) / side;
        std::vector<double> squares;
        for (int i = 0; i < across * down; ++i) squares.push_back(random(-60, 60));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                alpha[static_cast<std::size_t>(y * width + x)] +=
                    squares[static_cast<std::size_t>(y / side * across + x / side)];
    }
    for (const double value : alpha) {
        for (int c = 0; c < 3; ++c)
            texture.rgba.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
        texture.rgba.push_back(static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0)));
    }
    return texture;
}

// A bumpy sheet that hides no part of itself, a material for each of its cells.
Scene masked_sheet(std::uint64_t seed) {
    constexpr int cells = 4;
    Random random(seed);
    Scene scene = test::plain_scene();
    scene.materials.clear();
    for (int t = 0; t < 3; ++t) {
        scene.textures.push_back(mask_texture(64 - 9 * t, 32 + 15 * t, random));
        scene.textures.back().wrap_s = static_cast<Wrap>(t);
        scene.textures.back().wrap_t = static_cast<Wrap>((t + 1) % 3);
        scene.textures.back().nearest = t == 2;
    }
    glm::dvec3 grid[cells + 1][cells + 1];
    for (int y = 0; y <= cells; ++y)
        for (int x = 0; x <= cells; ++x)
            grid[y][x] = {x * 0.4 - 0.8, y * 0.4 - 0.8, random(-0.04, 0.04)};
    for (int y = 0; y < cells; ++y)
        for (int x = 0; x < cells; ++x) {
            const int m = y * cells + x;
            Material material;
            material.alpha_mode = AlphaMode::mask;
            material.alpha_cutoff = cutoff;
            material.double_sided = m % 2 == 0;
            material.base_color.w = static_cast<float>(random(0.75, 1.0));
            material.base_texture = test::random_slot(random, 3);
            material.base_texture.texture = m % 8 == 7 ? -1 : m % 3;
            material.base_texture.uv_set = m / 2 % 2;
            const auto finer = static_cast<float>(std::exp2(m % 4));  // twice the texels a step
            for (int c = 0; c < 2; ++c) material.base_texture.transform[c] *= finer;
            // Another one, which alpha has nothing to do with.
            material.emission = glm::vec3(1.0f);
            material.emission_texture = test::random_slot(random, 3);
            material.emission_texture.texture = (m + 1) % 3;
            scene.materials.push_back(material);
            test::add_quad(scene, {grid[y][x], grid[y][x + 1], grid[y + 1][x + 1], grid[y + 1][x]},
                           static_cast<std::uint32_t>(m));
        }
    for (std::size_t v = 0; v < scene.positions.size(); ++v) {
        scene.colors.emplace_back(test::random_vec3(random, 0.1, 1.0), random(0.3, 1.0));
        scene.uvs.emplace_back(test::random_vec3(random, -1, 2), random(-1, 2));
    }
    return scene;
}

class CutOut : public testing::TestWithParam<Looking> {};

TEST_P(CutOut, LeavesWhatHasTheAlphaOfTheCutoffOrMore) {
    const Scene scene = masked_sheet(71);
    Scene solid = scene;
    for (Material& material : solid.materials) material.alpha_mode = AlphaMode::opaque;
    const DeviceScene placed = test::on_device(scene);
    const View view = looking(GetParam(), placed, 301, 229);
    const Drawing drawing = test::draw(placed, view);
    const Drawing covered = test::draw(test::on_device(solid), view);
    const test::SurfaceReference reference(scene, placed);
    std::size_t seen = 0, holes = 0, wrong = 0;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const int triangle = covered.triangle(p);
        if (triangle < 0) {
            EXPECT_EQ(drawing.triangle(p), -1);
            continue;
        }
        const SurfaceTruth truth =
            reference.at(view, triangle, static_cast<double>(p % view.width) + 0.5,
                         static_cast<double>(p / view.width) + 0.5);
        // Rounding of a UV of up to 16 times 64 texels moves it by some 1e-3 of a texel.
        if (truth.near_border || std::abs(truth.alpha - double{cutoff}) < 3e-3 ||
            glm::min(glm::min(truth.weights.x, truth.weights.y), truth.weights.z) < 1e-3)
            continue;
        const bool there = truth.alpha > double{cutoff};
        (there ? seen : holes) += 1;
        wrong += drawing.triangle(p) != (there ? triangle : -1);
    }
    EXPECT_GT(seen, 5000u);
    EXPECT_GT(holes, 5000u);
    EXPECT_EQ(wrong, 0u);
}

INSTANTIATE_TEST_SUITE_P(Views, CutOut,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

}  // namespace
}  // namespace clgi
