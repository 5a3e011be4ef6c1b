// The plans that follow a check of a picture.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <clgi/plan.hpp>
#include <cmath>
#include <limits>

#include "device.hpp"
#include "plan/expected_error.hpp"
#include "plan/settings.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

Plan plan_of(std::optional<double> error, std::optional<double> seconds,
             std::optional<Method> method = std::nullopt) {
    PlanRequest request;
    request.method = method;
    request.error = error;
    request.seconds = seconds;
    return make_plan(test::device().device, scene_analysis(test::furnished_room(3)), request);
}

std::optional<Plan> next(const Plan& plan, double measured) {
    return next_plan(test::device().device, plan, {measured, std::nullopt});
}

TEST(PlanChecks, GoOnToSettingsThatTakeLonger) {
    const Plan first = plan_of(0.1, std::nullopt);
    ASSERT_TRUE(first.error);
    // Twice the error that was expected, so that settings of twice the accuracy are wanted.
    const double measured = 2.0 * *first.error;
    const std::optional<Plan> second = next(first, measured);
    ASSERT_TRUE(second);
    ASSERT_EQ(second->checks.size(), 1u);
    EXPECT_EQ(second->checks[0].method, first.method);
    EXPECT_EQ(second->checks[0].expected, first.error);
    EXPECT_EQ(second->checks[0].found.error, measured);
    EXPECT_EQ(second->checks[0].predicted_ms, first.cost.total_ms());
    EXPECT_TRUE(second->method != first.method ||
                second->cost.total_ms() >= 1.2 * first.cost.total_ms());
    ASSERT_TRUE(second->error);
    EXPECT_LE(*second->error, 0.1);
    EXPECT_TRUE(second->meets_error);
}

// A little above what is asked for, or below it but not surely: what follows is expected to err
// clearly less than was measured.
TEST(PlanChecks, AimBelowWhatWasMeasured) {
    const Plan first = plan_of(0.1, std::nullopt);
    for (const double measured : {0.105, 0.09, 0.085}) {
        const std::optional<Plan> second = next(first, measured);
        ASSERT_TRUE(second) << measured;
        EXPECT_LE(*second->error, 0.7 * measured + 1e-9);
        EXPECT_EQ(second->request.error, 0.1);
        EXPECT_TRUE(second->meets_error);
    }
}

// Samples take most of the error of direct light away, and settings are chosen for the rest.
TEST(PlanChecks, LeaveDirectLightToSamples) {
    Plan plan = plan_of(0.1, std::nullopt, Method::direct);
    EffectChoice& first = plan.effects[static_cast<std::size_t>(Effect::first_bounce)];
    first.on = false;
    first.bound = 0.0;
    plan.probe = ProbeResult{};
    plan.probe->direct_error = 0.4;
    const double usual = expected_error(plan, 0.0).value();
    plan.request.refined = true;
    EXPECT_NEAR(expected_error(plan, 0.0).value(), 0.3 * usual, 1e-9);
    EXPECT_NEAR(usual, 0.4 / std::sqrt(fineness_of(plan)), 1e-9);
}

// A sun's map of four times the side leaves half of a picture's error, and a fourth of what samples
// leave; beside a lamp, half of that too.
TEST(PlanChecks, LeaveEdgesOfSunsToFineMaps) {
    Plan plan = plan_of(0.1, std::nullopt, Method::direct);
    const auto set = [&](Effect effect, bool on) {
        plan.effects[static_cast<std::size_t>(effect)].on = on;
    };
    for (const Effect lights : {Effect::point_light, Effect::spot_light, Effect::area_light,
                                Effect::environment_light, Effect::first_bounce})
        set(lights, false);
    plan.effects[static_cast<std::size_t>(Effect::first_bounce)].bound = 0.0;
    set(Effect::directional_light, true);
    set(Effect::direct_shadows, true);
    plan.probe = ProbeResult{};
    plan.probe->direct_error = 0.4;
    const auto error = [&](int fineness) {
        plan.picture.emitters = EmitterOptions();
        plan.picture.emitters.shadow_size *= fineness;
        plan.picture.emitters.face_size *= fineness;
        return expected_error(plan, 0.0).value();
    };
    EXPECT_NEAR(error(4), 0.5 * error(1), 1e-9);
    plan.request.refined = true;
    EXPECT_NEAR(error(4), 0.25 * error(1), 1e-9);
    set(Effect::point_light, true);
    EXPECT_NEAR(error(4), 0.5 * error(1), 1e-9);
}

