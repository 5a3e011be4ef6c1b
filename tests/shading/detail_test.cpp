// Textures of normals, metalness and roughness: what a G-buffer keeps of them, and the light of a
// picture and of the path tracer on mapped normals against closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <clgi/renderer.hpp>
#include <numbers>

#include "patchwork.hpp"
#include "shading.hpp"
#include "surface_reference.hpp"

namespace clgi {
namespace {

using test::Drawing;
using test::Looking;
using test::looking;
using test::Random;

// Crooked triangles whose materials have normals, finish, both or neither.
Scene detailed_patchwork(std::uint64_t seed) {
    Scene scene = test::patchwork(90, seed);
    Random random(seed + 1);
    const int first = static_cast<int>(scene.textures.size());
    for (int k = 0; k < 3; ++k) {
        Texture texture;
        texture.width = 5 + 6 * k;
        texture.height = 9 - 2 * k;
        texture.wrap_s = static_cast<Wrap>((k + 1) % 3);
        texture.wrap_t = static_cast<Wrap>(k);
        texture.srgb = false;
        for (int i = 0; i < texture.width * texture.height; ++i)
            for (const int least : {0, 0, 90, 255})
                texture.rgba.push_back(static_cast<std::uint8_t>(random.integer(least, 255)));
        scene.textures.push_back(texture);
    }
    for (std::size_t m = 0; m < scene.materials.size(); ++m) {
        Material& material = scene.materials[m];
        const auto slot = [&] {
            TextureSlot out = test::random_slot(random, 5);
            out.texture = first + random.integer(0, 2);
            if (m % 2) out.transform[1][1] *= -1.0f;  // mirrored
            return out;
        };
        if (m % 4 < 2) material.normal_texture = slot();
        if (m % 4 == 1 || m % 4 == 2) material.metallic_roughness_texture = slot();
        material.normal_scale = static_cast<float>(random(0.3, 1.5)) * (m == 5 ? -1.0f : 1.0f);
        material.metallic_roughness_factor = {static_cast<float>(random(0.4, 1)),
                                              static_cast<float>(random(0.4, 1))};
    }
    return scene;
}

class Detail : public testing::TestWithParam<Looking> {};

TEST_P(Detail, IsThatOfTheTexturesUnderThePixel) {
    const Scene scene = detailed_patchwork(81);
    const DeviceScene placed = test::on_device(scene);
    const Drawing drawing = test::draw(placed, looking(GetParam(), placed, 211, 157));
    const test::SurfaceReference reference(scene, placed);
    double apart = 0.0, finish = 0.0;
    int mapped = 0, plain = 0, finished = 0, bent = 0, mirrored = 0, behind = 0;
    for (std::size_t p = 0; p < drawing.pixels(); ++p) {
        const int normal_code = drawing.ids[GBUFFER_MAPPED_NORMAL * drawing.stride + p];
        const int metallic_roughness_code =
            drawing.ids[GBUFFER_METALLIC_ROUGHNESS * drawing.stride + p];
        const int triangle = drawing.triangle(p);
        if (triangle < 0) {
            EXPECT_EQ(normal_code, -1);
            EXPECT_EQ(metallic_roughness_code, -1);
            continue;
        }
        const double column = static_cast<double>(p % drawing.view.width) + 0.5;
        const double row = static_cast<double>(p / drawing.view.width) + 0.5;
        test::SurfaceTruth seen = reference.at(drawing.view, triangle, column, row);
        if (glm::min(glm::min(seen.weights.x, seen.weights.y), seen.weights.z) < 1e-3 ||
            seen.slant < 0.25 || std::abs(seen.shading_slant) < 1e-3)
            continue;
        const test::DetailTruth truth = reference.detail(drawing.view, triangle, column, row, seen);
        ASSERT_EQ(normal_code != -1, truth.mapped);
        ASSERT_EQ(metallic_roughness_code != -1, truth.finished);
        plain += !truth.mapped;
        if (truth.finished) {
            ++finished;
            const glm::dvec2 found(metallic_roughness_code >> METALLIC_ROUGHNESS_BITS,
                                   metallic_roughness_code & METALLIC_ROUGHNESS_STEPS);
            const glm::dvec2 off =
                glm::abs(found / double{METALLIC_ROUGHNESS_STEPS} - truth.finish);
            finish = std::max(finish, glm::max(off.x, off.y));
        }
        if (!truth.mapped || truth.certain < 0.05) continue;
        ++mapped;
        bent += truth.bent;
        mirrored += truth.mirrored;
        behind += !seen.front;
        const glm::dvec3 found = test::detail_normal(normal_code);
        EXPECT_GT(
            -glm::dot(found, glm::normalize(test::pixel_ray(drawing.view, column, row).direction)),
            0.005);
        apart = std::max(apart, glm::length(found - truth.normal) * truth.certain);
    }
    EXPECT_GT(mapped, 3000);
    EXPECT_GT(plain, 3000);
    EXPECT_GT(finished, 3000);
    EXPECT_GT(bent, 100);
    EXPECT_GT(mirrored, 500);
    EXPECT_LT(mirrored, mapped - 500);
    EXPECT_GT(behind, 300);
    // Textures change by all of a texel in a twentieth of a triangle (surface_test).
    EXPECT_LT(apart, 3e-4);
    EXPECT_LT(finish, 2e-4);
}

INSTANTIATE_TEST_SUITE_P(Views, Detail,
                         testing::Values(Looking::perspective, Looking::orthographic,
                                         Looking::aside, Looking::orthographic_aside),
                         test::looking_name);

TEST(Detail, IsTheSameForEveryPacketWidth) {
    const Scene scene = detailed_patchwork(82);
    const DeviceScene placed = test::on_device(scene);
    const View view = looking(Looking::perspective, placed, 101, 77);
    test::draw_at_every_width(
        placed, view, [](const Drawing& other, const Drawing& first, int width) {
            for (const int plane : {GBUFFER_MAPPED_NORMAL, GBUFFER_METALLIC_ROUGHNESS})
                for (std::size_t p = 0; p < first.pixels(); ++p)
                    ASSERT_EQ(other.ids[plane * other.stride + p],
                              first.ids[plane * first.stride + p])
                        << width << ", pixel " << p;
        });
}

// A tilted square whose normal texture says one normal everywhere, under a sun.
struct MappedSquare {
    Scene scene;
    glm::dvec3 right, up, normal;  // of the picture on the square, which turns with its texture
    glm::vec3 base{0.8f, 0.5f, 0.3f};
    glm::vec3 lux{3.0f, 5.0f, 7.0f};

