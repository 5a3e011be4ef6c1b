// A receiver that is too near to a source to be in any of its shadow maps is lit, and those beside
// it in a packet keep their shadows.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "oblique.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

TEST(NearShadow, LeavesTheShadowsOfOthers) {
    Scene scene = test::oblique_room();
    scene.lights = {test::point_light({0.1, 0.2, -0.1}, 50.0f)};
    const DeviceScene placed = test::on_device(scene);
    const EmitterSet set = make_emitters(placed, {.vpls = 1, .face_size = 16});
    ASSERT_EQ(set.emitters[0].view_count, 6u);
    test::Shading in;
    in.emitters = set.emitters;
    in.views = set.views;
    in.materials = scene.materials;
    in.visibility.assign(set.pixels, test::word_of(1e6f, 0));  // something right before the source
    in.view = make_view(test::oblique_camera(), placed.frame(), 40, 30);
    in.params.exposure = 1.0f;
    in.params.texel_bias = 1.5f;
    in.params.effects = COMBINE_DIRECT;
    const glm::vec3 lamp(set.emitters[0].position);
    for (int i = 0; i < 96; ++i) {
        const View& face = set.views[set.emitters[0].first_view + i % 6];
        const bool near = i % 6 == 0;
        const float away = near ? 0.5f * face.forward.w : 0.3f;
        const glm::vec3 forward(face.forward);
        test::ShadedPixel pixel;
        pixel.position = lamp + away * forward;
        pixel.normal = pixel.geometric = -forward;
        pixel.base = glm::vec3(0.5f);
        in.pixels.push_back(pixel);
    }
    const auto found = test::combine(in).radiance;
    for (int i = 0; i < 96; ++i) EXPECT_EQ(found[i].x > 0.0f, i % 6 == 0) << i;
}

}  // namespace
}  // namespace clgi
