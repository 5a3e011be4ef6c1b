// What a request makes of a plan: predictions, no pictures.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/plan.hpp>
#include <cmath>
#include <functional>

#include "device.hpp"
#include "plan/settings.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

TEST(Plan, SaysWhatIsWrongWithAWish) {
    const SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    const auto refused = [&](const std::function<void(PlanRequest&)>& change) {
        PlanRequest request;
        change(request);
        EXPECT_THROW(make_plan(test::device().device, analysis, request), Error);
    };
    refused([](PlanRequest& w) { w.width = 0; });
    refused([](PlanRequest& w) { w.height = 16385; });
    refused([](PlanRequest& w) { w.tolerance = -0.1; });
    refused([](PlanRequest& w) { w.tolerance = NAN; });
    refused([](PlanRequest& w) { w.seconds = 0.0; });
    refused([](PlanRequest& w) { w.error = -1.0; });
    refused([](PlanRequest& w) {
        w.with = {Effect::further_bounces};
        w.without = {Effect::first_bounce};
    });
    refused([](PlanRequest& w) {
        w.with = {Effect::gloss};
        w.without = {Effect::gloss};
    });
}

TEST(Plan, FollowsWishesOfIndirectLight) {
    const cl::Device& device = test::device().device;
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    analysis.surfaces.largest_albedo = 0.0;
    PlanRequest request;
    EXPECT_FALSE(make_plan(device, analysis, request).on(Effect::first_bounce));
    for (const Effect effect :
         {Effect::first_bounce, Effect::further_bounces, Effect::indirect_occlusion}) {
        request.with = {effect};
        const Plan plan = make_plan(device, analysis, request);
        EXPECT_TRUE(plan.on(Effect::first_bounce));
        EXPECT_TRUE(plan.on(Effect::further_bounces));
        EXPECT_TRUE(plan.on(Effect::indirect_occlusion));
    }
    request.with = {Effect::first_bounce};
    request.without = {Effect::further_bounces};
    const Plan once = make_plan(device, analysis, request);
    EXPECT_FALSE(once.on(Effect::further_bounces));
    EXPECT_TRUE(once.on(Effect::indirect_occlusion));
    EXPECT_NE(once.method, Method::antiradiance);  // all bounces come together there
    analysis.proof.surfaces_open = true;
    EXPECT_FALSE(make_plan(device, analysis, request).on(Effect::indirect_occlusion));
    analysis.surfaces.largest_albedo = 0.5;
    request.with = {};
    request.without = {Effect::first_bounce};
    const Plan direct = make_plan(device, analysis, request);
    EXPECT_EQ(direct.method, Method::direct);
    EXPECT_FALSE(direct.on(Effect::further_bounces));
}

// What a request leaves out is not there for what else is decided.
TEST(Plan, DoesNotCountWhatIsLeftOut) {
    const cl::Device& device = test::device().device;
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    PlanRequest request;
    std::vector<Effect> kinds;
    if (analysis.lights.points > 0) kinds.push_back(Effect::point_light);
    if (analysis.lights.spots > 0) kinds.push_back(Effect::spot_light);
    if (analysis.lights.emission) kinds.push_back(Effect::area_light);
    ASSERT_FALSE(kinds.empty());
    request.without = kinds;
    const Plan dark = make_plan(device, analysis, request);
    for (const Effect kind : kinds)
        EXPECT_EQ(dark.effects[static_cast<std::size_t>(kind)].evidence, Evidence::requested);
    for (const Effect effect : {Effect::direct_shadows, Effect::first_bounce}) {
        EXPECT_FALSE(dark.on(effect));
        EXPECT_EQ(dark.effects[static_cast<std::size_t>(effect)].evidence, Evidence::absent);
    }
    // With a lamp left, the sky is not alone.
    analysis.lights = LightAnalysis();
    analysis.lights.environment = true;
    analysis.lights.points = 1;
    analysis.openness = 0.9;
    analysis.surfaces.triangles = 100000;
    request = PlanRequest();
    request.animated = true;
    EXPECT_EQ(make_plan(device, analysis, request).method, Method::second_order);
    request.without = {Effect::point_light};
    EXPECT_EQ(make_plan(device, analysis, request).method, Method::dynamic_transfer);
}

