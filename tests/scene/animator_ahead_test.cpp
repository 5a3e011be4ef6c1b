// Frames that hold long clips, and a host that is many steps ahead of the device.
// SPDX-License-Identifier: MIT
#include <clgi/scene_animator.hpp>

#include "frames.hpp"
#include "posing.hpp"
#include "turning.hpp"

namespace clgi {
namespace {

using test::GltfDraft;

// A triangle that stands still but at some of its keys, one a second.
Scene with_leaps(std::size_t keys, const std::vector<std::pair<std::size_t, glm::vec3>>& leaps) {
    GltfDraft draft = test::triangle_draft();
    std::vector<float> times(keys);
    test::Floats3 places(keys, {0, 0, 0});
    for (std::size_t i = 0; i < keys; ++i) times[i] = static_cast<float>(i);
    for (const auto& [key, place] : leaps) places[key] = {place.x, place.y, place.z};
    test::animate(draft, 0, "translation", test::scalars(draft, times), draft.vec3(places), "STEP");
    return draft.load();
}

TEST(MotionBounds, HoldEveryKey) {
    for (const std::size_t keys : {3, 300, 999, 3000, 10000}) {
        Scene scene = with_leaps(keys, {{keys - 1, {100, 0, 0}}, {keys / 2, {0, 0, -7}}});
        const Bounds found = *motion_bounds(scene, 0);
        EXPECT_GE(found.high.x, 101.0) << keys;
        EXPECT_LE(found.low.z, -7.0) << keys;
        EXPECT_LE(found.high.x, 101.0 * 17 / 16) << keys;
        scene.moving_bounds = found;
        DeviceScene device = test::on_device(scene);
        SceneAnimator animator(test::programs(), test::device().queue, scene, device);
        animator.animate(0, scene.animation->clips[0].duration).done.wait();
        EXPECT_TRUE(animator.status().fits) << keys;
    }
    // An even choice of more.
    const Scene scene = with_leaps(20001, {{20000, {100, 0, 0}}, {0, {0, 5, 0}}});
    EXPECT_GE(motion_bounds(scene, 0)->high.x, 101.0);
    EXPECT_GE(motion_bounds(scene, 0)->high.y, 6.0);
}

// Between keys the far corner is at (0,2,0); both keys have it on the x axis.
TEST(MotionBounds, HoldWhatLiesBetweenKeys) {
    GltfDraft draft;
    draft.show({{"attributes", {{"POSITION", draft.vec3({{0, 0, 0}, {2, 0, 0}, {0, 1, 0}})}}}});
    test::animate(draft, 0, "rotation", test::scalars(draft, {0, 1}),
                  test::vec4s(draft, {0, 0, 0, 1, 0, 0, 1, 0}));
    EXPECT_GE(motion_bounds(draft.load(), 0)->high.y, 2.0);
}

TEST(SceneAnimator, MayBeManyStepsAheadOfTheDevice) {
    const Scene scene = test::bent_strip();
    DeviceScene device = test::on_device(scene), other = test::on_device(scene);
    SceneAnimator at_once(test::programs(), test::device().queue, scene, other);
    at_once.animate(0, 0.9).done.wait();
    cl::CommandQueue queue(test::device().context, test::device().device);
    SceneAnimator held(test::programs(), queue, scene, device);
    cl::UserEvent gate(test::device().context);
    Animated step;
    for (int i = 0; i < 40; ++i) step = held.animate(0, i == 39 ? 0.9 : 0.02 * i, {gate});
    gate.setStatus(CL_COMPLETE);
    step.done.wait();
    EXPECT_TRUE(test::same_bits(test::vertex_bits(device), test::vertex_bits(other)));
}

}  // namespace
}  // namespace clgi
