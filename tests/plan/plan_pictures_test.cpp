// Pictures by plans: what is left out changes nothing, and what matters is not left out.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <set>

#include "planned_pictures.hpp"
#include "scenes.hpp"
#include "slanted_room.hpp"

namespace clgi {
namespace {

using test::add_coloured_lights;
using test::all_effects;
using test::distance;
using test::mean;
using test::plan_of;
using test::quick;
using test::Radiances;
using test::slanted_room;

struct Rendered {
    Radiances pixels;
    std::set<std::string> passes;
    std::size_t bytes = 0;
};

Rendered render(const Scene& scene, const Camera& camera, const Plan& plan) {
    const cl::CommandQueue& queue = test::device().queue;
    const Scene left = planned_scene(scene, plan);
    DeviceScene uploaded = test::on_device(left);
    Renderer renderer(test::programs(), queue, left, uploaded, plan);
    EXPECT_TRUE(renderer.prepare());
    renderer.render(camera).wait();
    EXPECT_EQ(renderer.status().non_finite, 0u);
    Rendered out;
    out.pixels = test::shown_by(renderer);
    for (const PassEvent& pass : renderer.times()) out.passes.insert(pass.name);
    out.bytes = renderer.bytes();
    return out;
}

// ---- what is left out changes nothing ----------------------------------------------------------

TEST(Plan, LeavesOutShadowsInAConvexRoom) {
    const Scene scene = slanted_room();
    const Camera camera = test::camera_at({0.6, 1.0, 0.6}, {-0.5, 0.6, -0.7});
    const Plan plan = plan_of(scene, camera, quick());
    for (const Effect effect : {Effect::direct_shadows, Effect::indirect_occlusion}) {
        EXPECT_FALSE(plan.on(effect)) << name_of(effect);
        EXPECT_EQ(plan.effects[static_cast<std::size_t>(effect)].evidence, Evidence::proven);
    }
    EXPECT_TRUE(plan.on(Effect::further_bounces));
    PlanRequest request = quick(all_effects());
    request.method = plan.method;
    const Plan everything = plan_of(scene, camera, request);
    EXPECT_TRUE(everything.on(Effect::direct_shadows));

    const Rendered lean = render(scene, camera, plan), full = render(scene, camera, everything);
    // Antiradiance, of which there is none here, errs by its bins where it is asked for.
    EXPECT_LT(distance(lean.pixels, full.pixels), 1e-2 * mean(full.pixels));
    request.with = {Effect::direct_shadows};
    const Plan shadowed = plan_of(scene, camera, request);
    EXPECT_TRUE(shadowed.on(Effect::direct_shadows));
    EXPECT_EQ(render(scene, camera, shadowed).pixels, lean.pixels);
    EXPECT_LT(lean.bytes, full.bytes);
    const Radiances truth = test::traced(scene, camera, 512);
    EXPECT_LT(distance(lean.pixels, truth), 0.1 * mean(truth));
    EXPECT_NEAR(mean(lean.pixels), mean(truth), 0.04 * mean(truth));
}

TEST(Plan, HasDirectLightAloneWhereNothingReflects) {
    Scene scene = slanted_room();
    scene.materials[0].base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    Material bright;
    bright.emission = {0.5f, 1.0f, 2.0f};
    bright.base_color = scene.materials[0].base_color;
    test::add_box(scene, {-0.2, 0.2, -0.4}, {0.2, 0.5, -0.1}, 1, test::add_material(scene, bright));
    const Camera camera = test::camera_at({0.6, 1.0, 0.6}, {-0.2, 0.3, -0.4});
    const Plan plan = plan_of(scene, camera, quick());
    EXPECT_EQ(plan.method, Method::direct);
    const Rendered lean = render(scene, camera, plan);
    EXPECT_FALSE(lean.passes.count("lights.fetch"));
    EXPECT_FALSE(lean.passes.count("image.gather"));
    const Rendered full = render(scene, camera, plan_of(scene, camera, quick(all_effects())));
    EXPECT_LT(distance(lean.pixels, full.pixels), 1e-5 * mean(full.pixels));
    EXPECT_GT(mean(lean.pixels), 0.0);
}

// A tilted cube under a sky that is brighter above: closed form, the mean of L over the cosine.
TEST(Plan, HasNoMasksOfOneObjectUnderASky) {
    Scene scene = test::plain_scene({0.8f, 0.6f, 0.4f});
    test::add_box(scene, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, 1);
    Environment sky;
    sky.factor = {1.0f, 2.0f, 4.0f};
    scene.environment = sky;
    const Camera camera = test::camera_at({0.9, 0.8, 1.0}, {0, 0, 0}, 0.5f);
    const Plan plan = plan_of(scene, camera, quick());
    EXPECT_FALSE(plan.on(Effect::environment_shadows));
    EXPECT_FALSE(plan.on(Effect::first_bounce));
    EXPECT_EQ(plan.method, Method::dynamic_transfer);
    const Rendered lean = render(scene, camera, plan);
    for (const std::string& pass : lean.passes)
        EXPECT_EQ(pass.find("mask"), std::string::npos) << pass;
    for (const glm::vec3& pixel : lean.pixels)  // the cube fills the picture: albedo times L
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(pixel[c], scene.materials[0].base_color[c] * sky.factor[c],
                        1e-3 * sky.factor[c]);
}

// A dim floor below a lamp as large as itself: light comes back to it by way of the lamp alone,
// where the camera does not look.
TEST(Plan, BoundsLightThatComesLate) {
    Scene scene = test::plain_scene({0.2f, 0.29f, 0.1f});
    test::add_floor(scene, 2.0);
    Material lamp = scene.materials[0];
    lamp.emission = {1.0f, 2.0f, 4.0f};
    test::add_quad(scene, {glm::dvec3(-2, 1, -2), {2, 1, -2}, {2, 1, 2}, {-2, 1, 2}},
                   test::add_material(scene, lamp));
    const Camera camera = test::camera_at({0.1, 0.8, 0.1}, {0, 0, 0}, 0.6f);
    PlanRequest request = quick();
    request.tolerance = 1.0;
    const Plan plan = plan_of(scene, camera, request);
    ASSERT_TRUE(plan.probe);
    EXPECT_FALSE(plan.on(Effect::first_bounce));
    reference::Effects direct_light;
    direct_light.last_bounce = 0;
    const Radiances all = test::traced(scene, camera, 512);
    const Radiances direct = test::traced(scene, camera, 512, direct_light);
    const double lost = distance(direct, all) / mean(all);
    EXPECT_GT(lost, 0.02);
    EXPECT_LT(lost, plan.bound) << plan.probe->first_bounce << " " << plan.probe->reflected;
}

// A dark room: the probe's share of one bounce, which nothing shadows, is that of the path tracer.
TEST(Plan, ProbesIndirectLightOfDarkScenes) {
    Scene scene = slanted_room();
    scene.materials[0].base_color = {0.1f, 0.07f, 0.05f, 1.0f};
    const Camera camera = test::camera_at({0.6, 1.0, 0.6}, {-0.5, 0.6, -0.7});
    PlanRequest request = quick();
    request.tolerance = 0.5;
    const Plan plan = plan_of(scene, camera, request);
    ASSERT_TRUE(plan.probe);
    reference::Effects effects;
    effects.last_bounce = 1;
    const Radiances once = test::traced(scene, camera, 256, effects);
    effects.last_bounce = 0;
    const Radiances direct = test::traced(scene, camera, 16, effects);
    const double share = distance(once, direct) / mean(once);
    EXPECT_NEAR(plan.probe->first_bounce, share, 0.1 * share);
    EXPECT_FALSE(plan.on(Effect::first_bounce));
    const EffectChoice& first = plan.effects[static_cast<std::size_t>(Effect::first_bounce)];
    EXPECT_EQ(plan.bound, first.bound);
    EXPECT_GT(first.bound, share);
    EXPECT_LT(first.bound, 4.0 * share);
}

// Lights that change under a plan of each method that keeps something of them.
TEST(Plan, FollowsLightsThatChange) {
    const Scene scene = slanted_room();
    const Camera camera = test::camera_at({0.6, 1.0, 0.6}, {-0.5, 0.6, -0.7});
    for (const Method method : {Method::light_atlas, Method::antiradiance}) {
        SCOPED_TRACE(name_of(method));
        PlanRequest request = quick();
        request.method = method;
        request.lights_change = true;
        Scene changed = scene;
        changed.lights[0].position = {-0.4, 0.4, 0.3};
        const Plan plan = plan_of(scene, camera, request);
        DeviceScene uploaded = test::on_device(scene);
        Renderer renderer(test::programs(), test::device().queue, scene, uploaded, plan);
        EXPECT_TRUE(renderer.prepare());
        renderer.render(camera).wait();
        const Radiances before = test::shown_by(renderer);
        uploaded.set_light(0, changed.lights[0]);
        renderer.lights_changed();
        EXPECT_TRUE(renderer.prepare());
        renderer.render(camera).wait();
        const Radiances after = test::shown_by(renderer),
                        fresh = render(changed, camera, plan).pixels;
        EXPECT_LT(distance(after, fresh), 1e-3 * mean(fresh));
        EXPECT_GT(distance(after, before), 0.1 * mean(fresh));
    }
}

Scene floor_with(const Light& light) {
    Scene scene = test::plain_scene({0.6f, 0.5f, 0.2f});
    test::add_floor(scene, 1.0);
    scene.lights = {light};
    scene.lights[0].intensity *= glm::vec3(0.5f, 1.0f, 2.0f);
    return scene;
}

TEST(Plan, KnowsNoErrorWhereTheCameraSeesNoLight) {
    Scene scene = floor_with(test::point_light({0.2, 0.7, 0}, 2.0f));
    test::add_box(scene, {-0.4, 0.1, -0.4}, {-0.2, 0.3, -0.2}, 1);
    const Plan seen = plan_of(scene, test::camera_at({0.1, 1.5, 0.6}, {0, 0, 0}, 0.6f), quick());
    EXPECT_TRUE(seen.error);
    const Plan blind = plan_of(scene, test::camera_at({0.1, 1.5, 0.6}, {0, 9, 1}, 0.6f), quick());
    ASSERT_TRUE(blind.probe);
    EXPECT_TRUE(std::isinf(blind.probe->direct_error));
    EXPECT_FALSE(blind.error);
}

// ---- what matters is not left out --------------------------------------------------------------

// A scene whose picture is one effect alone.
struct Whole {
    Effect effect;
    Scene scene;
    Camera camera;
    double error;  // of the plan's picture to the path tracer's, over the mean of the picture
                   // without the effect or of the truth, whichever is brighter
};

std::vector<Whole> wholes() {
    std::vector<Whole> out;
    const Camera down = test::camera_at({0.1, 1.5, 0.6}, {0, 0, 0}, 0.6f);
    out.push_back(
        {Effect::point_light, floor_with(test::point_light({0.2, 0.7, 0}, 2.0f)), down, 0.02});
    out.push_back({Effect::spot_light,
                   floor_with(test::spot_light({0.2, 0.7, 0}, {0, -1, 0.1}, 1.0)), down, 0.05});
    out.push_back({Effect::directional_light, floor_with(test::directional_light({0.3, -1, 0.2})),
                   down, 0.02});

    Scene panel = test::plain_scene({0.6f, 0.5f, 0.2f});
    test::add_floor(panel, 1.0);
    Material shining;
    shining.emission = {5.0f, 10.0f, 20.0f};
    shining.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 1.0f);
    test::add_quad(
        panel, {glm::dvec3(-0.1, 1.6, -0.1), {0.1, 1.6, -0.1}, {0.1, 1.6, 0.1}, {-0.1, 1.6, 0.1}},
        test::add_material(panel, shining));
    out.push_back(
        {Effect::area_light, panel, test::camera_at({0.1, 1.0, 0.6}, {0, 0, 0}, 0.6f), 0.05});