TEST(Plan, CountsDarkLightsThatMayChange) {
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    analysis.lights = LightAnalysis();
    analysis.lights.dark_points = 1;
    analysis.proof.lights_open = true;
    PlanRequest request;
    EXPECT_EQ(make_plan(test::device().device, analysis, request).method, Method::direct);
    request.lights_change = true;
    const Plan plan = make_plan(test::device().device, analysis, request);
    for (const Effect effect : {Effect::point_light, Effect::direct_shadows, Effect::first_bounce})
        EXPECT_TRUE(plan.on(effect)) << name_of(effect);
    EXPECT_NE(plan.method, Method::direct);
}

TEST(Plan, SaysWhatBringsEachEffect) {
    const cl::Device& device = test::device().device;
    const SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    const auto by = [&](Method method, Effect effect) {
        PlanRequest request;
        request.method = method;
        return make_plan(device, analysis, request).effects[static_cast<std::size_t>(effect)].by;
    };
    EXPECT_EQ(by(Method::second_order, Effect::first_bounce), "VPLs");
    EXPECT_EQ(by(Method::second_order, Effect::further_bounces), "nothing");
    EXPECT_EQ(by(Method::light_atlas, Effect::further_bounces), "baked VPLs");
    EXPECT_EQ(by(Method::antiradiance, Effect::indirect_occlusion), "antiradiance");
    EXPECT_EQ(by(Method::light_atlas, Effect::indirect_occlusion), "hemicubes");
    EXPECT_EQ(by(Method::direct, Effect::first_bounce), "nothing");
    EXPECT_EQ(by(Method::direct, Effect::textures), "");  // off

    PlanRequest request;
    request.method = Method::antiradiance;
    request.without = {Effect::indirect_occlusion};
    EXPECT_EQ(make_plan(device, analysis, request).unavoidable,
              std::vector<Effect>{Effect::indirect_occlusion});
    for (const Method able : {Method::second_order, Method::light_atlas}) {
        request.method = able;
        EXPECT_TRUE(make_plan(device, analysis, request).unavoidable.empty());
    }
    request.method = Method::second_order;
    // VPLs are placed through shadow maps.
    request.without = {Effect::direct_shadows};
    EXPECT_EQ(make_plan(device, analysis, request).unavoidable,
              std::vector<Effect>{Effect::direct_shadows});
}

TEST(Plan, KnowsErrorsWhereTheyWereMeasuredAlone) {
    const cl::Device& device = test::device().device;
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    PlanRequest request;
    request.error = 0.5;
    request.without = {Effect::first_bounce};
    Plan plan = make_plan(device, analysis, request);
    EXPECT_EQ(plan.method, Method::direct);
    EXPECT_FALSE(plan.error);  // all indirect light is missing
    EXPECT_FALSE(plan.meets_error);
    analysis.surfaces.textures = true;
    request.without = {Effect::textures};
    EXPECT_FALSE(make_plan(device, analysis, request).error);
    EXPECT_FALSE(make_plan(device, analysis, request).meets_error);
    request.without = {Effect::cutouts};  // of which there are none
    EXPECT_TRUE(make_plan(device, analysis, request).error);
    EXPECT_TRUE(make_plan(device, analysis, request).meets_error);
    request.without.clear();
    analysis.surfaces.largest_albedo = 0.0;  // nothing is lit, so no shadow map is wrong
    plan = make_plan(device, analysis, request);
    EXPECT_FALSE(plan.on(Effect::direct_shadows));
    EXPECT_EQ(plan.error, 0.0);
    analysis.surfaces.largest_albedo = 0.5;
    analysis.proof.surfaces_apart = true;
    plan = make_plan(device, analysis, request);
    ASSERT_TRUE(plan.error);
    EXPECT_GT(*plan.error, 0.0);  // shadow maps err
    analysis.proof.lights_open = true;
    analysis.lights.emission = false;
    plan = make_plan(device, analysis, request);
    ASSERT_TRUE(plan.error);
    EXPECT_EQ(*plan.error, 0.0);
    EXPECT_TRUE(plan.meets_error);
    // The sky's light by a few directions: nobody knows.
    analysis.lights.environment = true;
    request.method = Method::direct;
    EXPECT_FALSE(make_plan(device, analysis, request).error);
}

