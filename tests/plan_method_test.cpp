// Which method and settings a plan takes: predictions, no pictures.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/plan/plan.hpp>
#include <cmath>
#include <functional>

#include "device.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

TEST(Plan, SaysWhatIsWrongWithAWish) {
    const SceneFacts facts = scene_facts(test::furnished_room(3));
    const auto refused = [&](const std::function<void(PlanWish&)>& change) {
        PlanWish wish;
        change(wish);
        EXPECT_THROW(make_plan(test::device().device, facts, wish), Error);
    };
    refused([](PlanWish& w) { w.width = 0; });
    refused([](PlanWish& w) { w.height = 16385; });
    refused([](PlanWish& w) { w.tolerance = -0.1; });
    refused([](PlanWish& w) { w.tolerance = NAN; });
    refused([](PlanWish& w) { w.seconds = 0.0; });
    refused([](PlanWish& w) { w.error = -1.0; });
    refused([](PlanWish& w) {
        w.with = {Effect::further_bounces};
        w.without = {Effect::first_bounce};
    });
    refused([](PlanWish& w) {
        w.with = {Effect::gloss};
        w.without = {Effect::gloss};
    });
}

TEST(Plan, FollowsWishesOfIndirectLight) {
    const cl::Device& device = test::device().device;
    SceneFacts facts = scene_facts(test::furnished_room(3));
    facts.surfaces.largest_albedo = 0.0;
    PlanWish wish;
    EXPECT_FALSE(make_plan(device, facts, wish).on(Effect::first_bounce));
    for (const Effect effect :
         {Effect::first_bounce, Effect::further_bounces, Effect::indirect_occlusion}) {
        wish.with = {effect};
        const Plan plan = make_plan(device, facts, wish);
        EXPECT_TRUE(plan.on(Effect::first_bounce));
        EXPECT_TRUE(plan.on(Effect::further_bounces));
        EXPECT_TRUE(plan.on(Effect::indirect_occlusion));
    }
    wish.with = {Effect::first_bounce};
    wish.without = {Effect::further_bounces};
    const Plan once = make_plan(device, facts, wish);
    EXPECT_FALSE(once.on(Effect::further_bounces));
    EXPECT_TRUE(once.on(Effect::indirect_occlusion));
    EXPECT_NE(once.method, Method::antiradiance);  // all bounces come together there
    facts.proof.surfaces_open = true;
    EXPECT_FALSE(make_plan(device, facts, wish).on(Effect::indirect_occlusion));
    facts.surfaces.largest_albedo = 0.5;
    wish.with = {};
    wish.without = {Effect::first_bounce};
    const Plan direct = make_plan(device, facts, wish);
    EXPECT_EQ(direct.method, Method::direct);
    EXPECT_FALSE(direct.on(Effect::further_bounces));
}