    Scene sky = test::plain_scene({0.6f, 0.5f, 0.2f});
    test::add_floor(sky, 1.0);
    sky.environment = Environment();
    out.push_back({Effect::environment_light, sky, down, 0.02});

    // A plate between the sun and all of the floor that is seen.
    Scene shadow = floor_with(test::directional_light({0, -1, 0}));
    test::add_box(shadow, {-0.9, 1.8, -0.9}, {0.9, 1.9, 0.9}, 1);
    out.push_back(
        {Effect::direct_shadows, shadow, test::camera_at({0.1, 0.8, 0.3}, {0, 0, 0}, 0.5f), 0.05});

    Scene cellar = test::plain_scene({0.6f, 0.5f, 0.2f});  // under a sky, with a thick lid
    test::add_box(cellar, {-1, 0, -1}, {1, 1, 1}, -1);
    test::add_box(cellar, {-1.1, -0.1, -1.1}, {1.1, 1.1, 1.1}, 1);
    cellar.environment = Environment();
    out.push_back({Effect::environment_shadows, cellar,
                   test::camera_at({0.1, 0.8, 0.3}, {0, 0, 0}, 0.5f), 0.05});

    // A room with a small window: the sky comes in through it alone, by any method.
    Scene window = test::plain_scene({0.0f, 0.0f, 0.0f});
    for (const double z : {-1.0, 1.0})  // two walls, of which one has the window
        for (const double side : {-1.0, 1.0})
            test::add_box(window, {side > 0 ? 0.3 : -1.1, -0.1, z - 0.1},
                          {side > 0 ? 1.1 : (z > 0 ? -0.3 : 0.3), 1.1, z + 0.1}, 1);
    test::add_box(window, {-1.1, -0.1, -1.1}, {1.1, 0.0, 1.1}, 1);
    test::add_box(window, {-1.1, 1.0, -1.1}, {1.1, 1.1, 1.1}, 1);
    for (const double x : {-1.05, 1.05})
        test::add_box(window, {x - 0.05, 0, -1}, {x + 0.05, 1, 1}, 1);
    Material floor;
    floor.base_color = {0.6f, 0.5f, 0.2f, 1.0f};
    test::add_quad(window, {glm::dvec3(-1, 0.01, 1), {1, 0.01, 1}, {1, 0.01, -1}, {-1, 0.01, -1}},
                   test::add_material(window, floor));
    window.environment = Environment();
    out.push_back({Effect::environment_shadows, window,
                   test::camera_at({0.1, 0.8, -0.3}, {0, 0, -0.5}, 0.5f), 0.08});

