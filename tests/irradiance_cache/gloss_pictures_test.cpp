// Pictures of glossy surfaces by an irradiance cache, against sums over all directions.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/irradiance_cache.hpp>
#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "cache_pictures.hpp"
#include "glossy_records.hpp"
#include "microfacet.hpp"
#include "scene/environment.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

// A tilted metal floor below a sky that is brighter upwards, seen from far away at a slant.
struct MetalBelowASky {
    explicit MetalBelowASky(float roughness = 0.6f) {
        scene = test::plain_scene();
        scene.materials[0] = test::finished(1.0f, roughness, 1.0f);
        scene.materials[0].base_color = glm::vec4(base, 1.0f);
        const glm::dvec3 across = glm::normalize(glm::cross(normal, glm::dvec3(0, 0, 1))),
                         deep = glm::cross(across, normal);
        test::add_quad(scene, {2.0 * (across - deep), 2.0 * (-across - deep), 2.0 * (deep - across),
                               2.0 * (across + deep)});
        scene.environment = test::gradient_sky(16, 64);
        scene.environment->factor = {1.0f, 2.0f, 4.0f};
        scene.cameras = {test::camera_at(30.0 * viewer, {0, 0, 0}, 0.005f)};
    }

    // Of all pixels. Irradiance of the sky's gradient is pi / 2 + pi / 3 n.y.
    glm::dvec3 wanted() const {
        const LobeLight lobes =
            lobe_light(scene.materials[0], normal, viewer,
                       [](const glm::dvec3& d) { return glm::dvec3((1.0 + d.y) / 2.0); });
        const double diffuse = double{reflectance(scene.materials[0]).diffuse};
        return glm::dvec3(scene.environment->factor) *
               (lobes.white + glm::dvec3(base) * (lobes.tint + diffuse * (0.5 + normal.y / 3.0)));
    }

    const glm::vec3 base{0.9f, 0.6f, 0.3f};
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.5, 0.8, 0.2)),
                     viewer = glm::normalize(glm::dvec3(-0.7, 0.5, 0.4));
    Scene scene;
};

// Samples after the first draw other directions, so their mean comes nearer: rough lobes by what
// records have around them, smooth ones by rays.
class SkyInLobes : public testing::TestWithParam<float> {};

TEST_P(SkyInLobes, IsThatOfAllDirections) {
    const MetalBelowASky metal(GetParam());
    IrradianceCacheOptions options = cache_options();
    options.sky_lights = 0;
    const DeviceScene device = test::on_device(metal.scene);
    IrradianceCache cache(test::programs(), test::device().queue, device, options);
    const Camera& camera = metal.scene.cameras[0];
    constexpr std::size_t pixels = std::size_t{cache_width} * cache_height;
    const auto shown = [&] {
        return test::vectors(test::device().queue, cache.picture().radiance(),
                             cache.picture().stride(), pixels);
    };
    const glm::dvec3 wanted = metal.wanted();
    const auto apart = [&](const std::vector<glm::dvec3>& picture) {
        double sum = 0.0;
        for (const glm::dvec3& value : picture) sum += std::pow(value.y - wanted.y, 2);
        return std::sqrt(sum / pixels) / wanted.y;
    };
    cache.render(camera).wait();
    std::vector<glm::vec3> picture = shown(), before;
    std::vector<glm::dvec3> mean(picture.begin(), picture.end());
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean_radiance(picture)[c], wanted[c], 0.01 * wanted[c]) << c;
    const double first = apart(mean);
    constexpr std::uint32_t samples = 96;
    for (std::uint32_t sample = 1; sample < samples; ++sample) {
        cache.sample(sample);
        cache.render_again(camera).wait();
        before = std::exchange(picture, shown());
        EXPECT_NE(picture, before) << sample;
        for (std::size_t p = 0; p < pixels; ++p) mean[p] += glm::dvec3(picture[p]);
    }
    for (glm::dvec3& value : mean) value /= double{samples};
    EXPECT_LT(apart(mean), 0.5 * first);
    EXPECT_LT(apart(mean), 0.03);
    EXPECT_EQ(cache.status().non_finite, 0u);
}

