// What hemicubes see of textures of normals, metalness and roughness, against a sum over a floor.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "cache_pictures.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr int across =
    256;  // texels of the floor; texels of one kind lie beside those of the other
constexpr double half_floor = 1.5, half_patch = 0.05, lux = 1000.0;
const glm::vec3 base(0.9f, 0.6f, 0.3f);
const glm::dvec3 place(-0.5, 1.0, 0.1);  // of the patch, which looks down

std::uint8_t byte_of(double share) { return static_cast<std::uint8_t>(std::lround(255.0 * share)); }

// Two kinds of texels in turn.
Texture in_turn(const glm::dvec3& one, const glm::dvec3& other) {
    Texture out;
    out.width = out.height = across;
    out.srgb = false;
    out.nearest = true;
    for (int y = 0; y < across; ++y)
        for (int x = 0; x < across; ++x) {
            const glm::dvec3& value = (x + y) % 2 == 0 ? one : other;
            for (int c = 0; c < 3; ++c) out.rgba.push_back(byte_of(value[c]));
            out.rgba.push_back(255);
        }
    return out;
}

// The floor's kinds of texels: tilted to one side and to the other, as smooth metal and as cloth.
struct Kind {
    glm::dvec3 normal;
    Material finish;
};

struct Floor {
    bool tilted, finished, lobes;
};

class DetailLight : public testing::TestWithParam<Floor> {};

TEST_P(DetailLight, IsThatOfTexelsAndNotOfTheirMean) {
    const Floor of = GetParam();
    const glm::dvec3 sun = glm::normalize(glm::dvec3(0.6, 0.5, 0.2));
    const float specular = of.lobes ? 1.0f : 0.0f;
    Kind kinds[2] = {{{0, 1, 0}, test::finished(0.0f, 0.6f, specular)},
                     {{0, 1, 0}, test::finished(0.0f, 0.6f, specular)}};
    Scene scene = test::plain_scene({0.8f, 0.8f, 0.8f});
    Material material = kinds[0].finish;
    material.base_color = glm::vec4(base, 1.0f);
    if (of.tilted) {
        // Rounded as the texture rounds them; u runs along x and v against -z.
        const Texture texture = in_turn({0.65, 0.5, 0.95}, {0.35, 0.5, 0.95});
        for (std::size_t k = 0; k < 2; ++k) {
            const auto read = [&](std::size_t c) { return texture.rgba[4 * k + c] / 127.5 - 1.0; };
            kinds[k].normal = glm::normalize(glm::dvec3(read(0), read(2), -read(1)));
        }
        scene.textures.push_back(texture);
        material.normal_texture.texture = 0;
    }
    if (of.finished) {
        material.metallic_roughness_texture.texture = static_cast<int>(scene.textures.size());
        scene.textures.push_back(in_turn({0.0, 0.4, 1.0}, {0.0, 0.8, 0.0}));
        material.metallic_roughness_factor = {1.0f, 1.0f};
        material.metallic = 0.5f;  // the means
        material.roughness = 0.6f;
        kinds[0].finish = test::finished(1.0f, 0.4f, specular);
        kinds[1].finish = test::finished(0.0f, 0.8f, specular);
    }
    test::add_floor(scene, half_floor, 0.0, test::add_material(scene, material));
    for (const glm::dvec3& at : scene.positions)
        scene.uvs.emplace_back(at.x / (2 * half_floor), at.z / (2 * half_floor), 0.0f, 0.0f);
    const glm::dvec3 x(half_patch, 0, 0), z(0, 0, half_patch);
    test::add_quad(scene, {place - x - z, place + x - z, place + x + z, place - x + z});
    scene.uvs.resize(scene.positions.size(), glm::vec4(0.0f));
    Light light;
    light.kind = Light::Kind::directional;
    light.direction = glm::vec3(-sun);
    light.intensity = glm::vec3(float{lux});
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
            for (const Kind& kind : kinds) {
                const test::GltfReflected f = test::gltf_reflected(
                    kind.finish, glm::dvec3(base), kind.normal, to / std::sqrt(square), sun);
                sum +=
                    0.5 * (f.diffuse + f.gloss) *
                    (lux * glm::dot(kind.normal, sun) * cosine * cosine * width * width / square);
            }
        }
    const glm::dvec3 wanted = 0.8 / std::numbers::pi * sum;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted[c], 0.03 * wanted[c]) << c;
}

INSTANTIATE_TEST_SUITE_P(Floors, DetailLight,
                         testing::Values(Floor{true, false, false}, Floor{true, false, true},
                                         Floor{false, true, true}, Floor{true, true, true}),
                         [](const auto& row) {
                             const Floor& of = row.param;
                             return std::string(of.tilted ? "Tilted" : "Flat") +
                                    (of.finished ? "OfTwoFinishes" : "") +
                                    (of.lobes ? "Glossy" : "Matte");
                         });

}  // namespace
}  // namespace clgi
