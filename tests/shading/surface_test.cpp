// Everything that a G-buffer holds of tilted, textured, coloured triangles, per channel and in
// double precision.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "patchwork.hpp"
#include "surface_reference.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Looking;
using test::looking;
using test::patchwork;
using test::Random;
using test::random_vec3;
using test::SurfaceTruth;

struct Worst {
    double position = 0, geometric = 0, normal = 0, albedo = 0, emission = 0;
    std::size_t checked = 0, behind = 0, shining = 0, given_way = 0;
};

void compare(const Scene& scene, const DeviceScene& placed, const Drawing& drawing, Worst& worst) {
    const test::SurfaceReference reference(scene, placed);
    const View& view = drawing.view;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const int triangle = drawing.triangle(p);
        if (triangle < 0) continue;
        const std::uint32_t material = scene.triangles[triangle].material;
        ASSERT_EQ(drawing.ids[GBUFFER_MATERIAL * drawing.stride + p], static_cast<int>(material));
        ASSERT_EQ(drawing.order[drawing.ids[GBUFFER_TRIANGLE * drawing.stride + p]],
                  static_cast<std::uint32_t>(triangle));
        const SurfaceTruth truth =
            reference.at(view, triangle, static_cast<double>(p % view.width) + 0.5,
                         static_cast<double>(p / view.width) + 0.5);
        // At edges weights are cut off; near grazing every rounding grows without bound.
        if (glm::min(glm::min(truth.weights.x, truth.weights.y), truth.weights.z) < 1e-3 ||
            truth.slant < 0.25 || std::abs(truth.shading_slant) < 1e-3)
            continue;
        ++worst.checked;
        worst.behind += !truth.front;
        worst.given_way += truth.shading_slant < 0.0;
        const auto off = [&](int plane, const glm::dvec3& wanted) {
            const glm::dvec3 apart = glm::abs(glm::dvec3(drawing.at(plane, p)) - wanted);
            return glm::max(glm::max(apart.x, apart.y), apart.z);
        };
        const auto most = [](double& of, double value) { of = std::max(of, value); };
        most(worst.position, off(GBUFFER_POSITION, truth.position));
        most(worst.position, std::abs(drawing.depth(p) - truth.depth));
        most(worst.geometric, off(GBUFFER_GEOMETRIC, truth.geometric));
        most(worst.normal, off(GBUFFER_NORMAL, truth.normal));
        if (truth.near_border) continue;
        most(worst.albedo, off(GBUFFER_BASE, truth.albedo));
        const double brightest = placed.frame().exposure / 50.0;  // emission goes up to 50 cd/m^2
        most(worst.emission, off(GBUFFER_EMISSION, truth.emission) * brightest);
        worst.shining += truth.emission != glm::dvec3(0.0);
    }
}

class Surface : public testing::TestWithParam<Looking> {};

TEST_P(Surface, HasEveryAttributeOfTheTriangleThatIsSeen) {
    const Scene scene = patchwork(90, 61);
    const DeviceScene placed = test::on_device(scene);
    const Drawing drawing = test::draw(placed, looking(GetParam(), placed, 211, 157));
    Worst worst;
    compare(scene, placed, drawing, worst);
    EXPECT_GT(worst.checked, 5000u);
    EXPECT_GT(worst.behind, 300u);
    EXPECT_GT(worst.shining, 1000u);
    EXPECT_GT(worst.given_way, 100u);
    // Roundings of a scene of size 1 (found: 5e-7), grown by slender triangles in normals (8e-7,
    // 7e-6); textures change by all of a texel in a twentieth of a triangle and pass that on
    // (4e-5). Three times what was found.
    EXPECT_LT(worst.position, 2e-6);
    EXPECT_LT(worst.geometric, 3e-6);
    EXPECT_LT(worst.normal, 2e-5);
    EXPECT_LT(worst.albedo, 1.2e-4);
    EXPECT_LT(worst.emission, 1.2e-4);
}