// Of every kind of scene: the methods that it is given, and those that it is not.
TEST(Plan, TakesMethodsThatCanDoWhatIsOn) {
    const cl::Device& device = test::device().device;
    const SceneFacts room = scene_facts(test::furnished_room(3));
    const auto method = [&](const std::function<void(SceneFacts&, PlanWish&)>& change) {
        SceneFacts facts = room;
        PlanWish wish;
        wish.seconds = 0.1;
        change(facts, wish);
        return make_plan(device, facts, wish).method;
    };
    EXPECT_EQ(method([](SceneFacts&, PlanWish&) {}), Method::antiradiance);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish& w) {
                  f.surfaces.cutouts = true;
                  w.seconds = 1.0;
              }),
              Method::light_atlas);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish& w) {
                  f.surfaces.double_sided_area = 1.0;
                  w.seconds = 1.0;
              }),
              Method::antiradiance);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish&) { f.surfaces.triangles = 500000; }),
              Method::second_order);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish& w) {
                  f.surfaces.gloss = f.surfaces.glossy_area = 0.5;
                  w.seconds = 10.0;
              }),
              Method::antiradiance);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish& w) {
                  f.surfaces.triangles = 500000;
                  w.animated = true;
                  w.without = {Effect::direct_shadows};  // which second order cannot do without
              }),
              Method::second_order);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish& w) {
                  f.lights = LightFacts();
                  f.lights.environment = true;
                  f.openness = 0.9;
                  w.animated = true;
              }),
              Method::dynamic_transfer);
    EXPECT_NE(method([](SceneFacts& f, PlanWish& w) {
                  f.lights.environment = true;  // beside the lamp
                  f.openness = 0.9;
                  w.animated = true;
              }),
              Method::dynamic_transfer);
    EXPECT_EQ(method([](SceneFacts& f, PlanWish& w) {
                  f.surfaces.cutouts = true;
                  w.seconds = 1e-3;
                  w.without = {Effect::direct_shadows};
              }),
              Method::light_atlas);  // the only one, however slow
    EXPECT_EQ(method([](SceneFacts& f, PlanWish&) { f.surfaces.triangles = 0; }), Method::direct);
    EXPECT_EQ(method([](SceneFacts&, PlanWish& w) { w.without = {Effect::indirect_occlusion}; }),
              Method::light_atlas);
    EXPECT_NE(method([](SceneFacts&, PlanWish& w) { w.without = {Effect::further_bounces}; }),
              Method::antiradiance);
    for (const Method wished : {Method::direct, Method::second_order, Method::light_atlas,
                                Method::antiradiance, Method::dynamic_transfer})
        EXPECT_EQ(method([&](SceneFacts&, PlanWish& w) { w.method = wished; }), wished);
}

// What a wish leaves out is not there for what else is decided.
TEST(Plan, DoesNotCountWhatIsLeftOut) {
    const cl::Device& device = test::device().device;
    SceneFacts facts = scene_facts(test::furnished_room(3));
    PlanWish wish;
    std::vector<Effect> kinds;
    if (facts.lights.points > 0) kinds.push_back(Effect::point_light);
    if (facts.lights.spots > 0) kinds.push_back(Effect::spot_light);
    if (facts.lights.emission) kinds.push_back(Effect::area_light);
    ASSERT_FALSE(kinds.empty());
    wish.without = kinds;
    const Plan dark = make_plan(device, facts, wish);
    for (const Effect kind : kinds)
        EXPECT_EQ(dark.effects[static_cast<std::size_t>(kind)].ground, Ground::wished);
    for (const Effect effect : {Effect::direct_shadows, Effect::first_bounce}) {
        EXPECT_FALSE(dark.on(effect));
        EXPECT_EQ(dark.effects[static_cast<std::size_t>(effect)].ground, Ground::absent);
    }
    // With a lamp left, the sky is not alone.
    facts.lights = LightFacts();
    facts.lights.environment = true;
    facts.lights.points = 1;
    facts.openness = 0.9;
    facts.surfaces.triangles = 100000;
    wish = PlanWish();
    wish.animated = true;
    EXPECT_EQ(make_plan(device, facts, wish).method, Method::second_order);
    wish.without = {Effect::point_light};
    EXPECT_EQ(make_plan(device, facts, wish).method, Method::dynamic_transfer);
}

TEST(Plan, CountsDarkLightsThatMayChange) {
    SceneFacts facts = scene_facts(test::furnished_room(3));
    facts.lights = LightFacts();
    facts.lights.dark_points = 1;
    facts.proof.lights_open = true;
    PlanWish wish;
    EXPECT_EQ(make_plan(test::device().device, facts, wish).method, Method::direct);
    wish.lights_change = true;
    const Plan plan = make_plan(test::device().device, facts, wish);
    for (const Effect effect : {Effect::point_light, Effect::direct_shadows, Effect::first_bounce})
        EXPECT_TRUE(plan.on(effect)) << name_of(effect);
    EXPECT_NE(plan.method, Method::direct);
}

