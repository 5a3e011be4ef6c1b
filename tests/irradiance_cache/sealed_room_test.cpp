// A sealed room under a bright sky, its walls without thickness: no light comes in, whatever the
// places of records.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "cache_pictures.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

CLGI_IN_BOTH_MATHS(SealedRoom);

// Seen along its axis: the edges along it run through the centres of pixels, and records stand on
// them.
TEST_P(SealedRoom, HasNothingOfTheSky) {
    Scene scene = test::plain_scene({0.9f, 0.8f, 0.7f});
    test::add_box(scene, glm::dvec3(-1), glm::dvec3(1), -1);
    scene.environment = test::even_sky({10.0f, 20.0f, 40.0f});
    scene.cameras = {test::camera_at({0, 0, 0.9}, {0, 0, -1}, 1.6f)};
    for (const bool orthographic : {false, true}) {
        scene.cameras[0].kind =
            orthographic ? Camera::Kind::orthographic : Camera::Kind::perspective;
        scene.cameras[0].half_height = 0.7f;
        double brightest = 0.0;
        for (const glm::vec3& radiance : pictured(scene, cache_options()).radiance)
            brightest = std::max(brightest, double{radiance.y});
        EXPECT_EQ(brightest, 0.0) << orthographic;
    }
}

}  // namespace
}  // namespace clgi