INSTANTIATE_TEST_SUITE_P(Roughness, SkyInLobes, testing::Values(0.6f, 0.45f, 0.3f));

// Lobes reflect the soft part of a sky as records see it, and its small bright parts as lamps, as
// in the path tracer's picture.
TEST(GlossPictures, ReflectASkyInParts) {
    MetalBelowASky metal;
    const glm::dvec3 mirrored = glm::reflect(-metal.viewer, metal.normal);
    metal.scene.environment = test::picture_sky(64, 32, [](int, int) { return 0.5f; });
    Environment& sky = *metal.scene.environment;
    sky.factor = {1.0f, 2.0f, 4.0f};
    reference::Options of;
    of.width = cache_width;
    of.height = cache_height;
    of.samples = 64;
    for (const bool many : {false, true}) {
        for (int row = 0; row < 32; ++row)
            for (int column = 0; column < 64; ++column) {
                const glm::dvec3 d =
                    environment_direction(sky, (column + 0.5) / 64, (row + 0.5) / 32);
                if (glm::dot(d, mirrored) > std::cos(0.07) || (many && row == 2 && column % 9 == 0))
                    sky.texels[static_cast<std::size_t>(64 * row + column)] = glm::vec3(150.0f);
            }
        const DeviceScene device = test::on_device(metal.scene);
        ASSERT_GT(device.bright_sky().share, 0.1);
        IrradianceCache cache(test::programs(), test::device().queue, device, cache_options());
        glm::dvec3 mean(0.0);
        constexpr std::uint32_t samples = 320;
        for (std::uint32_t sample = 0; sample < samples; ++sample) {
            cache.sample(sample);
            const Camera& camera = metal.scene.cameras[0];
            (sample == 0 ? cache.render(camera) : cache.render_again(camera)).wait();
            mean += mean_radiance(test::vectors(test::device().queue, cache.picture().radiance(),
                                                cache.picture().stride(),
                                                std::size_t{cache_width} * cache_height)) /
                    double{samples};
        }
        const glm::dvec3 wanted = mean_radiance(
            reference::PathTracer(metal.scene).render(metal.scene.cameras[0], of).radiance);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean[c], wanted[c], 0.03 * wanted[c]) << many << " " << c;
    }
}

// A camera of parallel rays sees the same as one that is far away.
TEST(GlossPictures, AreTheSameByParallelRays) {
    MetalBelowASky metal;
    Camera& camera = metal.scene.cameras[0];
    camera.kind = Camera::Kind::orthographic;
    camera.half_height = 0.08f;
    const CachePicture found = pictured(metal.scene, cache_options());
    const glm::dvec3 wanted = metal.wanted();
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted[c], 0.01 * wanted[c]) << c;
}

