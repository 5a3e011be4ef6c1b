// Whole frames of a crooked, coloured scene against the path tracer, by kind of source and channel.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>

#include "frames.hpp"
#include "oblique.hpp"

namespace clgi {
namespace {

enum Source { spot, point, sun, wide_spot, lamp };

constexpr int oblique_width = 96, oblique_height = 72;

Scene scene_with(int source) {
    Scene scene = test::oblique_room();
    const Light lights[] = {test::oblique_spot(), test::oblique_point(), test::oblique_sun(),
                            test::oblique_wide_spot()};
    if (source == lamp)
        test::add_oblique_lamp(scene);
    else
        scene.lights = {lights[source]};
    return scene;
}

SecondOrderOptions solver_options() {
    SecondOrderOptions options;
    options.width = oblique_width;
    options.height = oblique_height;
    options.negative_vpls = 0;
    options.low_resolution_step = 1;
    options.emitters.shadow_size = 1024;
    return options;
}

reference::Picture truth_of(const Scene& scene, const reference::Effects& effects, int samples) {
    reference::Options options;
    options.width = oblique_width;
    options.height = oblique_height;
    options.effects = effects;
    options.samples = samples;
    return reference::PathTracer(scene).render(test::oblique_camera(), options);
}

glm::dvec3 mean_of_texels(const std::vector<glm::vec3>& radiance) {
    glm::dvec3 sum(0);
    for (const glm::vec3& value : radiance) sum += glm::dvec3(value);
    return sum / static_cast<double>(radiance.size());
}

class Oblique : public testing::TestWithParam<int> {};

// Lamps without extent leave no noise: a pixel is right or a shadow's border crosses it.
TEST_P(Oblique, DirectLightIsThePathTracersInEveryChannel) {
    const Scene scene = scene_with(GetParam());
    const bool area = GetParam() == lamp;
    SecondOrderOptions options = solver_options();
    options.indirect = false;
    options.emitters.area_samples = 128;
    options.emitters.face_size = area ? 64 : 512;
    const test::Frame frame = test::render(scene, test::oblique_camera(), options);
    reference::Effects effects;
    effects.first_bounce = 1;
    effects.last_bounce = 0;
    const reference::Picture truth = truth_of(scene, effects, area ? 256 : 16);
    int lit = 0, alike = 0;
    for (std::size_t p = 0; p < truth.radiance.size(); ++p) {
        const glm::vec3 wanted = truth.radiance[p];
        if (wanted == glm::vec3(0)) continue;
        ++lit;
        bool same = true;
        for (int c = 0; c < 3; ++c)
            same &=
                std::abs(frame.radiance[p][c] - wanted[c]) <= (area ? 0.05f : 0.002f) * wanted[c];
        alike += same;
    }
    EXPECT_GT(lit, 500);
    EXPECT_GT(alike, (area ? 0.8 : 0.95) * lit);
    const glm::dvec3 found = mean_of_texels(frame.radiance),
                     wanted = mean_of_texels(truth.radiance);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c] / wanted[c], 1.0, 0.01) << "channel " << c;
}

// Flat surfaces: an indirect light carries the light that meets its triangle, the path tracer that
// which meets the interpolated normal.
Scene flat(Scene scene) {
    for (const SceneTriangle& triangle : scene.triangles) {
        const glm::dvec3 a = scene.positions[triangle.vertex[0]];
        const glm::vec3 normal(glm::normalize(glm::cross(scene.positions[triangle.vertex[1]] - a,
                                                         scene.positions[triangle.vertex[2]] - a)));
        for (const std::uint32_t vertex : triangle.vertex) scene.normals[vertex] = normal;
    }
    return scene;
}

// One diffuse bounce that nothing stops, of many VPLs.
TEST_P(Oblique, IndirectLightIsThePathTracersInEveryChannel) {
    const Scene scene = flat(scene_with(GetParam()));
    SecondOrderOptions options = solver_options();
    options.direct = false;
    options.emitters.vpls = 10000;
    options.emitters.area_samples = 64;
    const test::Frame frame = test::render(scene, test::oblique_camera(), options);
    reference::Effects effects;
    effects.emission = effects.direct = effects.direct_gloss = effects.indirect_gloss =
        effects.shadowed = false;
    effects.last_bounce = 1;
    const reference::Picture truth = truth_of(scene, effects, 400);
    const double error = truth.relative_error / std::sqrt(double{oblique_width} * oblique_height);
    EXPECT_LT(error, 0.005);
    const glm::dvec3 found = mean_of_texels(frame.radiance),
                     wanted = mean_of_texels(truth.radiance);
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c] / wanted[c], 1.0, 0.01 + 4.5 * error) << "channel " << c;
}

INSTANTIATE_TEST_SUITE_P(Kinds, Oblique, testing::Values(spot, point, sun, wide_spot, lamp));

}  // namespace
}  // namespace clgi