TEST(Plan, SaysWhatBringsEachEffect) {
    const cl::Device& device = test::device().device;
    const SceneFacts facts = scene_facts(test::furnished_room(3));
    const auto by = [&](Method method, Effect effect) {
        PlanWish wish;
        wish.method = method;
        return make_plan(device, facts, wish).effects[static_cast<std::size_t>(effect)].by;
    };
    EXPECT_EQ(by(Method::second_order, Effect::first_bounce), "VPLs");
    EXPECT_EQ(by(Method::second_order, Effect::further_bounces), "nothing");
    EXPECT_EQ(by(Method::light_atlas, Effect::further_bounces), "baked VPLs");
    EXPECT_EQ(by(Method::antiradiance, Effect::indirect_occlusion), "antiradiance");
    EXPECT_EQ(by(Method::light_atlas, Effect::indirect_occlusion), "hemicubes");
    EXPECT_EQ(by(Method::direct, Effect::first_bounce), "nothing");
    EXPECT_EQ(by(Method::direct, Effect::textures), "");  // off

    PlanWish wish;
    wish.method = Method::antiradiance;
    wish.without = {Effect::indirect_occlusion};
    EXPECT_EQ(make_plan(device, facts, wish).unavoidable,
              std::vector<Effect>{Effect::indirect_occlusion});
    for (const Method able : {Method::second_order, Method::light_atlas}) {
        wish.method = able;
        EXPECT_TRUE(make_plan(device, facts, wish).unavoidable.empty());
    }
    wish.method = Method::second_order;
    // VPLs are placed through shadow maps.
    wish.without = {Effect::direct_shadows};
    EXPECT_EQ(make_plan(device, facts, wish).unavoidable,
              std::vector<Effect>{Effect::direct_shadows});
}

TEST(Plan, KnowsErrorsWhereTheyWereMeasuredAlone) {
    const cl::Device& device = test::device().device;
    SceneFacts facts = scene_facts(test::furnished_room(3));
    PlanWish wish;
    wish.error = 0.5;
    wish.without = {Effect::first_bounce};
    Plan plan = make_plan(device, facts, wish);
    EXPECT_EQ(plan.method, Method::direct);
    EXPECT_FALSE(plan.error);  // all indirect light is missing
    EXPECT_FALSE(plan.meets_error);
    wish.without.clear();
    facts.surfaces.largest_albedo = 0.0;
    plan = make_plan(device, facts, wish);
    ASSERT_TRUE(plan.error);
    EXPECT_GT(*plan.error, 0.0);  // shadow maps err
    facts.proof.lights_open = true;
    facts.lights.emission = false;
    plan = make_plan(device, facts, wish);
    ASSERT_TRUE(plan.error);
    EXPECT_EQ(*plan.error, 0.0);
    EXPECT_TRUE(plan.meets_error);
    // The sky's light by a few directions: nobody knows.
    facts.lights.environment = true;
    wish.method = Method::direct;
    EXPECT_FALSE(make_plan(device, facts, wish).error);
}

TEST(Plan, TakesSettingsOfDirectLightFromTheWish) {
    PlanWish wish;
    wish.seconds = 10.0;
    const SceneFacts facts = scene_facts(test::furnished_room(3));
    EXPECT_NE(make_plan(test::device().device, facts, wish).picture.emitters.shadow_size, 300);
    wish.shadow_size = 300;
    wish.face_size = 70;
    wish.area_samples = 5;
    for (const Method method : {Method::second_order, Method::antiradiance, Method::light_atlas,
                                Method::dynamic_transfer}) {
        wish.method = method;
        const Plan plan = make_plan(test::device().device, facts, wish);
        for (const EmitterOptions& options :
             {plan.picture.emitters, plan.second_order.emitters, plan.antiradiance.emitters,
              plan.transfer_view.picture.emitters}) {
            EXPECT_EQ(options.shadow_size, 300);
            EXPECT_EQ(options.face_size, 70);
            EXPECT_EQ(options.area_samples, 5);
        }
    }
}