// A method that errs a thousand times more than expected is not the next one, if others suit.
TEST(PlanChecks, GoOnToAnotherMethod) {
    const Plan first = plan_of(0.1, std::nullopt);
    const std::optional<Plan> second = next(first, 1000.0 * *first.error);
    ASSERT_TRUE(second);
    EXPECT_NE(second->method, first.method);
    EXPECT_LE(*second->error, 0.1);
    // What a method was found to err by counts for all of its settings.
    const std::optional<Plan> third = next(*second, 1000.0 * *second->error);
    ASSERT_TRUE(third);
    EXPECT_EQ(third->checks.size(), 2u);
    EXPECT_NE(third->method, first.method);
    EXPECT_NE(third->method, second->method);
}

// Where each picture errs three times as much as expected of it by then, that adds up.
TEST(PlanChecks, CountErrorsByWhatWasExpectedAtFirst) {
    const Plan first = plan_of(0.2, std::nullopt, Method::irradiance_cache);
    const double usual = *first.error;
    const std::optional<Plan> second = next(first, 3.0 * usual);
    ASSERT_TRUE(second);
    const std::optional<Plan> third = next(*second, 3.0 * *second->error);
    ASSERT_TRUE(third);
    EXPECT_NEAR(*third->checks[1].expected, *second->error / 3.0, 1e-9);
    EXPECT_NEAR(*third->checks[0].expected, usual, 1e-12);
    const std::optional<Plan> fourth = next(*third, 9.0 * *third->error);
    EXPECT_NEAR(fourth ? *fourth->checks[2].expected : *third->error / 9.0, *third->error / 9.0,
                1e-9);
}

// Doubt that is larger than what scenes of the kind had is what indirect light is expected to err
// by, in that picture and, for settings of all methods, as many times as much; smaller doubt says
// nothing, and a check says more.
TEST(PlanDoubt, IsWhatIndirectLightErrsBy) {
    Plan plan = plan_of(std::nullopt, 0.05, Method::irradiance_cache);
    plan.probe = ProbeResult{};
    plan.probe->first_bounce = 0.5;
    plan.probe->direct_error = 0.06;
    const double share = 0.75;  // half as much again as one bounce
    plan.error = expected_error(plan, *plan.indirect_error);
    const double known = share * *plan.indirect_error;
    const double direct = std::sqrt(*plan.error * *plan.error - known * known);
    ASSERT_GT(direct, 0.001);
    const auto of = [&](double doubt) {
        return error_of(plan, {std::nullopt, std::nullopt, doubt}).value();
    };
    EXPECT_NEAR(of(3.0 * known), std::hypot(3.0 * known, direct), 1e-6);
    EXPECT_NEAR(of(0.9 * known), *plan.error, 1e-12);
    EXPECT_EQ(error_of(plan, {0.5, std::nullopt, 3.0 * known}), 0.5);
    EXPECT_EQ(error_of(plan, {}), plan.error);

    const cl::Device& device = test::device().device;
    for (const std::optional<Method> method : {plan.request.method, std::optional<Method>()}) {
        plan.request.method = method;
        const auto after = [&](std::optional<double> error, double doubt) {
            return next_plan(device, plan, {error, std::nullopt, doubt}, 2.0).value();
        };
        const Plan next = after(std::nullopt, 3.0 * known);
        EXPECT_NEAR(doubt_factor(next), 3.0, 1e-9);
        EXPECT_NEAR(*next.error, expected_error(next, *next.indirect_error).value(), 1e-9);
        EXPECT_GT(*next.error, 2.0 * share * *next.indirect_error);
        EXPECT_NE(next.error_evidence.find("records of a picture differ"), std::string::npos);
        EXPECT_EQ(doubt_factor(after(std::nullopt, 0.9 * known)), 1.0);
        EXPECT_EQ(doubt_factor(after(2.0 * *plan.error, 3.0 * known)), 1.0);
    }
    // After a check doubt adds nothing; what is expected of a kind stays that.
    plan.request.method = Method::irradiance_cache;
    const Plan doubted =
        next_plan(device, plan, {std::nullopt, std::nullopt, 3.0 * known}, 2.0).value();
    const Plan checked = next_plan(device, doubted, {0.5, std::nullopt, std::nullopt}, 4.0).value();
    Plan by_kind = doubted;
    by_kind.checks.clear();
    EXPECT_NEAR(*checked.checks[1].expected,
                expected_error(by_kind, *doubted.indirect_error).value(), 1e-9);
    EXPECT_EQ(doubt_factor(checked), 1.0);
    EXPECT_NEAR(error_of(checked, {std::nullopt, std::nullopt, 1.0}).value(), *checked.error, 1e-9);
    // One sample has all of direct light's error, many a part.
    plan.request.refined = true;
    EXPECT_LT(of(3.0 * known), std::hypot(3.0 * known, 0.5 * direct));
    plan.request.refined = false;
    const double none = std::numeric_limits<double>::quiet_NaN();
    for (const double wrong : {-0.1, none}) {
        EXPECT_THROW(of(wrong), Error);
        EXPECT_THROW(next_plan(device, plan, {std::nullopt, std::nullopt, wrong}), Error);
    }
}