TEST(Plan, TakesSettingsOfDirectLightFromTheWish) {
    PlanRequest request;
    request.seconds = 10.0;
    const SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    EXPECT_NE(make_plan(test::device().device, analysis, request).picture.emitters.shadow_size,
              300);
    request.shadow_size = 300;
    request.face_size = 70;
    request.area_samples = 5;
    for (const Method method : {Method::second_order, Method::antiradiance, Method::light_atlas,
                                Method::dynamic_transfer}) {
        request.method = method;
        const Plan plan = make_plan(test::device().device, analysis, request);
        for (const EmitterOptions& options :
             {plan.picture.emitters, plan.second_order.emitters, plan.light_atlas.emitters,
              plan.antiradiance.emitters, plan.transfer_view.picture.emitters}) {
            EXPECT_EQ(options.shadow_size, 300);
            EXPECT_EQ(options.face_size, 70);
            EXPECT_EQ(options.area_samples, 5);
        }
    }
}

// The map of a sun over 40 m has three texels for each centimetre that a pixel covers, within
// bounds; of many lights, of a sky by lights, and of frames, the usual ones.
TEST(Plan, HasShadowMapsAsFineAsThePicture) {
    Plan plan;
    for (EffectChoice& effect : plan.effects) effect.on = true;
    plan.analysis.lights.directional = 1;
    Reach reach;
    reach.points = 200;
    reach.sphere.radius = 5.0;
    reach.size = 0.25;
    reach.pixel = 0.05;
    const auto side = [&](Method method = Method::irradiance_cache, double fineness = 1.0) {
        plan.reach = reach;
        set(plan, {method, 32, 300, {}}, fineness);
        EXPECT_EQ(plan.picture.emitters.shadow_size, plan.light_atlas.emitters.shadow_size);
        return plan.picture.emitters.shadow_size;
    };
    const int usual = EmitterOptions().shadow_size;
    EXPECT_EQ(side(), 2560);  // 2400 in steps of 256
    EXPECT_EQ(side(Method::irradiance_cache, 0.5), 1280);
    EXPECT_EQ(plan.picture.emitters.face_size, EmitterOptions().face_size);
    EXPECT_EQ(plan.picture.emitters.area_samples, EmitterOptions().area_samples);
    reach.size = 0.1;
    EXPECT_EQ(side(), 1280);  // of the focus, 20 m
    reach.pixel = 1e-4;
    plan.analysis.lights.spots = 3;
    EXPECT_EQ(side(), 2560);  // five maps of 2^25 pixels in all
    plan.analysis.lights.spots = 0;
    reach.pixel = 0.05;
    reach.size = 0.8;
    reach.power = 0.1;
    EXPECT_EQ(side(), 768);  // a focus as large as the scene is none: 12.5 m, 750 texels
    reach.power = 1.0;
    reach.size = 0.25;
    EXPECT_EQ(side(Method::irradiance_cache, 8), 8 * usual);
    reach.pixel = 0.01;
    EXPECT_EQ(side(), 4096);
    EXPECT_EQ(side(Method::irradiance_cache, 0.5), 2048);
    reach.pixel = 1.0;
    EXPECT_EQ(side(), usual);
    EXPECT_EQ(side(Method::irradiance_cache, 0.5), usual);
    reach.pixel = 0.0;
    EXPECT_EQ(side(), usual);
    reach.pixel = 0.05;
    plan.analysis.lights.environment = true;
    EXPECT_EQ(side(), 2560);  // by hemicubes
    EXPECT_EQ(side(Method::second_order), usual);
    plan.analysis.lights.environment = false;
    EXPECT_EQ(side(Method::second_order), 2560);
    plan.analysis.lights.spots = 4;
    EXPECT_EQ(side(), usual);
    plan.analysis.lights.spots = 3;
    EXPECT_EQ(side(), 2560);
    plan.analysis.lights.directional = 0;
    EXPECT_EQ(side(), usual);
    reach.cone = 20.0;
    EXPECT_EQ(side(), 1280);  // 1200 texels of the widest spot
    plan.analysis.lights.directional = 1;
    EXPECT_EQ(side(), 2560);  // the sun's are more
    reach.cone = 50.0;
    EXPECT_EQ(side(), 2816);  // four maps of 2^25 pixels in all
    reach.cone = 0.0;
    plan.request.animated = true;
    EXPECT_EQ(side(), usual);
    plan.request = {};
    plan.request.lights_change = true;
    EXPECT_EQ(side(), usual);
    plan.request = {};
    plan.request.shadow_size = 300;
    EXPECT_EQ(side(), 300);
}