// Whether by proof or by wish, a light atlas draws no hemicubes then, and costs less.
TEST(Plan, SwitchesTheOcclusionOfLightAtlasesOff) {
    const cl::Device& device = test::device().device;
    SceneFacts facts = scene_facts(test::furnished_room(3));
    PlanWish wish;
    wish.method = Method::light_atlas;
    const Plan hidden = make_plan(device, facts, wish);
    EXPECT_TRUE(hidden.light_atlas.occlusion);
    wish.without = {Effect::indirect_occlusion};
    EXPECT_FALSE(make_plan(device, facts, wish).light_atlas.occlusion);
    wish.without = {};
    facts.proof.surfaces_open = true;
    wish.error = 0.034;  // the settings of which both kinds of scene are known
    const Plan open = make_plan(device, facts, wish);
    EXPECT_FALSE(open.light_atlas.occlusion);
    EXPECT_GT(hidden.effects[static_cast<std::size_t>(Effect::indirect_occlusion)].milliseconds,
              0.0);
}

// Predicted, not measured.
TEST(Plan, TakesTheBestWithinATimeAndTheCheapestWithinAnError) {
    const SceneFacts facts = scene_facts(test::furnished_room(3));
    const cl::Device& device = test::device().device;
    double last_ms = 0.0, last_error = 1e9;
    for (const double seconds : {0.1, 1.0, 10.0, 100.0}) {
        PlanWish wish;
        wish.seconds = seconds;
        const Plan plan = make_plan(device, facts, wish);
        EXPECT_EQ(plan.meets_time, plan.cost.total_ms() <= 1e3 * seconds);
        if (seconds >= 1.0) {
            EXPECT_TRUE(plan.meets_time) << seconds;  // of the accurate ones some take longer
        }
        EXPECT_GE(plan.cost.total_ms(), last_ms);
        ASSERT_TRUE(plan.error);
        EXPECT_LE(*plan.error, last_error);
        last_ms = plan.cost.total_ms();
        last_error = *plan.error;

        PlanWish right;
        right.error = *plan.error;
        const Plan cheap = make_plan(device, facts, right);
        EXPECT_TRUE(cheap.meets_error);
        EXPECT_LE(cheap.cost.total_ms(), plan.cost.total_ms());
        EXPECT_LE(*cheap.error, *plan.error);
    }
    PlanWish wish;
    wish.error = 1e-6;
    EXPECT_FALSE(make_plan(device, facts, wish).meets_error);
    wish.error.reset();
    wish.seconds = 1e-6;
    EXPECT_FALSE(make_plan(device, facts, wish).meets_time);
}