// In a sphere that is lit from its middle, where the eye is too: light leaves a wall by the lobe
// about its normal, meets another at the angle t at which it left, and is reflected to the eye
// along the normal. In all later reflections lobes count with their mean albedo p
// (docs/materials.md).
//
//   L = rho E / pi + 2 pi int g(t) L_in(t) cos t sin t dt,   L_in = I f(t) + p E / pi,   E = I p_1
//   / (1 - p)
TEST(GlossPictures, HaveAllReflectionsOfASphere) {
    Scene scene = furnace({.light = LightSource::point, .subdivisions = 3});
    const glm::dvec3 base(0.6, 0.3, 0.75);
    Material& wall = scene.materials[0];
    wall = test::finished(0.5f, 0.4f, 1.0f);
    wall.base_color = glm::vec4(glm::vec3(base), 1.0f);
    scene.lights[0].intensity = {1.0f, 2.0f, 5.0f};
    scene.cameras = {test::camera_at({0, 0, 0}, {0.3, 0.2, -1}, 1.2f)};
    IrradianceCacheOptions options = cache_options();
    options.picture.direct = false;
    const CachePicture found = pictured(scene, options);

    const double pi = std::numbers::pi, square = std::pow(0.16, 2);
    const glm::dvec3 normal(0, 0, 1);
    const auto reflected = [&](double t, const glm::dvec3& colour) {
        return test::gltf_reflected(wall, colour, normal, normal, {std::sin(t), 0.0, std::cos(t)});
    };
    const Reflectance means = reflectance(wall);
    const glm::dvec3 p = base * double{means.diffuse + means.lobe} + double{means.coat};
    constexpr int steps = 2000;
    const auto integral = [&](const auto& of) {
        glm::dvec3 sum(0.0);
        for (int k = 0; k < steps; ++k) {
            const double t = 0.5 * pi * (k + 0.5) / steps;
            sum += of(t) * (2 * pi * std::sin(t) * std::cos(t) * 0.5 * pi / steps);
        }
        return sum;
    };
    const auto first = [&](double t) {
        const test::GltfReflected f = reflected(t, base);
        return f.diffuse + f.gloss;
    };
    const glm::dvec3 arrives = integral(first) / (1.0 - p);  // over the intensity
    const glm::dvec3 lobes = integral([&](double t) {
        const glm::dvec3 white = reflected(t, glm::dvec3(0.0)).gloss;
        return (white + (reflected(t, base).gloss - white) * (1.0 - square)) *
               (first(t) + p * arrives / pi);
    });
    const glm::dvec3 wanted = glm::dvec3(scene.lights[0].intensity) *
                              (base * double{means.diffuse} * arrives / pi + lobes);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted[c], 0.03 * wanted[c]) << c;
}

// A glossy floor in the sun lights a small white patch above it, which looks down: the sum over the
// floor of f E cos cos' / r^2.
TEST(GlossPictures, LightByLobesOfWhatIsLit) {
    const glm::vec3 base(0.9f, 0.6f, 0.3f);
    const glm::dvec3 place(-0.5, 1.0, 0.1);
    constexpr double half_patch = 0.05, half_floor = 1.5, lux = 1000.0;
    // A low sun is reflected most where F is not that of normal incidence.
    for (const auto& [metallic, height] : {std::pair(1.0f, 0.7), {0.0f, 0.7}, {0.0f, 0.25}}) {
        const glm::dvec3 sun = glm::normalize(glm::dvec3(0.6, height, 0.2));
        Scene scene = test::plain_scene({0.8f, 0.8f, 0.8f});
        Material floor = test::finished(metallic, 0.55f, 1.0f);
        floor.base_color = glm::vec4(base, 1.0f);
        test::add_floor(scene, half_floor, 0.0, test::add_material(scene, floor));
        const glm::dvec3 x(half_patch, 0, 0), z(0, 0, half_patch);
        test::add_quad(scene, {place - x - z, place + x - z, place + x + z, place - x + z});
        Light light;
        light.kind = Light::Kind::directional;
        light.direction = glm::vec3(-sun);
        light.intensity = glm::vec3(float(lux));
        scene.lights = {light};
        scene.cameras = {test::camera_at({place.x, 0.3, place.z + 0.001}, place, 0.1f)};
        IrradianceCacheOptions options = cache_options();
        options.bounces = 1;
        options.face = 64;
        const CachePicture found = pictured(scene, options);

        constexpr int steps = 600;
        constexpr double width = 2 * half_floor / steps;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < steps; ++i)
            for (int k = 0; k < steps; ++k) {
                const glm::dvec3 at((i + 0.5) * width - half_floor, 0.0,
                                    (k + 0.5) * width - half_floor);
                const glm::dvec3 shadow = at + sun / sun.y - place;
                if (std::abs(shadow.x) < half_patch && std::abs(shadow.z) < half_patch) continue;
                const glm::dvec3 to = place - at;
                const double square = glm::dot(to, to), cosine = to.y / std::sqrt(square);
                const test::GltfReflected f = test::gltf_reflected(
                    floor, glm::dvec3(base), {0, 1, 0}, to / std::sqrt(square), sun);
                sum += (f.diffuse + f.gloss) *
                       (lux * sun.y * cosine * cosine * width * width / square);
            }
        const glm::dvec3 wanted = 0.8 / std::numbers::pi * sum;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted[c], 0.03 * wanted[c])
                << metallic << " " << height << " " << c;
    }
}