    // read: of the texture, x, y, z in -1 to 1; mirrored: u runs the other way.
    MappedSquare(const glm::dvec3& read, bool mirrored, bool from_behind, const glm::dvec3& sun)
        : right(glm::normalize(glm::dvec3(0.8, 0.1, -0.5))),
          up(glm::normalize(glm::cross(glm::dvec3(0.3, 0.2, 0.9), right))),
          normal(glm::cross(right, up)) {
        scene.materials.emplace_back().base_color = glm::vec4(base, 1.0f);
        scene.materials[0].double_sided = true;
        scene.materials[0].normal_texture.texture = 0;
        Texture texture;
        texture.width = texture.height = 1;
        texture.srgb = false;
        for (int c = 0; c < 3; ++c)
            texture.rgba.push_back(static_cast<std::uint8_t>(std::lround(127.5 * (read[c] + 1.0))));
        texture.rgba.push_back(255);
        scene.textures.push_back(texture);
        test::add_quad(scene, {-right - up, right - up, right + up, up - right});
        const float left = mirrored ? 1.0f : 0.0f;
        for (const auto& [u, v] :
             {std::pair(left, 1.0f), {1.0f - left, 1.0f}, {1.0f - left, 0.0f}, {left, 0.0f}})
            scene.uvs.emplace_back(u, v, 0.0f, 0.0f);
        Light light;
        light.kind = Light::Kind::directional;
        light.direction = glm::normalize(glm::vec3(-sun));
        light.intensity = lux;
        scene.lights.push_back(light);
        const double side = from_behind ? -1.0 : 1.0;
        scene.cameras.push_back(
            test::camera_at(3.0 * side * normal + 0.4 * right, glm::dvec3(0.0), 0.1f));
    }