// What is off is off in the settings of the method, and what is on is priced.
TEST(Plan, BringsItsSettingsToTheEffects) {
    const cl::Device& device = test::device().device;
    const SceneFacts facts = scene_facts(test::furnished_room(3));
    const auto plan = [&](Method method, std::vector<Effect> without, bool animated = false) {
        PlanWish wish;
        wish.method = method;
        wish.without = std::move(without);
        wish.animated = animated;
        return make_plan(device, facts, wish);
    };
    const Plan second = plan(Method::second_order, {});
    EXPECT_GT(second.second_order.negative_vpls, 0);
    EXPECT_EQ(second.error_ground, "measured in furnished scenes");
    const Plan convex = plan(Method::second_order, {Effect::indirect_occlusion});
    EXPECT_EQ(convex.second_order.negative_vpls, 0);
    EXPECT_EQ(convex.error_ground, "measured in convex scenes");
    EXPECT_EQ(convex.bound, 0.0);  // a wish is not for the tolerance
    // VPLs are placed through shadow maps, whatever is done with shadows.
    const Plan unshadowed = plan(Method::second_order, {Effect::direct_shadows});
    EXPECT_TRUE(unshadowed.second_order.emitters.shadows);
    EXPECT_FALSE(unshadowed.picture.emitters.shadows);
    EXPECT_FALSE(
        plan(Method::antiradiance, {Effect::direct_shadows}).antiradiance.emitters.shadows);
    EXPECT_EQ(plan(Method::light_atlas, {}).light_atlas.bounces, 0u);
    EXPECT_EQ(plan(Method::light_atlas, {Effect::further_bounces}).light_atlas.bounces, 1u);
    EXPECT_EQ(plan(Method::antiradiance, {Effect::gloss}).antiradiance.least_gloss, 1.0);

    SceneFacts shining = facts;
    shining.lights = LightFacts();
    shining.lights.environment = true;
    shining.surfaces.glossy_area = shining.surfaces.gloss = 0.5;
    PlanWish wish;
    wish.method = Method::dynamic_transfer;
    const Plan sky = make_plan(device, shining, wish);
    EXPECT_TRUE(sky.transfer.shadowed);
    EXPECT_TRUE(sky.transfer.gloss);
    EXPECT_EQ(sky.transfer.bounces, 1);
    wish.without = {Effect::environment_shadows};
    EXPECT_FALSE(make_plan(device, shining, wish).transfer.shadowed);
    wish.method = Method::antiradiance;
    wish.without = {};
    EXPECT_LT(make_plan(device, shining, wish).antiradiance.least_gloss, 1.0);
}

TEST(Plan, PricesWhatIsOn) {
    const cl::Device& device = test::device().device;
    SceneFacts facts = scene_facts(test::furnished_room(3));
    PlanWish wish;
    wish.method = Method::antiradiance;
    const Plan still = make_plan(device, facts, wish);
    for (const Effect effect :
         {Effect::point_light, Effect::direct_shadows, Effect::indirect_occlusion}) {
        const EffectChoice& choice = still.effects[static_cast<std::size_t>(effect)];
        EXPECT_GT(choice.milliseconds, 0.0) << name_of(effect);
        EXPECT_LT(choice.milliseconds, still.cost.total_ms()) << name_of(effect);
    }
    // In an animation the exchange is a part of each picture.
    wish.animated = true;
    const Plan moving = make_plan(device, facts, wish);
    EXPECT_GT(moving.cost.frame_ms, still.cost.frame_ms);
    // Six views or one.
    wish.method = Method::direct;
    wish.seconds = 1e-6;
    facts.lights = LightFacts();
    facts.lights.points = 1;
    const double point = make_plan(device, facts, wish).cost.frame_ms;
    facts.lights.points = 0;
    facts.lights.spots = 1;
    EXPECT_GT(point, make_plan(device, facts, wish).cost.frame_ms);

    // Nothing is proven of lights that change.
    facts.proof.lights_open = true;
    EXPECT_FALSE(make_plan(device, facts, wish).on(Effect::direct_shadows));
    wish.lights_change = true;
    EXPECT_TRUE(make_plan(device, facts, wish).on(Effect::direct_shadows));
}

TEST(Plan, KnowsTheKindOfAScene) {
    SceneFacts facts = scene_facts(test::furnished_room(3));
    const auto ground = [&] {
        PlanWish wish;
        wish.method = Method::second_order;
        return make_plan(test::device().device, facts, wish).error_ground;
    };
    facts.openness = 0.2;
    EXPECT_EQ(ground(), "measured in furnished scenes");
    facts.surfaces.triangles = 30000;
    EXPECT_EQ(ground(), "measured in finely modelled scenes");
    facts.openness = 0.4;
    EXPECT_EQ(ground(), "measured in open scenes");
    facts.proof.surfaces_open = true;
    EXPECT_EQ(ground(), "measured in convex scenes");
}

}  // namespace
}  // namespace clgi
