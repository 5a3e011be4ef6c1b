// Blended surfaces in the path tracer: by chance for each ray, linear in alpha in the mean.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <numbers>

#include "scenes.hpp"

namespace clgi {
namespace {

using reference::parse_effects;
using reference::PathTracer;
using reference::Picture;
using std::numbers::pi;

reference::Options blended_options(const std::string& effects, int samples) {
    reference::Options options;
    options.effects = parse_effects(effects);
    options.samples = samples;
    return options;
}

// A blended sheet over a floor, between a lamp and both: what the camera sees of the two, what
// passes to the floor and what shines. Blended light is linear in alpha, in every channel.
TEST(ReferenceBlended, IsLinearInAlpha) {
    constexpr double alpha = 0.3;
    Scene scene = test::plain_scene({0.8f, 0.5f, 0.2f});
    test::add_floor(scene, 4.0);
    const glm::dvec3 shining(0.1, 0.4, 0.7);
    Material sheet;
    sheet.base_color = {0.0f, 0.0f, 0.0f, static_cast<float>(alpha)};
    sheet.emission = glm::vec3(shining);
    sheet.alpha_mode = AlphaMode::blend;
    sheet.double_sided = true;
    const std::uint32_t index = test::add_material(scene, sheet);
    test::add_quad(scene, {{{-9, 1.2, -9}, {-9, 1.4, 9}, {9, 1.8, 9}, {9, 1.6, -9}}}, index);
    const double sun = 2.0;
    scene.lights = {test::directional_light({0, -1, 0}, static_cast<float>(sun))};
    reference::Options options = blended_options("emission,direct", 4096);
    options.width = options.height = 3;
    const Camera above = test::camera_at({1.1, 3, 0.2}, {1, 0, 0.3}, 0.1f);
    for (const reference::Filter filter : {reference::Filter::center, reference::Filter::box}) {
        options.filter = filter;
        const Picture picture = PathTracer(scene).render(above, options);
        // The floor sees the sheet as a lamp of all its hemisphere, nearly.
        const glm::dvec3 floor =
            glm::dvec3(0.8, 0.5, 0.2) * ((1.0 - alpha) * sun / pi + alpha * shining * 0.975);
        const glm::dvec3 wanted = alpha * shining + (1.0 - alpha) * floor;
        for (int c = 0; c < 3; ++c) {
            double mean = 0.0;
            for (const glm::vec3& radiance : picture.radiance) mean += radiance[c] / 9.0;
            EXPECT_NEAR(mean, wanted[c], 0.02 * wanted[c]) << c;
        }
    }
    // What reaches the floor.
    const auto behind =
        PathTracer(scene).irradiance({{{1.3, 0.01, 0.4}, {0, 1, 0}}}, blended_options("direct", 20000));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(behind.values[0][c], (1.0 - alpha) * sun + alpha * pi * shining[c] * 0.975,
                    0.03)
            << c;
}

// What a sheet reflects to the floor below, of a lamp between the two.
TEST(ReferenceBlended, ReflectsAsMuchAsItCovers) {
    constexpr double alpha = 0.3;
    Scene scene = test::plain_scene(glm::vec3(0.0f));
    test::add_floor(scene, 4.0);
    Material sheet;
    sheet.base_color = {0.9f, 0.5f, 0.2f, 1.0f};
    sheet.alpha_mode = AlphaMode::blend;
    sheet.double_sided = true;
    test::add_quad(scene, {{{-2, 1.8, -2}, {-2, 1.9, 2}, {2, 2.2, 2}, {2, 2.1, -2}}},
                   test::add_material(scene, sheet));
    scene.lights = {test::point_light({0.2, 0.8, -0.1}, 5.0f)};
    for (const char* effects : {"one-bounce", "unshadowed-indirect"}) {
        const auto light = [&](float share) {
            scene.materials.back().base_color.a = share;
            return PathTracer(scene)
                .irradiance({{{0.7, 0.01, 0.4}, {0, 1, 0}}}, blended_options(effects, 40000))
                .values[0];
        };
        const glm::vec3 whole = light(1.0f), part = light(static_cast<float>(alpha));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(part[c] / whole[c], alpha, 0.05 * alpha) << effects << c;
    }
}

}  // namespace
}  // namespace clgi
