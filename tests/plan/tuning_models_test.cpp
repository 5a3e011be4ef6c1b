// Settings from a result: how results are written, the fronts and the models.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/procedural.hpp>
#include <cmath>

#include "device.hpp"
#include "plan/tuning_models.hpp"
#include "program/duration.hpp"
#include "program/percent.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

constexpr MainLight main_lights[] = {MainLight::spot, MainLight::directional, MainLight::point,
                                     MainLight::area};
constexpr int fewest = SecondOrderTuning::fewest_vpls, most = SecondOrderTuning::most_vpls;

TEST(Duration, TakesMillisecondsAndSeconds) {
    EXPECT_DOUBLE_EQ(program::parse_milliseconds("render", "--time-budget", "33ms"), 33.0);
    EXPECT_DOUBLE_EQ(program::parse_milliseconds("render", "--time-budget", "0.5s"), 500.0);
    EXPECT_DOUBLE_EQ(program::parse_milliseconds("render", "--time-budget", "1e-1s"), 100.0);
}

TEST(Duration, RefusesEverythingElse) {
    for (const char* text :
         {"", "33", "0ms", "-1ms", "ms", "fast", "33 ms", "33msx", "3m", "nanms", "infs", "1e12s"})
        EXPECT_THROW(program::parse_milliseconds("render", "--time-budget", text), Error) << text;
}

TEST(Percent, RefusesWhatIsNoShare) {
    EXPECT_DOUBLE_EQ(program::parse_percent("render", "--target-error", "2%"), 0.02);
    EXPECT_DOUBLE_EQ(program::parse_percent("render", "--target-error", "0.02"), 0.02);
    for (const char* text : {"", "0", "0%", "-2%", "two", "2%%", "nan", "inf"})
        EXPECT_THROW(program::parse_percent("render", "--target-error", text), Error) << text;
}

TEST(Front, RisesFromCoarseToFine) {
    for (const MainLight light : main_lights) {
        const SecondOrderFront& front = second_order_front(light);
        EXPECT_EQ(front.refinements.front().from_vpls, fewest);
        EXPECT_GT(front.negative_share, 0.0);
        for (std::size_t i = 1; i < front.refinements.size(); ++i) {
            const Refinement &before = front.refinements[i - 1], &finer = front.refinements[i];
            EXPECT_LE(finer.step, before.step);
            EXPECT_LE(finer.threshold, before.threshold);
            EXPECT_GT(finer.from_vpls, before.from_vpls);
        }
    }
}

TEST(Front, KnowsScenesByTheirLights) {
    const auto light_of = [](const Scene& scene) { return main_light(test::on_device(scene)); };
    EXPECT_EQ(light_of(cornell({.light = LightSource::spot})), MainLight::spot);
    EXPECT_EQ(light_of(cornell({.light = LightSource::point})), MainLight::point);
    EXPECT_EQ(light_of(cornell({.light = LightSource::area})), MainLight::area);
    Scene sunlit = test::plain_scene();
    test::add_floor(sunlit, 1.0);
    sunlit.lights = {test::directional_light({0, -1, 0})};
    EXPECT_EQ(light_of(sunlit), MainLight::directional);
    sunlit.lights.clear();
    sunlit.environment.emplace();
    EXPECT_EQ(light_of(sunlit), MainLight::directional);
}

TEST(WithinTime, FollowsTheOrderOfTimes) {
    for (const MainLight light : main_lights) {
        const SecondOrderFront& front = second_order_front(light);
        FrameTimeModel time{5.0, {}};
        for (std::size_t i = 0; i < front.refinements.size(); ++i)
            time.ms_per_vpl.push_back(0.01 * std::pow(1.7, i));
        FrontPoint before;
        for (double ms = 1.0; ms < 1e6; ms *= 1.2) {
            const FrontPoint point = within_time(front, time, ms);
            EXPECT_GE(point.refinement, before.refinement);
            EXPECT_GE(predicted_ms(time, point), predicted_ms(time, before) * (1.0 - 1e-12));
            EXPECT_LE(point.vpls, most);
            // One VPL less would leave a VPL's time over.
            const bool cheapest = point.vpls == fewest;
            if (!cheapest && point.vpls < most) {
                EXPECT_NEAR(predicted_ms(time, point), ms,
                            1.001 * time.ms_per_vpl[point.refinement]);
            }
            before = point;
        }
        EXPECT_EQ(before.vpls, most);
        EXPECT_EQ(before.refinement, front.refinements.size() - 1);
    }
}

TEST(WithinError, TakesTheCheapestThatMeetsIt) {
    const FrameTimeModel time{1.0, {0.01, 0.1}};
    const FrameErrorModel errors{{{100, 0.1}, {400, 0.05}, {1600, 0.025}}, {0.0016, 0.0}};
    // 0.1^2 + 0.04^2 and the like at the first preset, sampling alone at the second.
    const auto few = within_error(time, errors, 0.11);
    ASSERT_TRUE(few);
    EXPECT_EQ(few->refinement, 0u);
    EXPECT_EQ(few->vpls, 100);
    const auto fine = within_error(time, errors, 0.03);
    ASSERT_TRUE(fine);
    EXPECT_EQ(fine->refinement, 1u);
    EXPECT_EQ(fine->vpls, 1600);
    EXPECT_FALSE(within_error(time, errors, 0.02));
    EXPECT_EQ(most_accurate(time, errors).refinement, 1u);
}

}  // namespace
}  // namespace clgi
