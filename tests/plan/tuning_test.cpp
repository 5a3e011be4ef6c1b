// Tuning of second-order illumination as a program has it, through the public headers: settings for
// a time, and for an error that an independent estimate of the true one does not exceed.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <cmath>
#include <memory>

#include "device.hpp"

namespace clgi {
namespace {

std::vector<double> luminance(SecondOrderSolver& solver, const Camera& camera) {
    solver.render(camera);
    const std::size_t stride = solver.stride(), width = solver.options().width;
    const auto values = test::download<float>(solver.radiance(), RADIANCE_PLANES * stride);
    std::vector<double> out(width * solver.options().height);
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = 0.2126 * values[i] + 0.7152 * values[stride + i] + 0.0722 * values[2 * stride + i];
    return out;
}

// The converged picture by other replicates than tuning's own, the true error by other code.
double true_error(SecondOrderSolver& solver, const Camera& camera) {
    const std::vector<double> delivered = luminance(solver, camera);
    SecondOrderOptions options = solver.options();
    options.emitters.vpls = SecondOrderTuning::converged_vpls;
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

std::optional<SecondOrderTuning> tuned(const DeviceScene& device, SecondOrderSolver& solver,
                                       const Camera& camera, const TuningTarget& request,
                                       const Progress& progress = nullptr) {
    return tune_second_order(test::device().queue, device, solver, camera, request, progress);
}

void expect_settings(const SecondOrderOptions& options, const SecondOrderSettings& settings) {
    EXPECT_EQ(options.emitters.vpls, settings.vpls);
    EXPECT_EQ(options.negative_vpls, settings.negative_vpls);
    EXPECT_EQ(options.low_resolution_step, settings.low_resolution_step);
    EXPECT_EQ(options.discontinuity_threshold, settings.discontinuity_threshold);
}

class TuneFor : public testing::TestWithParam<LightSource> {};

TEST_P(TuneFor, AnErrorThatIsNotExceeded) {
    const Scene scene = cornell({.light = GetParam()});
    const DeviceScene device = test::on_device(scene);
    const Camera& camera = scene.cameras[0];
    SecondOrderSolver solver(test::programs(), test::device().queue, device, small_picture());
    constexpr double requested = 0.1;
    const auto found = tuned(device, solver, camera, {.error = requested});
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->meets_error);
    ASSERT_TRUE(found->error);
    EXPECT_LE(*found->error, requested);
    expect_settings(solver.options(), found->settings);
    EXPECT_EQ(solver.options().emitters.replicate, 0u);
    EXPECT_EQ(solver.options().width, 64);
    EXPECT_LE(true_error(solver, camera), requested) << "estimated " << *found->error;
}

INSTANTIATE_TEST_SUITE_P(Lights, TuneFor,
                         testing::Values(LightSource::spot, LightSource::point, LightSource::area),
                         [](const auto& test) {
                             return std::string(test.param == LightSource::spot    ? "spot"
                                                : test.param == LightSource::point ? "point"
                                                                                   : "area");
                         });

// Of a scene, cheap ones; no time is asserted.
class Tune : public testing::Test {
protected:
    const Scene scene_ = cornell({.light = LightSource::spot});
    DeviceScene device_ = test::on_device(scene_);
    const Camera& camera_ = scene_.cameras[0];
    std::unique_ptr<SecondOrderSolver> solver_ = std::make_unique<SecondOrderSolver>(
        test::programs(), test::device().queue, device_, small_picture());
};

TEST_F(Tune, TakesMoreVplsForALongerTime) {
    const auto never = tuned(device_, *solver_, camera_, {.frame_ms = 1e-3});
    ASSERT_TRUE(never);
    EXPECT_FALSE(never->meets_time);
    EXPECT_FALSE(never->error);
    EXPECT_EQ(never->settings.vpls, SecondOrderTuning::fewest_vpls);
    const auto found = tuned(device_, *solver_, camera_, {.frame_ms = 20.0 * never->frame_ms});
    ASSERT_TRUE(found);
    EXPECT_GT(found->settings.vpls, 10 * SecondOrderTuning::fewest_vpls);
    EXPECT_GT(found->settings.negative_vpls, 0);
    expect_settings(solver_->options(), found->settings);
    EXPECT_GT(found->milliseconds, found->frame_ms);
}

// With more pixels than errors are sampled at, the last trial picture is not of the settings found.
TEST_F(Tune, PutsTheTimeBeforeTheError) {
    SecondOrderOptions options = small_picture();
    options.width = 161;
    options.height = 128;
    solver_->reconfigure(options);
    const auto found = tuned(device_, *solver_, camera_, {.frame_ms = 1e-3, .error = 0.1});
    ASSERT_TRUE(found);
    EXPECT_FALSE(found->meets_time);
    EXPECT_FALSE(found->meets_error);
    EXPECT_EQ(found->settings.vpls, SecondOrderTuning::fewest_vpls);
    EXPECT_GT(found->error.value(), 0.1);
    expect_settings(solver_->options(), found->settings);
    EXPECT_EQ(solver_->options().width, 161);
    EXPECT_EQ(solver_->options().height, 128);
}

TEST_F(Tune, PlacesNoNegativeVplsWhereThereAreNone) {
    SecondOrderOptions options = small_picture();
    options.negative_vpls = 0;
    solver_->reconfigure(options);
    const auto found = tuned(device_, *solver_, camera_, {.frame_ms = 1e-3});
    ASSERT_TRUE(found);
    EXPECT_EQ(found->settings.negative_vpls, 0);
    EXPECT_EQ(solver_->options().negative_vpls, 0);
}

TEST_F(Tune, LeavesTheSolverAsItWasWhenCancelled) {
    double last = 0.0;
    int reports = 0;
    const auto some = [&](double done) {
        EXPECT_GE(done, last);
        EXPECT_LE(done, 1.0);
        last = done;
        return ++reports < 12;
    };
    EXPECT_FALSE(tuned(device_, *solver_, camera_, {.frame_ms = 20.0}, some));
    EXPECT_EQ(reports, 12);
    EXPECT_GT(last, 0.0);
    EXPECT_EQ(solver_->options().emitters.vpls, small_picture().emitters.vpls);
    EXPECT_EQ(solver_->options().low_resolution_step, small_picture().low_resolution_step);
}

TEST_F(Tune, RefusesWishesOutOfRange) {
    for (const TuningTarget& request :
         {TuningTarget{}, TuningTarget{0.0, {}}, TuningTarget{{}, -0.1}, TuningTarget{NAN, 0.1},
          TuningTarget{10.0, INFINITY}})
        EXPECT_THROW(tuned(device_, *solver_, camera_, request), Error);
    SecondOrderOptions direct = small_picture();
    direct.indirect = false;
    solver_->reconfigure(direct);
    EXPECT_THROW(tuned(device_, *solver_, camera_, {.frame_ms = 20.0}), Error);
}

TEST_F(Tune, GivesAPlanWhatItsTimeBuys) {
    PlanRequest request;
    request.width = 64;
    request.height = 48;
    request.seconds = 1e-6;
    request.method = Method::second_order;
    const Plan plan = make_plan(test::device().device, scene_analysis(scene_), request);
    Renderer renderer(test::programs(), test::device().queue, scene_, device_, plan);
    const cl::CommandQueue& queue = test::device().queue;
    Plan after = plan;
    ASSERT_TRUE(tune(queue, renderer, after, camera_));
    EXPECT_EQ(after.second_order.emitters.vpls, SecondOrderTuning::fewest_vpls);
    EXPECT_NE(plan.second_order.emitters.vpls, SecondOrderTuning::fewest_vpls);
    EXPECT_FALSE(after.meets_time);
    EXPECT_GT(after.cost.frame_ms, 0.0);
    EXPECT_NE(after.cost.frame_ms, plan.cost.frame_ms);
    EXPECT_FALSE(tune(queue, renderer, after, camera_, [](double) { return false; }));
}

}  // namespace
}  // namespace clgi