// Without effects that were left out by request no error is expected; a method that is not finer
// must not follow then.
TEST(PlanPace, KeepsToTheMethodWhereNoErrorIsExpected) {
    const cl::Device& device = test::device().device;
    PlanRequest request;
    request.seconds = 3.0;
    request.without = {Effect::further_bounces};
    const Plan plan = make_plan(device, scene_analysis(test::furnished_room(3)), request);
    ASSERT_FALSE(plan.error);
    for (const double seconds : {0.01, 0.1, 1.0, 10.0})
        for (const double share : {0.02, 0.3, 1.0}) {
            const Plan trial = trial_plan(device, plan, share);
            const std::optional<Plan> rest =
                next_plan(device, trial, {std::nullopt, trial.cost.total_ms()}, seconds);
            EXPECT_EQ(rest.value_or(trial).method, trial.method);
        }
}

TEST(PlanChecks, EndWhereNothingIsExpectedToErrLess) {
    Plan plan = plan_of(1e-6, std::nullopt);
    double seconds = 0.0;
    int plans = 0;
    for (std::optional<Plan> more = next(plan, *plan.error); more; more = next(plan, *plan.error)) {
        EXPECT_LT(*more->error, *plan.error);
        EXPECT_LE(more->cost.total_ms(), 1e4);
        plan = *more;
        seconds += 1e-3 * plan.cost.total_ms();
        ASSERT_LT(++plans, 100);
    }
    EXPECT_FALSE(next(plan, 1e-9));
}

TEST(PlanChecks, KeepToTheTimeThatWasRequested) {
    const Plan first = plan_of(std::nullopt, 0.1);
    for (std::optional<Plan> more = next(first, *first.error); more;
         more = next(*more, *more->error)) {
        EXPECT_LE(more->cost.total_ms(), 100.0);
        ASSERT_LT(more->checks.size(), 100u);
    }
    // Another method would err less, in more time than is left.
    EXPECT_FALSE(
        next_plan(test::device().device, first, {100.0 * *first.error, std::nullopt}, 1e-6));
    EXPECT_THROW(next(first, -1.0), Error);
    EXPECT_THROW(next(first, std::numeric_limits<double>::quiet_NaN()), Error);
}

