// Where nothing lies between, shadow maps take no light away: what texels around a corner show is
// another wall, whose plane runs on behind the receiver.
// SPDX-License-Identifier: MIT
#include "frames.hpp"
#include "math_modes.hpp"
#include "slanted_room.hpp"

namespace clgi {
namespace {

// Direct light alone, with shadow maps of so many pixels a side; 0: without.
std::vector<glm::vec3> direct_light(const Scene& scene, const Camera& camera, int side) {
    SecondOrderOptions options;
    options.width = 160;
    options.height = 120;
    options.indirect = false;
    options.emitters.area_samples = 6;
    options.emitters.shadows = side > 0;
    options.emitters.shadow_size = options.emitters.face_size = std::max(side, 1);
    options.build = test::usual_build();
    return test::render(scene, camera, options).radiance;
}

CLGI_IN_ALL_MODES(ConvexShadow);

// Pixels that shadow maps change, from two sides.
std::size_t changed(const Scene& scene, int side) {
    std::size_t out = 0;
    for (const Camera& camera : {test::camera_at({0.6, 1.0, 0.6}, {-0.5, 0.6, -0.7}),
                                 test::camera_at({-0.6, 0.4, -0.7}, {0.4, 0.9, 0.8})}) {
        const auto open = direct_light(scene, camera, 0);
        const auto shadowed = direct_light(scene, camera, side);
        for (std::size_t i = 0; i < open.size(); ++i) {
            EXPECT_GT(open[i].x, 0.0f);
            out += open[i] != shadowed[i];
        }
    }
    return out;
}

TEST_P(ConvexShadow, IsNoneOfLamps) {
    const Scene scene = test::slanted_room();
    for (const int side : {64, 256, 1024}) EXPECT_EQ(changed(scene, side), 0u) << side;
}

// Points of a surface are lit by it at grazing angles, where planes are too steep to be followed on
// coarse maps.
TEST_P(ConvexShadow, IsNoneOfWhatShines) {
    Scene scene = test::slanted_room();
    Material ceiling = scene.materials[0];
    ceiling.emission = {0.3f, 0.2f, 0.6f};
    scene.materials.push_back(ceiling);
    scene.triangles[2].material = scene.triangles[3].material = 1;
    EXPECT_EQ(changed(scene, 256), 0u);
}

}  // namespace
}  // namespace clgi
