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
    EXPECT_EQ(method([](SceneFacts& f, PlanWish&) { f.surfaces.triangles = 0; }), Method::direct);
    EXPECT_EQ(method([](SceneFacts&, PlanWish& w) { w.without = {Effect::indirect_occlusion}; }),
              Method::second_order);
    for (const Method wished : {Method::direct, Method::second_order, Method::light_atlas,
                                Method::antiradiance, Method::dynamic_transfer})
        EXPECT_EQ(method([&](SceneFacts&, PlanWish& w) { w.method = wished; }), wished);
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

}  // namespace
}  // namespace clgi
