// Tuning: from a request to the point of a front that meets it, by models first and pictures then.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/tuning.hpp>
#include <clgi/error.hpp>
#include <cmath>

#include "core/opencl/timing.hpp"
#include "plan/trial_frames.hpp"

namespace clgi {
namespace {

constexpr double near_enough = 0.05;  // of the time; what is left is the machine's own spread
constexpr int corrections = 6;
constexpr int looks = 10;  // at the errors of points
// The converged picture that the estimate stands on has noise and fewer pixels.
constexpr double safety = 1.15;

struct Timed {
    FrontPoint point;
    double ms = 0.0;
};

// Moves the number of VPLs until frames take the time asked for.
Timed meet_time(TrialFrames& trial, const SecondOrderFront& front, FrameTimeModel model,
                double wanted_ms) {
    Timed best;
    for (int round = 0; round <= corrections; ++round) {
        const FrontPoint point = within_time(front, model, wanted_ms);
        const double ms = trial.frame_ms(point);
        if (round == 0 || std::abs(ms - wanted_ms) < std::abs(best.ms - wanted_ms))
            best = {point, ms};
        if (std::abs(ms / wanted_ms - 1.0) < near_enough) break;
        const bool cheapest = point.refinement == 0 && point.vpls <= SecondOrderTuning::fewest_vpls;
        if (cheapest && ms > wanted_ms) break;
        if (point.vpls == SecondOrderTuning::most_vpls && ms < wanted_ms) break;
        // The line through the fixed time and this one; where noise has swamped the difference,
        // twice or half the VPLs. Refinements keep their proportions.
        const double old = model.ms_per_vpl[point.refinement];
        double rate = (ms - model.fixed_ms) / point.vpls;
        rate = std::clamp(rate, 0.5 * old, 2.0 * old);
        for (double& each : model.ms_per_vpl) each *= rate / old;
        if (cheapest) model.fixed_ms = std::min(model.fixed_ms, ms);
    }
    return best;
}

struct Estimated {
    FrontPoint point;
    double error = 0.0;
    bool met = false;
};

std::size_t sample_of(const FrameErrorModel& model, int vpls) {
    std::size_t i = 0;
    while (i + 1 < model.sampling.size() && model.sampling[i].vpls < vpls) ++i;
    return i;
}

// Looks at a point's error, and keeps what that says of its refinement.
double look(TrialFrames& trial, FrameErrorModel& model, const FrontPoint& point) {
    const double error = trial.error(point);
    const double sampling = model.sampling[sample_of(model, point.vpls)].error;
    model.added[point.refinement] = error * error - sampling * sampling;
    return error;
}

FrameErrorModel error_model(TrialFrames& trial, const SecondOrderFront& front, double wanted) {
    FrameErrorModel model;
    model.sampling = trial.sampling(wanted);
    model.added.resize(front.refinements.size());
    std::size_t first = 0;  // that would do if every pixel were lit in full
    while (first + 1 < model.sampling.size() && model.sampling[first].error > wanted) ++first;
    for (std::size_t i = 0; i < front.refinements.size(); ++i)
        look(trial, model, {i, model.sampling[first].vpls});
    return model;
}

// The cheapest point that the models let pass, and a look at it: up where it falls short, down
// as long as fewer VPLs do.
Estimated meet_error(TrialFrames& trial, const FrameTimeModel& time, FrameErrorModel& model,
                     double wanted) {
    Estimated best;
    int left = looks;
    while (!best.met && left-- > 0) {
        const std::optional<FrontPoint> found = within_error(time, model, wanted);
        const FrontPoint point = found ? *found : most_accurate(time, model);
        const double error = look(trial, model, point);
        if (best.error == 0.0 || error < best.error) best = {point, error, error <= wanted};
        if (!found) break;
    }
    while (best.met && left-- > 0) {
        const std::size_t sample = sample_of(model, best.point.vpls);
        if (sample == 0) break;
        const FrontPoint fewer{best.point.refinement, model.sampling[sample - 1].vpls};
        const double error = trial.error(fewer);
        if (error > wanted) break;
        best = {fewer, error, true};
    }
    return best;
}

void need(bool right, const char* what) {
    if (!right) throw Error(std::string("tuning: ") + what);
}

void check(const TuningTarget& request, const SecondOrderOptions& options) {
    const auto positive = [](const std::optional<double>& value) {
        return !value || (*value > 0.0 && std::isfinite(*value));
    };
    need(request.frame_ms || request.error, "neither a time nor an error is asked for");
    need(positive(request.frame_ms), "frame_ms is not above 0 or not finite");
    need(positive(request.error), "error is not above 0 or not finite");
    need(options.indirect, "the solver renders no indirect light, so there is nothing to tune");
}

// Shares of the whole until each part ends.
constexpr double timed_share = 0.2, sampled_share = 0.5, looked_share = 0.8;

SecondOrderTuning find(TrialFrames& trial, const SecondOrderFront& front,
                       const TuningTarget& request) {
    const int refinements = static_cast<int>(front.refinements.size());
    trial.next_part(timed_share, (1 + refinements) * (1 + most_timed));
    const FrameTimeModel time = trial.time_model();
    SecondOrderTuning out;
    FrontPoint point;
    if (request.error) {
        const double wanted = *request.error / safety;
        trial.next_part(sampled_share, most_sampled);
        FrameErrorModel errors = error_model(trial, front, wanted);
        trial.next_part(looked_share, 2 * looks + 1 + most_timed);
        const Estimated found = meet_error(trial, time, errors, wanted);
        point = found.point;
        out.error = found.error;
        out.meets_error = found.met;
        out.frame_ms = trial.frame_ms(point);
    }
    // With both requests: only where the error costs more than the time.
    if (request.frame_ms && (!request.error || out.frame_ms > *request.frame_ms)) {
        trial.next_part(1.0, (1 + corrections) * (1 + most_timed));
        const Timed found = meet_time(trial, front, time, *request.frame_ms);
        point = found.point;
        out.frame_ms = found.ms;
        out.meets_time = found.ms <= (1.0 + 2.0 * near_enough) * *request.frame_ms;
        if (request.error) {
            out.error = trial.error(point);
            out.meets_error = safety * *out.error <= *request.error;
        }
    }
    out.settings = trial.settings(point);
    return out;
}

}  // namespace

std::optional<SecondOrderTuning> tune_second_order(const cl::CommandQueue& queue,
                                                   const DeviceScene& scene,
                                                   SecondOrderSolver& solver, const Camera& camera,
                                                   const TuningTarget& request,
                                                   const Progress& progress) {
    const auto start = timing::Clock::now();
    const SecondOrderOptions before = solver.options();
    check(request, before);
    const SecondOrderFront& front = second_order_front(main_light(scene));
    TrialFrames trial(queue, solver, camera, front, progress);
    SecondOrderTuning out;
    try {
        out = find(trial, front, request);
    } catch (const TrialFrames::Cancelled&) {
        solver.reconfigure(before);
        return std::nullopt;
    } catch (...) {
        solver.reconfigure(before);
        throw;
    }
    solver.reconfigure(with_settings(before, out.settings));
    out.milliseconds = timing::milliseconds(timing::Clock::now() - start);
    if (progress) progress(1.0);  // too late to cancel
    return out;
}

bool tune(const cl::CommandQueue& queue, Renderer& renderer, Plan& plan, const Camera& camera,
          const Progress& progress) {
    renderer.build();
    SecondOrderSolver* solver = renderer.second_order();
    if (!solver || !solver->options().indirect || !plan.request.seconds)
        return !progress || progress(1.0);
    TuningTarget target;
    target.frame_ms = 1e3 * *plan.request.seconds;
    const auto found =
        tune_second_order(queue, renderer.scene(), *solver, camera, target, progress);
    if (!found) return false;
    plan.second_order = solver->options();
    plan.cost.frame_ms = found->frame_ms;
    plan.meets_time = found->meets_time;
    return true;
}

}  // namespace clgi
