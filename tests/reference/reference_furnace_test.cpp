// The path tracer in a closed box that glows and reflects.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>

#include "scenes.hpp"

namespace clgi {
namespace {

Scene furnace(float albedo) {
    Scene scene = test::plain_scene();
    Material glowing;
    glowing.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    glowing.emission = glm::vec3(3.0f);
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1, test::add_material(scene, glowing));
    return scene;
}

reference::Options usual() {
    reference::Options out;
    out.samples = 64;
    out.width = out.height = 24;
    return out;
}

TEST(ReferenceFurnace, IsLitAtEveryOrder) {
    for (const float albedo : {0.2f, 0.5f, 0.8f}) {
        const reference::PathTracer tracer(furnace(albedo));
        reference::Options options = usual();
        options.roulette_depth = 16;  // until then the box has no noise
        const auto expect = [&](const std::string& effects, double wanted) {
            options.effects = reference::parse_effects(effects);
            const reference::Picture picture =
                tracer.render(test::camera_at({0.2, 0.1, 0.3}, {1, 0.4, -0.2}), options);
            for (std::size_t p = 0; p < picture.radiance.size(); ++p)
                EXPECT_NEAR(picture.radiance[p].x, wanted, 5.0 * picture.error[p] + 2e-5 * wanted)
                    << effects << ", albedo " << albedo;
        };
        expect("all", 3.0 / (1 - albedo));
        expect("emission", 3.0);
        expect("direct", 3.0 * albedo);
        expect("one-bounce", 3.0 * albedo * albedo);
        expect("bounces=4", 3.0 * std::pow(albedo, 5));
        expect("emission,indirect", 3.0 / (1 - albedo) - 3.0 * albedo);
    }
}

// Roulette is the only noise: from whatever surface on paths end, the mean of all pixels stays.
TEST(ReferenceFurnace, KeepsItsMeanUnderRoulette) {
    for (const float albedo : {0.2f, 0.5f, 0.8f}) {
        const reference::PathTracer tracer(furnace(albedo));
        reference::Options options = usual();
        for (const int depth : {0, 1, 4}) {
            options.roulette_depth = depth;
            const reference::Picture picture =
                tracer.render(test::camera_at({0.2, 0.1, 0.3}, {1, 0.4, -0.2}), options);
            double sum = 0.0, square = 0.0;
            const auto count = static_cast<double>(picture.radiance.size());
            for (const glm::vec3& pixel : picture.radiance) {
                sum += double{pixel.x} / count;
                square += double{pixel.x} * double{pixel.x} / count;
            }
            const double error = std::sqrt((square - sum * sum) / count);
            EXPECT_NEAR(sum, 3.0 / (1 - albedo), 4.0 * error + 2e-5 * sum) << depth << albedo;
            EXPECT_LT(error, 0.01 * sum) << depth << albedo;
        }
    }
}

}  // namespace
}  // namespace clgi
