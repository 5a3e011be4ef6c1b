// Asking for the result: a frame time or an error, and the settings that give it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <functional>
#include <optional>
#include <stdexcept>

#include "report/settings_model.hpp"

namespace clgi::report {

struct Wish {
    std::optional<double> budget_ms;     // median frame time to meet, not only to stay under
    std::optional<double> target_error;  // relative RMSE of luminance to the converged picture
};

struct Answer {
    Settings settings;
    std::optional<double> promised_ms;      // as measured by the probe's last frames
    std::optional<double> estimated_error;  // none where only a time was asked for
    bool budget_met = true;                 // where there is one: within it, or as near as may be
    bool target_met = true;                 // where there is one: promised
    double probe_ms = 0.0;
};

// The converged picture, what errors are relative to: this many VPLs, every pixel in
// full, the mean of a few replicates.
constexpr int converged_lights = 50000;

// Probes the scene through a solver that has rendered at least one frame, and leaves the solver
// at the settings found. With both wishes the target comes first as long as the budget allows.
// `go_on` is asked between frames; throws Cancelled when it says no.
struct Cancelled : std::runtime_error {
    Cancelled() : std::runtime_error("cancelled") {}
};
Answer ask(const cl::CommandQueue& queue, const DeviceScene& scene, SecondOrderSolver& solver,
           const Camera& camera, const Wish& wish, const std::function<bool()>& go_on = nullptr);

}  // namespace clgi::report