    // The texel as it is stored.
    glm::dvec3 read() const {
        const auto& rgba = scene.textures[0].rgba;
        return glm::dvec3(rgba[0], rgba[1], rgba[2]) / 127.5 - 1.0;
    }
};

glm::vec3 middle_pixel(const Scene& scene) {
    RendererOptions options;
    options.method = Method::direct;
    options.picture.width = options.picture.height = 3;
    options.picture.build = test::usual_build();
    DeviceScene placed = test::on_device(scene);
    Renderer renderer(test::programs(), test::device().queue, scene, placed, options);
    renderer.render(scene.cameras[0]);
    const auto planes = renderer.read_radiance();
    return {planes[0][4], planes[1][4], planes[2][4]};
}

TEST(Detail, TurnsTheSurfaceTowardsTheLight) {
    // Up to 80 degrees from the surface's own normal.
    for (const glm::dvec3& tilted :
         {glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.5, 0.0, 0.866), glm::dvec3(-0.3, 0.6, 0.742),
          glm::dvec3(0.2, -0.7, 0.686), glm::dvec3(0.985, 0.0, 0.174)})
        for (const bool mirrored : {false, true})
            for (const bool behind : {false, true}) {
                const glm::dvec3 aside = glm::dvec3(0.6, 0.1, -0.2);
                const MappedSquare plain(tilted, mirrored, behind, glm::dvec3(1.0));
                const glm::dvec3 sun = glm::normalize((behind ? -1.0 : 1.0) * plain.normal + aside);
                const MappedSquare square(tilted, mirrored, behind, sun);
                const glm::dvec3 read = square.read();
                const glm::dvec3 n =
                    glm::normalize((mirrored ? -1.0 : 1.0) * read.x * square.right +
                                   read.y * square.up + read.z * square.normal) *
                    (behind ? -1.0 : 1.0);
                const double cosine = std::max(glm::dot(n, sun), 0.0);
                const std::string what = std::to_string(tilted.x) + (mirrored ? " mirrored" : "") +
                                         (behind ? " behind" : "");
                const glm::vec3 drawn = middle_pixel(square.scene);
                reference::Options options;
                options.effects = reference::parse_effects("direct");
                options.width = options.height = 3;
                options.samples = 4;
                const glm::vec3 traced = reference::PathTracer(square.scene)
                                             .render(square.scene.cameras[0], options)
                                             .radiance[4];
                for (int c = 0; c < 3; ++c) {
                    const double wanted =
                        double{square.base[c]} / std::numbers::pi * double{square.lux[c]} * cosine;
                    EXPECT_NEAR(drawn[c], wanted, 2e-4 * double{square.lux[c]}) << what;
                    EXPECT_NEAR(traced[c], wanted, 2e-5 * double{square.lux[c]}) << what;
                }
            }
}

// A normal that leans over lights nothing from below the surface.
TEST(Detail, IsDarkWhereTheLightIsBehindTheSurface) {
    const MappedSquare plain({0.985, 0.0, 0.174}, false, false, glm::dvec3(1.0));
    const MappedSquare square({0.985, 0.0, 0.174}, false, false, plain.right - 0.05 * plain.normal);
    EXPECT_EQ(middle_pixel(square.scene), glm::vec3(0.0f));
    reference::Options options;
    options.effects = reference::parse_effects("direct");
    options.width = options.height = 3;
    options.samples = 4;
    EXPECT_EQ(
        reference::PathTracer(square.scene).render(square.scene.cameras[0], options).radiance[4],
        glm::vec3(0.0f));
}

}  // namespace
}  // namespace clgi
