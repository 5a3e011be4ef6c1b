// Pictures of what moves through a bake of what stands still, against the path tracer, and what
// they cost.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/scene_animator.hpp>

#include "effect_cost.hpp"
#include "math_modes.hpp"
#include "moving_box.hpp"
#include "planned_pictures.hpp"

namespace clgi {
namespace {

// A picture of the animated room by the atlas, as a plan has it.
test::Radiances by_atlas(const Scene& scene, const Camera& camera, double seconds) {
    PlanRequest request = test::quick();
    request.animated = true;
    request.method = Method::light_atlas;
    request.build = test::usual_build();
    Plan plan = test::plan_of(scene, camera, request);
    plan.picture.emitters.shadow_size = 1024;
    plan.vpls.count = 800;
    plan.layout.size = 128;
    EXPECT_STREQ(plan.effects[static_cast<std::size_t>(Effect::moving_geometry)].by.c_str(),
                 "direct light, volume");
    const Scene planned = planned_scene(scene, plan);
    DeviceScene uploaded = test::on_device(planned);
    const cl::CommandQueue& queue = test::device().queue;
    Renderer renderer(test::programs(), queue, planned, uploaded, plan);
    SceneAnimator animator(test::programs(), queue, planned, uploaded);
    EXPECT_TRUE(renderer.prepare());
    const Animated step = animator.animate(0, seconds);
    renderer.render(camera, {step.done}).wait();
    EXPECT_EQ(renderer.status().non_finite, 0u);
    return test::shown_by(renderer);
}

CLGI_IN_ALL_MODES(StillPicture);

// A box goes through a coloured room. At both ends of its way, the light of the whole picture and
// that of the box alone are the path tracer's.
TEST_P(StillPicture, IsThatOfThePathTracer) {
    const Scene scene = test::moving_box_room();
    const Camera& camera = scene.cameras[0];
    for (const double seconds : {0.0, 1.0}) {
        const Scene posed_scene = posed(scene, pose_at(*scene.animation, 0, seconds));
        const test::Radiances truth = test::traced(posed_scene, camera, 512);
        const test::Radiances found = by_atlas(scene, camera, seconds);
        EXPECT_NEAR(test::mean(found) / test::mean(truth), 1.0, 0.04) << seconds;
        EXPECT_LT(test::distance(found, truth), 0.12 * test::mean(truth)) << seconds;
        const std::vector<bool> box = test::seen_of(posed_scene, camera);
        glm::dvec3 got(0.0), wanted(0.0);
        int pixels = 0;
        for (std::size_t i = 0; i < box.size(); ++i) {
            if (!box[i]) continue;
            got += glm::dvec3(found[i]);
            wanted += glm::dvec3(truth[i]);
            ++pixels;
        }
        ASSERT_GT(pixels, 20);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c] / wanted[c], 1.0, 0.12) << seconds << c;
    }
}

// Other lights are those of the bake too.
TEST(StillPictures, FollowTheirLights) {
    const Scene scene = test::moving_box_room();
    const Camera& camera = scene.cameras[0];
    PlanRequest request = test::quick();
    request.animated = true;
    request.method = Method::light_atlas;
    Plan plan = test::plan_of(scene, camera, request);
    plan.vpls.count = 200;
    plan.layout.size = 64;
    plan.least_change = 0.0;  // all of the change
    const Scene planned = planned_scene(scene, plan);
    DeviceScene uploaded = test::on_device(planned);
    Renderer renderer(test::programs(), test::device().queue, planned, uploaded, plan);
    ASSERT_TRUE(renderer.prepare());
    renderer.render(camera).wait();
    const test::Radiances before = test::shown_by(renderer);
    Light light = uploaded.lights()[0];
    light.intensity *= 0.5f;
    uploaded.set_light(0, light);
    renderer.lights_changed();
    ASSERT_TRUE(renderer.prepare());
    renderer.render(camera).wait();
    const test::Radiances after = test::shown_by(renderer);
    for (std::size_t i = 0; i < before.size(); ++i)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(after[i][c], 0.5f * before[i][c], 1e-5f * (1.0f + before[i][c]));
    EXPECT_GT(test::mean(before), 0.0);
}

// Of motion that is left out there is no volume, no second scene and no time.
TEST(StillPictures, CostNothingWithoutMotion) {
    const Scene scene = test::moving_box_room();
    const auto cost = [&](const std::vector<Effect>& without) {
        PlanRequest request = test::quick({}, without);
        request.animated = true;
        request.method = Method::light_atlas;
        request.shadow_size = request.face_size = 64;
        Plan plan = test::plan_of(scene, scene.cameras[0], request);
        plan.vpls.count = 100;
        plan.layout.size = 64;
        const Scene planned = planned_scene(scene, plan);
        DeviceScene uploaded = test::on_device(planned);
        const Programs own = test::own_programs();
        Renderer renderer(own, test::device().queue, planned, uploaded, plan);
        EXPECT_TRUE(renderer.prepare());
        renderer.render(scene.cameras[0]).wait();
        test::Cost out;
        out.kernels = own.built_kernels();
        out.add(renderer.times());
        out.bytes = renderer.bytes();
        return out;
    };
    const test::Cost with = cost({}), less = cost({Effect::moving_geometry});
    EXPECT_EQ(with.built("volume"), 1u);
    EXPECT_EQ(with.enqueued("atlas.volume"), 1u);
    EXPECT_EQ(less.built("volume"), 0u);
    EXPECT_EQ(less.enqueued("atlas.volume"), 0u);
    EXPECT_LT(less.bytes, with.bytes);
}

}  // namespace
}  // namespace clgi