INSTANTIATE_TEST_SUITE_P(Views, Surface,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

TEST(Surface, IsTheSameForEveryPacketWidth) {
    const Scene scene = patchwork(90, 62);
    const DeviceScene placed = test::on_device(scene);
    const View view = looking(Looking::perspective, placed, 101, 77);
    test::draw_at_every_width(placed, view,
                              [](const Drawing& other, const Drawing& first, int width) {
                                  EXPECT_TRUE(other.visibility == first.visibility) << width;
                                  EXPECT_TRUE(other.planes == first.planes) << width;
                              });
}

TEST(Surface, NeverLiesOutsideItsTriangle) {
    // Small triangles: corners rounded to 1/256 pixel put many centres just outside them.
    const Scene scene = [] {
        Scene small = patchwork(1, 63, false);
        Random random(64);
        for (int t = 0; t < 16000; ++t) {
            const glm::dvec3 at(random_vec3(random, -0.8, 0.8));
            glm::dvec3 corner[3];
            for (glm::dvec3& c : corner) c = at + glm::dvec3(random_vec3(random, -0.02, 0.02));
            test::add_triangle(small, corner[0], corner[1], corner[2], 0);
        }
        small.colors.clear();
        return small;
    }();
    const DeviceScene placed = test::on_device(scene);
    const Drawing drawing = test::draw(placed, looking(Looking::perspective, placed, 301, 203));
    double outside = 0.0;
    std::size_t cut_off = 0;
    const test::SurfaceReference reference(scene, placed);
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const int triangle = drawing.triangle(p);
        if (triangle < 0) continue;
        const SceneTriangle& t = scene.triangles[triangle];
        glm::dvec3 corner[3];
        for (int k = 0; k < 3; ++k)
            corner[k] = glm::dvec3(placed.frame().to_local(scene.positions[t.vertex[k]]));
        const glm::dvec3 normal = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 edge = corner[(k + 1) % 3] - corner[k];
            const glm::dvec3 inward = glm::normalize(glm::cross(normal, edge));
            outside = std::max(
                outside,
                -glm::dot(glm::dvec3(drawing.at(GBUFFER_POSITION, p)) - corner[k], inward));
        }
        const SurfaceTruth truth =
            reference.at(drawing.view, triangle, static_cast<double>(p % 301) + 0.5,
                         static_cast<double>(p / 301) + 0.5);
        cut_off += glm::min(glm::min(truth.weights.x, truth.weights.y), truth.weights.z) < -1e-4;
    }
    EXPECT_GT(cut_off, 20u);
    EXPECT_LT(outside, 4 * 0x1p-24);  // roundings of positions up to 1
}

// Alpha is factor, vertex alpha and texture alpha, wherever the mask is looked at from.
TEST_P(Surface, IsCutOutWhereItsAlphaIsBelowTheCutoff) {
    Random random(65);
    Scene scene = test::plain_scene();
    Texture texture;
    texture.width = 9;
    texture.height = 7;
    texture.wrap_t = Wrap::mirrored_repeat;
    for (int i = 0; i < 4 * 9 * 7; ++i)
        texture.rgba.push_back(static_cast<std::uint8_t>(random.integer(0, 255)));
    scene.textures = {texture};
    Material& material = scene.materials[0];
    material.base_color.w = 0.9f;
    material.alpha_mode = AlphaMode::mask;
    material.alpha_cutoff = 0.35f;
    material.double_sided = true;
    material.base_texture.texture = 0;
    material.base_texture.uv_set = 1;
    test::add_quad(
        scene,
        {glm::dvec3(-0.9, -0.6, 0.2), {0.8, -0.7, -0.3}, {0.9, 0.6, 0.3}, {-0.8, 0.7, -0.1}});
    for (int v = 0; v < 4; ++v) {
        scene.colors.emplace_back(0.5f, 0.6f, 0.7f, random(0.6, 1.0));
        scene.uvs.emplace_back(random(0, 1), random(0, 1), random(-1, 2), random(-1, 2));
    }
    const DeviceScene placed = test::on_device(scene);
    const View view = looking(GetParam(), placed, 175, 131);
    const Drawing drawing = test::draw(placed, view);
    Scene solid = scene;
    solid.materials[0].alpha_mode = AlphaMode::opaque;
    const Drawing covered = test::draw(test::on_device(solid), view);
    const test::SurfaceReference reference(scene, placed);
    std::size_t seen = 0, holes = 0, wrong = 0;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        if (covered.triangle(p) < 0) {
            EXPECT_EQ(drawing.triangle(p), -1);
            continue;
        }
        const SurfaceTruth truth =
            reference.at(view, covered.triangle(p), static_cast<double>(p % 175) + 0.5,
                         static_cast<double>(p / 175) + 0.5);
        if (std::abs(truth.alpha - 0.35) < 1e-3) continue;
        const bool there = truth.alpha > 0.35;
        (there ? seen : holes) += 1;
        wrong += there != (drawing.triangle(p) >= 0);
    }
    EXPECT_GT(seen, 1000u);
    EXPECT_GT(holes, 1000u);
    EXPECT_EQ(wrong, 0u);
}

}  // namespace
}  // namespace clgi
