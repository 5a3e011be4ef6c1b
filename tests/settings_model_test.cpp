// Settings from a result: the fronts, the models, and the estimate against the true error.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/procedural.hpp>
#include <cmath>

#include "cli/duration.hpp"
#include "cli/percent.hpp"
#include "device.hpp"
#include "report/ask.hpp"
#include "report/preview.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using report::Choice;
using report::CostModel;
using report::ErrorModel;
using report::SceneClass;

constexpr SceneClass classes[] = {SceneClass::spot, SceneClass::directional, SceneClass::point,
                                  SceneClass::area};

TEST(Duration, TakesMillisecondsAndSeconds) {
    EXPECT_DOUBLE_EQ(cli::parse_milliseconds("render", "--time-budget", "33ms"), 33.0);
    EXPECT_DOUBLE_EQ(cli::parse_milliseconds("render", "--time-budget", "0.5s"), 500.0);
    EXPECT_DOUBLE_EQ(cli::parse_milliseconds("render", "--time-budget", "1e-1s"), 100.0);
}

TEST(Duration, RefusesEverythingElse) {
    for (const char* text :
         {"", "33", "0ms", "-1ms", "ms", "fast", "33 ms", "33msx", "3m", "nanms", "infs", "1e12s"})
        EXPECT_THROW(cli::parse_milliseconds("render", "--time-budget", text), Error) << text;
}

TEST(Percent, RefusesWhatIsNoShare) {
    EXPECT_DOUBLE_EQ(cli::parse_percent("render", "--target-error", "2%"), 0.02);
    EXPECT_DOUBLE_EQ(cli::parse_percent("render", "--target-error", "0.02"), 0.02);
    for (const char* text : {"", "0", "0%", "-2%", "two", "2%%", "nan", "inf"})
        EXPECT_THROW(cli::parse_percent("render", "--target-error", text), Error) << text;
}

TEST(Front, RisesFromCoarseToFine) {
    for (const SceneClass scene_class : classes) {
        const report::Front& front = report::second_order_front(scene_class);
        EXPECT_EQ(front.rungs.front().from_lights, report::fewest_lights);
        EXPECT_GT(front.negative_share, 0.0);
        for (std::size_t i = 1; i < front.rungs.size(); ++i) {
            const report::Rung &before = front.rungs[i - 1], &rung = front.rungs[i];
            EXPECT_LE(rung.step, before.step);
            EXPECT_LE(rung.threshold, before.threshold);
            EXPECT_GT(rung.from_lights, before.from_lights);
        }
    }
}

TEST(Front, KnowsScenesByTheirLamps) {
    const auto class_of = [](const Scene& scene) {
        return report::classify(test::on_device(scene));
    };
    EXPECT_EQ(class_of(cornell({.light = LightSource::spot})), SceneClass::spot);
    EXPECT_EQ(class_of(cornell({.light = LightSource::point})), SceneClass::point);
    EXPECT_EQ(class_of(cornell({.light = LightSource::area})), SceneClass::area);
    Scene sunlit = test::plain_scene();
    test::add_floor(sunlit, 1.0);
    sunlit.lights = {test::directional_light({0, -1, 0})};
    EXPECT_EQ(class_of(sunlit), SceneClass::directional);
    sunlit.lights.clear();
    sunlit.environment.emplace();
    EXPECT_EQ(class_of(sunlit), SceneClass::directional);
}

TEST(WithinBudget, FollowsTheOrderOfBudgets) {
    for (const SceneClass scene_class : classes) {
        const report::Front& front = report::second_order_front(scene_class);
        CostModel cost{5.0, {}};
        for (std::size_t rung = 0; rung < front.rungs.size(); ++rung)
            cost.ms_per_light.push_back(0.01 * std::pow(1.7, rung));
        Choice before;
        for (double budget = 1.0; budget < 1e6; budget *= 1.2) {
            const Choice choice = report::within_budget(front, cost, budget);
            EXPECT_GE(choice.rung, before.rung);
            EXPECT_GE(report::predicted_ms(cost, choice),
                      report::predicted_ms(cost, before) * (1.0 - 1e-12));
            EXPECT_LE(choice.lights, report::most_lights);
            // One light less would leave a light's time over.
            const bool cheapest = choice.lights == report::fewest_lights;
            if (!cheapest && choice.lights < report::most_lights) {
                EXPECT_NEAR(report::predicted_ms(cost, choice), budget,
                            1.001 * cost.ms_per_light[choice.rung]);
            }
            before = choice;
        }
        EXPECT_EQ(before.lights, report::most_lights);
        EXPECT_EQ(before.rung, front.rungs.size() - 1);
    }
}