// A mirror shows a wall in the sun and, behind a screen, in its shadow.
TEST(GlossPictures, MirrorWhatIsLit) {
    const glm::vec3 base(0.9f, 0.6f, 0.3f), wall(0.8f, 0.5f, 0.2f), lux(900.0f, 700.0f, 400.0f);
    for (const bool shaded : {false, true}) {
        Scene scene = test::plain_scene(wall);
        Material mirror = test::finished(1.0f, 0.1f, 1.0f);
        mirror.base_color = glm::vec4(base, 1.0f);
        test::add_floor(scene, 2.0, 0.0, test::add_material(scene, mirror));
        test::add_quad(scene, {glm::dvec3(-2, 0, -2), {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}});
        Light light;
        light.kind = Light::Kind::directional;
        light.direction = glm::normalize(glm::vec3(0.3f, 0.0f, -1.0f));
        light.intensity = lux;
        scene.lights = {light};
        const glm::dvec3 middle = glm::dvec3(0, 2, -2) - 3.0 * glm::dvec3(light.direction);
        if (shaded)
            test::add_quad(scene,
                           {middle + glm::dvec3(-0.4, -0.4, 0), middle + glm::dvec3(0.4, -0.4, 0),
                            middle + glm::dvec3(0.4, 0.4, 0), middle + glm::dvec3(-0.4, 0.4, 0)});
        scene.cameras = {test::camera_at({0, 1, 1}, {0, 0, 0}, 0.05f)};
        IrradianceCacheOptions options = cache_options();
        options.bounces = 1;
        const glm::dvec3 found = mean_radiance(pictured(scene, options).radiance);
        const double away = std::pow(1.0 - std::sqrt(0.5), 5);
        const double cosine = -double{light.direction.z};
        for (int c = 0; c < 3; ++c) {
            const double wanted = (away + (1.0 - away) * (1.0 - 1e-4) * base[c]) * wall[c] /
                                  std::numbers::pi * lux[c] * cosine;
            if (shaded)
                EXPECT_LT(found[c], 0.05 * wanted) << c;
            else
                EXPECT_NEAR(found[c], wanted, 0.02 * wanted) << c;
        }
    }
}

// Two mirrors at a right angle below an even sky send it back as it came.
TEST(GlossPictures, MirrorAMirror) {
    const glm::vec3 bases[] = {{0.9f, 0.6f, 0.3f}, {0.4f, 0.7f, 0.8f}}, sky(2.0f, 3.0f, 1.0f);
    Scene scene = test::plain_scene();
    scene.materials.clear();
    for (const glm::vec3& base : bases) {
        scene.materials.push_back(test::finished(1.0f, 0.1f, 1.0f));
        scene.materials.back().base_color = glm::vec4(base, 1.0f);
    }
    test::add_floor(scene, 2.0, 0.0, 0);
    test::add_quad(scene, {glm::dvec3(-2, 0, -2), {2, 0, -2}, {2, 3, -2}, {-2, 3, -2}}, 1);
    scene.environment.emplace().factor = sky;
    scene.cameras = {test::camera_at({0, 1, 1}, {0, 0, 0}, 0.05f)};
    const glm::dvec3 found = mean_radiance(pictured(scene, cache_options()).radiance);
    const double away = std::pow(1.0 - std::sqrt(0.5), 5);
    for (int c = 0; c < 3; ++c) {
        const auto reflects = [&](int k) {
            return away + (1.0 - away) * (1.0 - 1e-4) * bases[k][c];
        };
        const double wanted = reflects(0) * reflects(1) * sky[c];
        EXPECT_NEAR(found[c], wanted, 0.02 * wanted) << c;
    }
}

}  // namespace
}  // namespace clgi
