// Paths that end by chance.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/reference.hpp>
#include <cmath>

#include "scenes.hpp"

namespace clgi {
namespace {

// A closed box that glows and reflects, in which roulette is the only noise: from whatever surface
// on paths end, the mean of all pixels stays.
TEST(ReferenceRoulette, LeavesTheMeanAsItIs) {
    for (const float albedo : {0.2f, 0.5f, 0.8f}) {
        Scene scene = test::plain_scene();
        Material glowing;
        glowing.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
        glowing.emission = glm::vec3(3.0f);
        test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1, test::add_material(scene, glowing));
        const reference::PathTracer tracer(scene);
        reference::Options options;
        options.samples = 64;
        options.width = options.height = 24;
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
