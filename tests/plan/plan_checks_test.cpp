// The plans that follow a check of a picture.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/plan.hpp>
#include <limits>

#include "device.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

Plan plan_of(std::optional<double> error, std::optional<double> seconds) {
    PlanRequest request;
    request.error = error;
    request.seconds = seconds;
    return make_plan(test::device().device, scene_analysis(test::furnished_room(3)), request);
}

std::optional<Plan> next(const Plan& plan, double measured) {
    return next_plan(test::device().device, plan, measured);
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
    EXPECT_EQ(second->checks[0].measured, measured);
    EXPECT_EQ(second->checks[0].predicted_ms, first.cost.total_ms());
    EXPECT_TRUE(second->method != first.method ||
                second->cost.total_ms() >= 1.2 * first.cost.total_ms());
    ASSERT_TRUE(second->error);
    EXPECT_LE(*second->error, 0.1);
    EXPECT_TRUE(second->meets_error);
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
    EXPECT_THROW(next(first, -1.0), Error);
    EXPECT_THROW(next(first, std::numeric_limits<double>::quiet_NaN()), Error);
}

}  // namespace
}  // namespace clgi
