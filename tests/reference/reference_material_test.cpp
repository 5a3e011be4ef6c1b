// The path tracer's materials and cameras against the library's, which are written apart from it.
// SPDX-License-Identifier: MIT
#include "reference/material.hpp"

#include <gtest/gtest.h>

#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>

#include "drawing.hpp"
#include "frames.hpp"
#include "scenes.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

// Random textures, UV transforms, wrap modes and vertex colours: what the library's G-buffer holds
// is what the path tracer reads at the same point, normals and finish with it.
TEST(ReferenceMaterial, ReadsTheColourThatTheGBufferHolds) {
    test::Random random(5);
    for (int round = 0; round < 24; ++round) {
        const int size = 48;
        Scene scene = test::plain_scene(glm::vec3(0.9f, 0.8f, 0.7f));
        test::add_quad(scene, {glm::dvec3(0, 0, 0), {size, 0, 0}, {size, size, 0}, {0, size, 0}});
        Texture texture;
        texture.width = 1 + round % 5;
        texture.height = 1 + round % 3;
        texture.nearest = round % 4 == 3;
        texture.wrap_s = static_cast<Wrap>(round % 3);
        texture.wrap_t = static_cast<Wrap>((round / 3) % 3);
        for (int i = 0; i < 4 * texture.width * texture.height; ++i)
            texture.rgba.push_back(static_cast<std::uint8_t>(random(0, 255.99)));
        scene.textures.push_back(texture);
        Material& material = scene.materials[0];
        material.metallic = static_cast<float>(random(0, 1));
        material.roughness = static_cast<float>(random(0, 1));
        material.specular = static_cast<float>(random(0, 1));
        material.ior = static_cast<float>(random(1, 3));
        material.base_texture.texture = 0;
        material.base_texture.uv_set = round % 2;
        material.base_texture.transform = glm::mat3(random(-1, 1), random(-1, 1), 0, random(-1, 1),
                                                    random(-1, 1), 0, random(-2, 2), 0.3, 1);
        Texture linear = texture;
        linear.srgb = false;
        for (std::size_t i = 0; i < linear.rgba.size(); ++i)
            linear.rgba[i] = static_cast<std::uint8_t>(random(i % 4 == 2 ? 160 : 40, 215));
        scene.textures.push_back(linear);
        material.normal_texture = material.metallic_roughness_texture = material.base_texture;
        material.normal_texture.texture = material.metallic_roughness_texture.texture = 1;
        material.normal_texture.uv_set = 1 - round % 2;
        material.normal_scale = static_cast<float>(random(-1, 1));
        material.metallic_roughness_factor = {static_cast<float>(random(0, 1)),
                                              static_cast<float>(random(0.3, 1))};
        for (int k = 0; k < 4; ++k) {
            scene.uvs.emplace_back(random(-1, 2), random(-1, 2), random(-1, 2), random(-1, 2));
            scene.colors.emplace_back(random(0, 1), random(0, 1), random(0, 1), 1);
        }
        const test::Drawing drawing = test::draw(scene, test::pixel_camera(size, size), size, size);
        const reference::Geometry geometry(scene);
        for (int y = 0; y < size; ++y)
            for (int x = 0; x < size; ++x) {
                // Pixel centres; the quad's halves meet where x = y from the bottom.
                const float u = (static_cast<float>(x) + 0.5f) / size;
                const float v = (static_cast<float>(size - y) - 0.5f) / size;
                if (std::abs(u - v) < 0.5f / size) continue;
                const reference::Hit hit =
                    u > v ? reference::Hit{0, u - v, v} : reference::Hit{1, u, v - u};
                const reference::Surface surface =
                    reference::surface_at(geometry, hit, glm::vec3(0, 0, -1));
                const int code =
                    drawing.ids[GBUFFER_METALLIC_ROUGHNESS * drawing.stride + size * y + x];
                const glm::vec2 finish =
                    glm::vec2(code >> METALLIC_ROUGHNESS_BITS, code & METALLIC_ROUGHNESS_STEPS) /
                    float{METALLIC_ROUGHNESS_STEPS};
                Material here = material;
                here.metallic = finish.x;
                here.roughness = finish.y;
                const Reflectance shares = reflectance(here);
                const glm::vec4 wanted = surface_of(here);
                const glm::vec3 base = drawing.at(GBUFFER_BASE, size * y + x);
                const glm::dvec3 normal = test::detail_normal(
                    drawing.ids[GBUFFER_MAPPED_NORMAL * drawing.stride + size * y + x]);
                int differ = glm::length(normal - glm::dvec3(surface.normal)) > 5e-4;
                for (int c = 0; c < 3; ++c) {
                    differ += std::abs(surface.albedo[c] - base[c] * shares.diffuse) > 1e-4f;
                    differ += std::abs(surface.base[c] - base[c]) > 1e-4f;
                }
                differ += glm::length(
                              glm::dvec4(surface.metallic, surface.alpha, surface.f0, surface.f90) -
                              glm::dvec4(wanted)) > 1e-4;
                // The nearest texel changes from one pixel to the next: there float rounding
                // decides.
                if (differ && texture.nearest) continue;
                EXPECT_EQ(differ, 0) << round << ": " << x << ", " << y;
            }
    }
}

