// Pictures by plans of animated scenes: motion that matters is not left out.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/scene_animator.hpp>

#include "math_modes.hpp"
#include "planned_pictures.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::distance;
using test::mean;
using test::Radiances;

// One node that a clip of a second carries by `travel`.
Animation carried_by(const glm::vec3& travel) {
    Animation out;
    out.nodes.resize(1);
    AnimationClip clip;
    clip.duration = 1.0;
    clip.curves = {
        {Interpolation::linear, 3, {0.0f, 1.0f}, {0, 0, 0, travel.x, travel.y, travel.z}}};
    clip.channels = {{ChannelTarget::translation, 0, 0}};
    out.clips = {clip};
    return out;
}

// A floor under a coloured spot.
Scene floor_under_spot(double x) {
    Scene scene = test::plain_scene({0.6f, 0.5f, 0.2f});
    test::add_floor(scene, 1.5);
    scene.lights = {test::spot_light({x, 2.0, 0}, {0, -1, 0.05f}, 0.5)};
    scene.lights[0].intensity = {4.0f, 8.0f, 16.0f};
    return scene;
}

// A plate that the clip brings between the spot and all of the floor that is seen.
Scene moving_blocker() {
    Scene scene = floor_under_spot(0.0);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const auto from = static_cast<std::uint32_t>(scene.triangles.size());
    test::add_box(scene, {2.2, 1.2, -0.9}, {4.0, 1.3, 0.9}, 1);
    scene.parts = {{"floor", 0, from},
                   {"plate", from, static_cast<std::uint32_t>(scene.triangles.size()) - from}};
    Animation animation = carried_by({-3.1f, 0.0f, 0.0f});
    PosedRange range;
    range.first_vertex = first;
    range.vertex_count = static_cast<std::uint32_t>(scene.positions.size()) - first;
    range.part = 1;
    animation.ranges = {range};
    for (std::size_t v = first; v < scene.positions.size(); ++v) {
        animation.rest_positions.emplace_back(scene.positions[v]);
        animation.rest_normals.push_back(scene.normals[v]);
    }
    scene.animation = animation;
    return scene;
}

// A spot that lights nothing that is seen until the clip has brought it.
Scene moving_light() {
    Scene scene = floor_under_spot(0.0);
    scene.lights[0].position = {0.0, 0.0, 0.0};
    scene.animation = carried_by({-3.0f, 0.0f, 0.0f});
    scene.animation->nodes.push_back({});
    scene.animation->nodes[1].parent = 0;
    scene.animation->nodes[1].translation = {3.0, 2.0, 0.0};
    scene.animation->nodes[1].rotation = glm::angleAxis(-1.52, glm::dvec3(1, 0, 0));
    scene.animation->lights = {{0, 1}};
    const Pose rest = rest_pose(*scene.animation);
    scene.lights = posed(scene, rest).lights;
    return scene;
}

PlanRequest moving(std::vector<Effect> without = {}) {
    PlanRequest out = test::quick({}, std::move(without));
    out.animated = true;
    out.build = test::usual_build();
    out.method = Method::second_order;  // which draws what is there in every picture
    return out;
}

// The picture at a time of the clip, with nothing of the motion but what the plan keeps.
Radiances at_time(const Scene& scene, const Camera& camera, const Plan& plan, double seconds) {
    Scene left = planned_scene(scene, plan);
    left.moving_bounds = motion_bounds(left, 0);
    DeviceScene uploaded = test::on_device(left);
    const cl::CommandQueue& queue = test::device().queue;
    Renderer renderer(test::programs(), queue, left, uploaded, plan);
    SceneAnimator animator(test::programs(), queue, left, uploaded);
    EXPECT_TRUE(renderer.prepare());
    renderer.render(camera).wait();
    const Animated step = animator.animate(0, seconds);
    if (step.lights) renderer.lights_changed();
    renderer.render(camera, {step.done}).wait();
    EXPECT_EQ(renderer.status().non_finite, 0u);
    return test::shown_by(renderer);
}

CLGI_IN_ALL_MODES(PlannedMotion);

TEST_P(PlannedMotion, KeepsMotionThatIsTheWholePicture) {
    const Camera down = test::camera_at({0.1, 1.0, 0.4}, {0, 0, 0}, 0.5f);
    for (const auto& [effect, scene] : {std::pair{Effect::moving_geometry, moving_blocker()},
                                        {Effect::moving_lights, moving_light()}}) {
        SCOPED_TRACE(name_of(effect));
        const Plan plan = test::plan_of(scene, down, moving());
        const Plan less = test::plan_of(scene, down, moving({effect}));
        EXPECT_TRUE(plan.on(effect));
        EXPECT_TRUE(plan.on(Effect::direct_shadows));  // the plate is not there at first
        EXPECT_FALSE(less.on(effect));
        for (const double seconds : {0.0, 1.0}) {
            const Radiances truth =
                test::traced(posed(scene, pose_at(*scene.animation, 0, seconds)), down, 256);
            const Radiances kept = at_time(scene, down, plan, seconds);
            const Radiances left = at_time(scene, down, less, seconds);
            const double level = std::max(mean(truth), mean(left));
            EXPECT_LE(distance(kept, truth), 0.05 * level) << seconds << " s";
            if (seconds > 0.0) {
                EXPECT_GT(distance(left, truth), 0.5 * level);
                EXPECT_GT(level, 0.0);
            } else {
                EXPECT_LE(distance(left, kept), 0.01 * level);
            }
        }
    }
}

}  // namespace
}  // namespace clgi