// Samples make up for coarse maps of a sun: in a short time they are worth more than those.
TEST(Plan, HasCoarserShadowMapsWhereTimeIsShortAndSamplesFollow) {
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    analysis.lights.points = analysis.lights.spots = 0;
    analysis.lights.directional = 1;
    analysis.surfaces.triangles = 300000;
    PlanRequest request;
    request.refined = true;
    const cl::Device& device = test::device().device;
    Plan plan = make_plan(device, analysis, request);
    Reach reach;
    reach.points = 200;
    reach.sphere.radius = 5.0;
    reach.size = 0.25;
    reach.pixel = 0.01;
    plan.reach = reach;
    plan.method = Method::irradiance_cache;
    const auto side = [&](double seconds) {
        return trial_plan(device, plan, seconds).picture.emitters.shadow_size;
    };
    EXPECT_EQ(side(1e-6), 2048);
    EXPECT_GE(side(100.0), 4096);
    plan.request.refined = false;
    EXPECT_EQ(side(1e-6), 4096);
}

// In scenes whose hemicubes take long; elsewhere nobody has measured so few. There surfaces differ
// more among themselves than what lights them, so that as many are met as seen, not three times as
// many.
TEST(Plan, TakesFewRecordsInFinelyModelledScenesUnderASky) {
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    PlanRequest request;
    request.method = Method::irradiance_cache;
    request.seconds = 1e-6;
    const auto records = [&] { return make_plan(test::device().device, analysis, request).cache; };
    EXPECT_EQ(records().seen, 100);
    analysis.lights.environment = true;
    EXPECT_EQ(records().seen, 100);
    EXPECT_EQ(records().met, 300);
    analysis.surfaces.triangles = 300000;
    EXPECT_EQ(records().seen, 66);
    EXPECT_EQ(records().met, 66);
    request.seconds.reset();
    request.error = 0.3;
    EXPECT_GT(records().seen, 100);
}

// VPLs in small places, which take longer than few records there: where lamps shine all around,
// which stand in shades, and with many records.
TEST(Plan, LooksForSmallPlacesInFineScenesWhereLampsAre) {
    SceneAnalysis analysis = scene_analysis(test::furnished_room(3));
    analysis.lights.points = 0;
    analysis.lights.spots = 1;
    analysis.lights.directional = 1;
    PlanRequest request;
    request.method = Method::irradiance_cache;
    request.seconds = 1e-6;
    const int usual = IrradianceCacheOptions().spots;
    const auto spots = [&] {
        return make_plan(test::device().device, analysis, request).cache.spots;
    };
    EXPECT_EQ(spots(), usual);
    analysis.surfaces.triangles = 300000;
    EXPECT_EQ(spots(), 0);
    analysis.lights.points = 1;
    EXPECT_EQ(spots(), usual);
    analysis.lights.points = 0;
    request.seconds = 1000.0;
    EXPECT_EQ(spots(), usual);
}

}  // namespace
}  // namespace clgi