TEST(ReferenceCamera, SeesTheSurfacesThatTheRasteriserDraws) {
    const Scene scene = cornell();
    reference::Options options;
    options.width = 80;
    options.height = 60;
    options.samples = 1;
    options.effects = reference::parse_effects("emission,direct");
    Scene glowing = scene;  // every surface shows its own colour
    glowing.lights.clear();
    for (Material& material : glowing.materials) {
        material.emission = glm::vec3(material.base_color) + 0.01f;
        material.base_color = glm::vec4(0, 0, 0, 1);
    }
    for (const auto kind : {Camera::Kind::perspective, Camera::Kind::orthographic}) {
        Camera camera = scene.cameras[0];
        camera.kind = kind;
        camera.half_height = 0.35f;
        const reference::Picture picture = reference::PathTracer(glowing).render(camera, options);
        const test::Drawing drawing = test::draw(glowing, camera, 80, 60);
        const double exposure = test::on_device(glowing).frame().exposure;
        int differ = 0;
        for (int p = 0; p < 80 * 60; ++p) {
            const glm::vec3 emission =
                drawing.at(GBUFFER_EMISSION, p) * static_cast<float>(exposure);
            differ += glm::length(emission - picture.radiance[p]) > 1e-4f;
        }
        EXPECT_LE(differ, 24) << "only pixels whose centre lies on an edge within 1/256 pixel";
    }
}

// In an empty convex room nothing is hidden: both kinds of one bounce are the same, and what many
// VPLs converge to.
TEST(ReferenceTransport, IsWhatTheSecondOrderSolverConvergesTo) {
    Scene room = test::plain_scene();
    test::add_box(room, {-1, -1, -1.5}, {1, 1, 1.5}, -1);
    room.lights = {test::spot_light({0.2, 0.9, 0.3}, {0.1, -1, 0.2}, 0.6, 5.0f)};
    const Camera camera = test::camera_at({0, 0.2, 1.3}, {0.1, 0.4, -1}, 1.0f);
    reference::Options options;
    options.width = 32;
    options.height = 24;
    options.samples = 1600;
    const auto mean = [](const std::vector<glm::vec3>& radiance) {
        double sum = 0.0;
        for (const glm::vec3& value : radiance) sum += double{value.x};
        return sum / static_cast<double>(radiance.size());
    };
    const reference::PathTracer tracer(room);
    options.effects = reference::parse_effects("one-bounce");
    const reference::Picture shadowed = tracer.render(camera, options);
    options.effects = reference::parse_effects("unshadowed-indirect");
    const reference::Picture unshadowed = tracer.render(camera, options);
    const double error = shadowed.relative_error / std::sqrt(32.0 * 24.0);
    EXPECT_LT(error, 3e-3);
    EXPECT_NEAR(mean(unshadowed.radiance) / mean(shadowed.radiance), 1.0, 6 * error);

    SecondOrderOptions solver_options;
    solver_options.width = options.width;
    solver_options.height = options.height;
    solver_options.emitters.vpls = 20000;
    solver_options.negative_vpls = 0;
    solver_options.low_resolution_step = 1;
    solver_options.direct = false;
    solver_options.emitters.shadow_size = 1024;
    const test::Frame frame = test::render(room, camera, solver_options);
    EXPECT_NEAR(mean(frame.radiance) / mean(shadowed.radiance), 1.0, 0.003 + 3 * error);
}

}  // namespace
}  // namespace clgi
