// Records whose normals are not those of the surface that they stand on: rays beneath it bring
// nothing.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>

#include "cache_pictures.hpp"
#include "math_modes.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr double turned = 0.8;  // radians
const glm::vec3 sky_radiance(1.0f, 2.0f, 4.0f);

// A floor of which a camera sees a part, with smooth normals that all lean to one side.
Scene leaning_floor(const Material& material) {
    Scene scene = test::plain_scene();
    scene.materials[0] = material;
    test::add_floor(scene, 3.0);
    scene.normals.assign(scene.positions.size(),
                         glm::vec3(std::sin(turned), std::cos(turned), 0.0));
    scene.cameras = {test::camera_at({0.0, 0.8, 0.1}, {0, 0, 0}, 0.6f)};
    return scene;
}

Material matt(const glm::vec3& albedo) {
    Material out;
    out.base_color = glm::vec4(albedo, 1.0f);
    return out;
}

CLGI_IN_BOTH_MATHS(TurnedNormals);

// E = pi L (1 + cos t) / 2 of an even sky, which the floor hides where it is below it. A black
// ceiling that glows as the sky does changes nothing.
TEST_P(TurnedNormals, HaveTheSkyAboveTheirSurface) {
    Scene scene = leaning_floor(matt({0.9f, 0.6f, 0.3f}));
    scene.environment = Environment{};
    scene.environment->width = 2;
    scene.environment->height = 1;
    scene.environment->texels = {sky_radiance, sky_radiance};
    Material glow = matt(glm::vec3(0.0f));
    glow.emission = sky_radiance;
    test::add_quad(scene, {glm::dvec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}},
                   test::add_material(scene, glow));
    for (const Form form : {Form::packets, Form::groups})
        for (const int face : {24, 32}) {  // surfaces in some pixels, and in all
            IrradianceCacheOptions options = cache_options();
            options.picture.build.form = form;
            options.emission = true;
            options.face = face;
            const CachePicture found = pictured(scene, options);
            for (int c = 0; c < 3; ++c) {
                const double wanted = scene.materials[0].base_color[c] * sky_radiance[c] *
                                      (1.0 + std::cos(turned)) / 2.0;
                EXPECT_NEAR(mean_radiance(found.radiance)[c], wanted, 0.02 * wanted)
                    << face << " " << c;
            }
        }
}

// A floor that the sun lights sends nothing to itself, diffuse or by lobes.
TEST_P(TurnedNormals, DoNotMeetTheirOwnSurface) {
    Material metal = test::finished(1.0f, 0.6f, 1.0f);
    metal.base_color = glm::vec4(0.9f, 0.6f, 0.3f, 1.0f);
    for (const Material& material : {matt({0.9f, 0.6f, 0.3f}), metal}) {
        Scene scene = leaning_floor(material);
        scene.lights = {test::directional_light(glm::normalize(glm::vec3(0.2f, -1.0f, 0.1f)))};
        scene.lights[0].intensity = {1000.0f, 2000.0f, 4000.0f};
        IrradianceCacheOptions options = cache_options();
        options.picture.direct = false;
        for (const glm::vec3& value : pictured(scene, options).radiance)
            ASSERT_EQ(value, glm::vec3(0.0f));
        options.picture.direct = true;
        EXPECT_GT(mean_radiance(pictured(scene, options).radiance).x, 1.0);
    }
}

}  // namespace
}  // namespace clgi