TEST(WithinError, TakesTheCheapestThatMeetsIt) {
    const CostModel cost{1.0, {0.01, 0.1}};
    const ErrorModel errors{{{100, 0.1}, {400, 0.05}, {1600, 0.025}}, {0.0016, 0.0}};
    // 0.1^2 + 0.04^2 and the like at the first rung, sampling alone at the second.
    const auto few = report::within_error(cost, errors, 0.11);
    ASSERT_TRUE(few);
    EXPECT_EQ(few->rung, 0u);
    EXPECT_EQ(few->lights, 100);
    const auto fine = report::within_error(cost, errors, 0.03);
    ASSERT_TRUE(fine);
    EXPECT_EQ(fine->rung, 1u);
    EXPECT_EQ(fine->lights, 1600);
    EXPECT_FALSE(report::within_error(cost, errors, 0.02));
    EXPECT_EQ(report::most_accurate(cost, errors).rung, 1u);
}

std::vector<double> luminance(SecondOrderSolver& solver, const Camera& camera) {
    solver.render(camera);
    const io::Image picture = report::radiance_picture(test::device().queue, solver);
    std::vector<double> out(picture.channels[0].values.size());
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = 0.2126 * picture.channels[0].values[i] + 0.7152 * picture.channels[1].values[i] +
                 0.0722 * picture.channels[2].values[i];
    return out;
}

// The converged picture by other replicates than the probe's own, the true error by other code.
double true_error(SecondOrderSolver& solver, const Camera& camera) {
    const std::vector<double> delivered = luminance(solver, camera);
    SecondOrderOptions options = solver.options();
    options.emitters.vpls = report::converged_lights;
    options.negative_vpls = 4096;
    options.low_resolution_step = 1;
    options.emitters.area_samples = 64;
    std::vector<double> truth(delivered.size());
    constexpr int replicates = 3;
    for (int k = 1; k <= replicates; ++k) {
        options.emitters.replicate = 1000 + k;
        solver.reconfigure(options);
        const std::vector<double> one = luminance(solver, camera);
        for (std::size_t i = 0; i < truth.size(); ++i) truth[i] += one[i] / replicates;
    }
    double square = 0.0, level = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        square += (delivered[i] - truth[i]) * (delivered[i] - truth[i]);
        level += truth[i];
    }
    const auto pixels = static_cast<double>(truth.size());
    return std::sqrt(square / pixels) / (level / pixels);
}

SecondOrderOptions small_picture() {
    SecondOrderOptions options;
    options.width = 64;
    options.height = 48;
    options.emitters.shadow_size = 128;
    options.emitters.face_size = 64;
    return options;
}

class AskForEvery : public testing::TestWithParam<LightSource> {};

TEST_P(AskForEvery, ATargetErrorIsNotExceeded) {
    const Scene scene = cornell({.light = GetParam()});
    const DeviceScene device = test::on_device(scene);
    const Camera& camera = scene.cameras[0];
    SecondOrderSolver solver(test::programs(), test::device().queue, device, small_picture());
    constexpr double target = 0.1;
    const report::Answer answer =
        report::ask(test::device().queue, device, solver, camera, {.target_error = target});
    EXPECT_TRUE(answer.target_met);
    ASSERT_TRUE(answer.estimated_error);
    EXPECT_LE(*answer.estimated_error, target);
    EXPECT_EQ(solver.options().emitters.vpls, answer.settings.lights);
    EXPECT_EQ(solver.options().emitters.replicate, 0u);
    EXPECT_EQ(solver.options().width, 64);
    EXPECT_LE(true_error(solver, camera), target) << "estimated " << *answer.estimated_error;
}

INSTANTIATE_TEST_SUITE_P(Lamps, AskForEvery, testing::Values(LightSource::spot, LightSource::point, LightSource::area),
                         [](const auto& test) {
                             return std::string(test.param == LightSource::spot    ? "spot"
                                                : test.param == LightSource::point ? "point"
                                                                            : "area");
                         });

TEST(Ask, ACancelledProbeSaysSo) {
    const Scene scene = cornell({.light = LightSource::spot});
    const DeviceScene device = test::on_device(scene);
    SecondOrderSolver solver(test::programs(), test::device().queue, device, small_picture());
    EXPECT_THROW(report::ask(test::device().queue, device, solver, scene.cameras[0],
                             {.budget_ms = 20.0}, [] { return false; }),
                 report::Cancelled);
}

}  // namespace
}  // namespace clgi