    // Leaves that are all hole under a sky.
    Scene leaves = test::plain_scene({0.6f, 0.5f, 0.2f});
    test::add_floor(leaves, 1.0);
    Material gap;
    gap.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 0.1f);
    gap.alpha_mode = AlphaMode::mask;
    gap.double_sided = true;
    test::add_floor(leaves, 1.5, 0.3, test::add_material(leaves, gap));
    leaves.environment = Environment();
    out.push_back({Effect::cutouts, leaves, down, 0.12});

    // The ceiling over a floor that a spot lights.
    Scene ceiling = test::plain_scene({0.7f, 0.5f, 0.3f});
    test::add_box(ceiling, {-1, 0, -1}, {1, 2, 1}, -1);
    ceiling.lights = {test::spot_light({0, 1.9, 0}, {0, -1, 0}, 0.4, 9.0f)};
    const Camera up = test::camera_at({0.1, 0.5, 0.1}, {0, 2, 0}, 0.8f);
    out.push_back({Effect::first_bounce, ceiling, up, 0.12});
    ceiling.materials[0].base_color = glm::vec4(0.9f, 0.9f, 0.9f, 1.0f);
    out.push_back({Effect::further_bounces, ceiling, up, 0.2});

    // A closed chamber beside a lit one.
    Scene dark = test::plain_scene({0.7f, 0.6f, 0.5f});
    test::add_box(dark, {0, 0, 0}, {1, 1, 1}, -1);
    test::add_box(dark, {1.1, 0, 0}, {2.1, 1, 1}, -1);
    dark.lights = {test::point_light({0.5, 0.8, 0.5})};
    out.push_back({Effect::indirect_occlusion, dark,
                   test::camera_at({1.3, 0.5, 0.5}, {2.1, 0.4, 0.5}, 0.8f), 0.05});

