// What a wish makes of a plan: predictions, no pictures.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/plan.hpp>
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
    facts.surfaces.textures = true;
    wish.without = {Effect::textures};
    EXPECT_FALSE(make_plan(device, facts, wish).error);
    EXPECT_FALSE(make_plan(device, facts, wish).meets_error);
    wish.without = {Effect::cutouts};  // of which there are none
    EXPECT_TRUE(make_plan(device, facts, wish).error);
    EXPECT_TRUE(make_plan(device, facts, wish).meets_error);
    wish.without.clear();
    facts.surfaces.largest_albedo = 0.0;  // nothing is lit, so no shadow map is wrong
    plan = make_plan(device, facts, wish);
    EXPECT_FALSE(plan.on(Effect::direct_shadows));
    EXPECT_EQ(plan.error, 0.0);
    facts.surfaces.largest_albedo = 0.5;
    facts.proof.surfaces_apart = true;
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
             {plan.picture.emitters, plan.second_order.emitters, plan.light_atlas.emitters,
              plan.antiradiance.emitters, plan.transfer_view.picture.emitters}) {
            EXPECT_EQ(options.shadow_size, 300);
            EXPECT_EQ(options.face_size, 70);
            EXPECT_EQ(options.area_samples, 5);
        }
    }
}

}  // namespace
}  // namespace clgi
