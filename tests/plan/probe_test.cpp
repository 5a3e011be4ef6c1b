// The probe of a plan against pictures that are drawn here.
// SPDX-License-Identifier: MIT
#include "plan/probe.hpp"

#include <gtest/gtest.h>
#include <algorithm>
#include <cmath>

#include "frames.hpp"
#include "plan/expected_error.hpp"
#include "plan/presets.hpp"
#include "scenes.hpp"
#include "slanted_room.hpp"

namespace clgi {
namespace {

std::vector<double> luminances(const Scene& scene, const Camera& camera, double fineness) {
    SecondOrderOptions options;
    options.width = 80;  // a fourth of the pixels that are asked for
    options.height = 60;
    options.indirect = false;
    const EmitterOptions usual;
    options.emitters.shadow_size = static_cast<int>(usual.shadow_size * fineness);
    options.emitters.face_size = static_cast<int>(usual.face_size * fineness);
    options.emitters.area_samples = static_cast<int>(usual.area_samples * fineness);
    std::vector<double> out;
    for (const glm::vec3& c : test::render(scene, camera, options).radiance)
        out.push_back(0.2126 * double{c.x} + 0.7152 * double{c.y} + 0.0722 * double{c.z});
    return out;
}

// Direct light of a fourth of the usual samples differs from that of a half by sqrt(D). Errors of
// samples go as the root of their number: with s^2 / n of the usual ones, D is 4 s^2 / n + 2 s^2 /
// n at most, and 4 s^2 / n where the finer half is independent of the coarse one's error or better.
// A fourth of D is what the plan takes for that of the usual ones.
TEST(Probe, TakesTheErrorOfDirectLightFromTwoPictures) {
    Scene scene = test::slanted_room();
    scene.materials[0].emission = {0.0f, 0.0f, 0.0f};
    Material lamp;
    lamp.emission = {9.0f, 4.0f, 1.0f};
    const std::uint32_t glows = test::add_material(scene, lamp);
    test::add_quad(
        scene, {glm::dvec3(-0.3, 1.0, -0.3), {0.3, 1.0, -0.3}, {0.3, 1.1, 0.3}, {-0.3, 1.1, 0.3}},
        glows);
    const Camera camera = test::camera_at({0.6, 1.0, 0.6}, {-0.5, 0.6, -0.7});
    Plan plan;
    plan.request.width = 160;
    plan.request.height = 120;
    plan.analysis.surfaces.area = 10.0;
    plan.analysis.surfaces.largest_albedo = 0.5;
    plan.effects[static_cast<std::size_t>(Effect::area_light)].on = true;
    const DeviceScene device = test::on_device(scene);
    const ProbeResult found = probe(test::device().queue, test::programs(), device, camera, plan);
    const std::vector<double> coarse = luminances(scene, camera, 0.25),
                              fine = luminances(scene, camera, 0.5);
    double square = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < coarse.size(); ++i) {
        square += (coarse[i] - fine[i]) * (coarse[i] - fine[i]);
        sum += coarse[i];
    }
    const auto count = static_cast<double>(coarse.size());
    const double wanted = std::sqrt(0.25 * square / count) / (sum / count);
    EXPECT_GT(wanted, 1e-3);
    // The same kernels and the same sums, in another order.
    EXPECT_NEAR(found.direct_error / wanted, 1.0, 1e-9);
    EXPECT_EQ(found.first_bounce, 0.0);  // it is off
}

// Points stand for too much of a lamp that is large beside what the picture reaches: hemicubes see
// it.
TEST(Plan, LightsByLargeLampsAsHemicubesSeeThem) {
    const auto error = [](Method method, double area) {
        Plan plan;
        for (EffectChoice& effect : plan.effects) effect.on = true;
        plan.effects[static_cast<std::size_t>(Effect::environment_light)].on = false;
        plan.analysis.surfaces.largest_albedo = 0.5;
        plan.request.refined = true;
        plan.method = method;
        plan.reach = Reach();
        plan.reach->points = 200;
        plan.reach->sphere.radius = 5.0;
        plan.reach->emissive_area = area;
        const std::vector<Preset>& all = presets();
        const auto found = std::find_if(all.begin(), all.end(), [&](const Preset& preset) {
            return preset.method == method && preset.error[1] > 0.0;
        });
        return expected_error(plan, found->error[static_cast<std::size_t>(kind_of(plan))]).value();
    };
    // A sixteenth as a disc: 0.06 of 5 m across are 4.5 m^2 in all.
    for (const Method method : {Method::light_atlas, Method::antiradiance, Method::second_order}) {
        EXPECT_LT(error(method, 4.0), 0.9);
        EXPECT_GT(error(method, 5.0), 1.0);
    }
    EXPECT_EQ(error(Method::irradiance_cache, 4.0), error(Method::irradiance_cache, 5.0));
}

// The sun over a room: with a roof next to nothing of what it lights is seen, without one much is.
TEST(Plan, GathersWhereLittleOfTheLightArrives) {
    for (const bool roofed : {true, false}) {
        Scene scene = test::plain_scene({0.5f, 0.6f, 0.4f});
        test::add_box(scene, {-0.2, -0.2, -0.2}, {4.2, 0, 5.2}, 1);
        for (const double z : {-0.2, 5.0}) test::add_box(scene, {-0.2, 0, z}, {4.2, 3, z + 0.2}, 1);
        for (const double x : {-0.2, 4.0}) test::add_box(scene, {x, 0, 0}, {x + 0.2, 3, 5}, 1);
        if (roofed) {  // but for a slit of 2 cm
            test::add_box(scene, {-0.2, 3, -0.2}, {2, 3.1, 5.2}, 1);
            test::add_box(scene, {2.02, 3, -0.2}, {4.2, 3.1, 5.2}, 1);
        }
        scene.lights = {test::directional_light({0.0f, -1.0f, 0.2f}, 1e4f)};
        const Camera camera = test::camera_at({0.5, 1.5, 4.5}, {1.0, 1.6, 0}, 0.8f);
        PlanRequest request;
        request.width = 64;
        request.height = 48;
        const Plan plan = make_plan(test::device().queue, test::programs(), scene, camera, request);
        ASSERT_TRUE(plan.probe);
        EXPECT_EQ(plan.probe->reflected > 10.0, roofed);
        EXPECT_EQ(plan.why == "little of the light reaches the picture", roofed) << plan.why;
        if (roofed) {
            EXPECT_EQ(plan.method, Method::irradiance_cache);
        }
    }
}

}  // namespace
}  // namespace clgi