// A machine that took three times as long as predicted has a third of the time, so to speak.
TEST(PlanPace, IsThatOfThePictureBefore) {
    const cl::Device& device = test::device().device;
    if (!(device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU))
        GTEST_SKIP() << "the limits of time are drawn for CPUs";
    const Plan first = plan_of(std::nullopt, 3.0, Method::irradiance_cache);
    const Plan trial = trial_plan(device, first, 0.05);
    EXPECT_EQ(trial.method, first.method);
    EXPECT_EQ(trial.request.method, first.request.method);
    EXPECT_EQ(trial.request.seconds, 3.0);
    EXPECT_EQ(trial.why, first.why);
    EXPECT_LT(trial.cost.total_ms(), first.cost.total_ms());
    const auto after = [&](double slower, double seconds) {
        return next_plan(device, trial, {std::nullopt, slower * trial.cost.total_ms()}, seconds);
    };
    const std::optional<Plan> same = after(1.0, 3.0), slow = after(3.0, 3.0),
                              third = after(1.0, 1.0);
    ASSERT_TRUE(same && slow && third);
    EXPECT_EQ(same->method, first.method);
    EXPECT_NEAR(same->cost.total_ms(), first.cost.total_ms(), 1e-6);
    EXPECT_EQ(slow->method, third->method);
    EXPECT_NEAR(slow->cost.total_ms(), 3.0 * third->cost.total_ms(), 1e-6 * slow->cost.total_ms());
    EXPECT_LE(slow->cost.total_ms(), 3000.0);
    EXPECT_EQ(slow->request.seconds, 3.0);
    ASSERT_EQ(slow->checks.size(), 1u);
    EXPECT_NEAR(slow->checks[0].predicted_ms, trial.cost.total_ms(), 1e-9);
    // The next one is told from what was predicted at first: half of that pace is 1.5.
    const std::optional<Plan> rest =
        next_plan(device, *slow, {std::nullopt, 0.5 * slow->cost.total_ms()}, 30.0);
    ASSERT_TRUE(rest);
    EXPECT_NEAR(rest->checks[1].predicted_ms, slow->cost.total_ms() / 3.0, 1e-6);
    const std::optional<Plan> at_once = after(1.5, 30.0);
    ASSERT_TRUE(at_once);
    EXPECT_NEAR(rest->cost.total_ms(), at_once->cost.total_ms(), 1e-6 * rest->cost.total_ms());
    EXPECT_FALSE(after(3.0, 1e-3)) << "nothing is left";
    EXPECT_THROW(after(-1.0, 1.0), Error);
    EXPECT_THROW(after(1.0, std::numeric_limits<double>::quiet_NaN()), Error);
    EXPECT_THROW(trial_plan(device, first, 0.0), Error);
}

// That one method was quick says nothing of another, that it was slow does.
TEST(PlanPace, OfAnotherMethodIsNeverQuicker) {
    const cl::Device& device = test::device().device;
    EXPECT_FALSE(trial_plan(device, plan_of(std::nullopt, 3.0), 0.05).request.method);
    const Plan quick = plan_of(std::nullopt, 0.02), usual = plan_of(std::nullopt, 3.0);
    ASSERT_NE(quick.method, usual.method);
    const double predicted = quick.cost.total_ms();
    const auto after = [&](double slower) {
        return next_plan(device, quick, {std::nullopt, slower * predicted}, 3.0);
    };
    const std::optional<Plan> lucky = after(0.01), slow = after(2.0);
    ASSERT_TRUE(lucky && slow);
    ASSERT_EQ(lucky->method, usual.method);
    EXPECT_NEAR(lucky->cost.total_ms(), usual.cost.total_ms(), 1e-6);
    EXPECT_LE(slow->cost.total_ms(), 3000.0);
    const std::optional<Plan> half = next_plan(device, quick, {std::nullopt, predicted}, 1.5);
    ASSERT_TRUE(half);
    EXPECT_NEAR(slow->cost.total_ms(), 2.0 * half->cost.total_ms(), 1e-6 * slow->cost.total_ms());
}

}  // namespace
}  // namespace clgi