    // A rough metal that throws a lamp's light into the camera.
    Scene metal = floor_with(test::point_light({0.0, 1.0, -1.5}, 3.0f));
    metal.materials[0].metallic = 1.0f;
    metal.materials[0].roughness = 0.4f;
    out.push_back({Effect::gloss, metal, test::camera_at({0, 1.0, 1.5}, {0, 0, 0}, 0.4f), 0.05});

    Scene board = floor_with(test::directional_light({0, -1, 0.1}));
    Texture chess;
    chess.width = chess.height = 2;
    chess.nearest = true;
    for (const std::uint8_t value : {0, 255, 255, 0})
        for (const std::uint8_t channel : {value, value, value, std::uint8_t{255}})
            chess.rgba.push_back(channel);
    board.textures = {chess};
    board.uvs.clear();
    for (const glm::dvec3& at : board.positions)
        board.uvs.emplace_back(2.0 * at.x, 2.0 * at.z, 0.0, 0.0);
    board.materials[0].base_texture.texture = 0;
    // The truth is the mean over a pixel, where squares meet.
    out.push_back({Effect::textures, board, down, 0.35});

    // A black plate that is all hole, over the floor.
    Scene hole = floor_with(test::directional_light({0, -1, 0.1}));
    Material open;
    open.base_color = glm::vec4(0.0f, 0.0f, 0.0f, 0.1f);
    open.alpha_mode = AlphaMode::mask;
    test::add_floor(hole, 1.0, 0.3, test::add_material(hole, open));
    out.push_back({Effect::cutouts, hole, down, 0.02});
    return out;
}

TEST(Plan, KeepsWhatIsTheWholePicture) {
    for (const Whole& whole : wholes()) {
        SCOPED_TRACE(name_of(whole.effect));
        const Plan plan = plan_of(whole.scene, whole.camera, quick());
        EXPECT_TRUE(plan.on(whole.effect));
        const Radiances kept = render(whole.scene, whole.camera, plan).pixels;
        PlanRequest request = quick({}, {whole.effect});
        // Further bounces and what lies between surfaces are what second order lacks.
        if (whole.effect == Effect::further_bounces || whole.effect == Effect::indirect_occlusion)
            request.method = Method::second_order;
        const Plan less = plan_of(whole.scene, whole.camera, request);
        EXPECT_FALSE(less.on(whole.effect));
        const Radiances left = render(whole.scene, whole.camera, less).pixels;
        const Radiances truth = test::traced(whole.scene, whole.camera, 256);
        const double level = std::max(mean(truth), mean(left));
        EXPECT_GT(level, 0.0);
        EXPECT_LT(distance(kept, truth), whole.error * level);
        EXPECT_GT(distance(left, truth), 0.5 * level);
    }
}

}  // namespace
}  // namespace clgi
