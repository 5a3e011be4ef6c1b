// SPDX-License-Identifier: MIT
#include "report/ask.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "report/fronts.hpp"
#include "report/probe.hpp"

namespace clgi::report {
namespace {

constexpr double near_enough = 0.05;  // of the budget; what is left is the machine's own spread
constexpr int corrections = 6;
constexpr int looks = 10;  // at the errors of choices
// The converged picture that the estimate stands on has noise and fewer pixels.
constexpr double safety = 1.15;

struct Timed {
    Choice choice;
    double ms = 0.0;
};

// Moves the number of lights until frames take the time asked for.
Timed meet_budget(Probe& probe, const Front& front, CostModel model, double budget_ms) {
    Timed best;
    for (int round = 0; round <= corrections; ++round) {
        const Choice choice = within_budget(front, model, budget_ms);
        const double ms = probe.frame_ms(choice);
        if (round == 0 || std::abs(ms - budget_ms) < std::abs(best.ms - budget_ms))
            best = {choice, ms};
        if (std::abs(ms / budget_ms - 1.0) < near_enough) break;
        const bool cheapest = choice.rung == 0 && choice.lights <= fewest_lights;
        if (cheapest && ms > budget_ms) break;
        if (choice.lights == most_lights && ms < budget_ms) break;
        // The line through the fixed time and this one; where noise has swamped the difference,
        // twice or half the lights. Rungs keep their proportions.
        const double old = model.ms_per_light[choice.rung];
        double rate = (ms - model.fixed_ms) / choice.lights;
        rate = std::clamp(rate, 0.5 * old, 2.0 * old);
        for (double& each : model.ms_per_light) each *= rate / old;
        if (cheapest) model.fixed_ms = std::min(model.fixed_ms, ms);
    }
    return best;
}

struct Estimated {
    Choice choice;
    double error = 0.0;
    bool met = false;
};

std::size_t sample_of(const ErrorModel& model, int lights) {
    std::size_t i = 0;
    while (i + 1 < model.sampling.size() && model.sampling[i].lights < lights) ++i;
    return i;
}

// Looks at a choice's error, and keeps what that says of its rung.
double look(Probe& probe, ErrorModel& model, const Choice& choice) {
    const double error = probe.error(choice);
    const double sampling = model.sampling[sample_of(model, choice.lights)].error;
    model.added[choice.rung] = error * error - sampling * sampling;
    return error;
}

ErrorModel error_model(Probe& probe, const Front& front, double wanted) {
    ErrorModel model;
    model.sampling = probe.sampling(wanted);
    model.added.resize(front.rungs.size());
    std::size_t first = 0;  // that would do if every pixel were lit in full
    while (first + 1 < model.sampling.size() && model.sampling[first].error > wanted) ++first;
    for (std::size_t rung = 0; rung < front.rungs.size(); ++rung)
        look(probe, model, {rung, model.sampling[first].lights});
    return model;
}

// The cheapest choice that the models let pass, and a look at it: up where it falls short, down
// as long as fewer lights do.
Estimated meet_target(Probe& probe, const CostModel& cost, ErrorModel& model, double wanted) {
    Estimated best;
    int left = looks;
    while (!best.met && left-- > 0) {
        const std::optional<Choice> found = within_error(cost, model, wanted);
        const Choice choice = found ? *found : most_accurate(cost, model);
        const double error = look(probe, model, choice);
        if (best.error == 0.0 || error < best.error) best = {choice, error, error <= wanted};
        if (!found) break;
    }
    while (best.met && left-- > 0) {
        const std::size_t sample = sample_of(model, best.choice.lights);
        if (sample == 0) break;
        const Choice fewer{best.choice.rung, model.sampling[sample - 1].lights};
        const double error = probe.error(fewer);
        if (error > wanted) break;
        best = {fewer, error, true};
    }
    return best;
}

}  // namespace

Answer ask(const cl::CommandQueue& queue, const DeviceScene& scene, SecondOrderSolver& solver,
           const Camera& camera, const Wish& wish, const std::function<bool()>& go_on) {
    const auto start = std::chrono::steady_clock::now();
    const SecondOrderOptions before = solver.options();
    const Front& front = second_order_front(classify(scene));
    Probe probe(queue, solver, camera, front, go_on);
    const CostModel cost = probe.cost();
    Answer out;
    Choice choice;

    if (wish.target_error) {
        const double wanted = *wish.target_error / safety;
        ErrorModel errors = error_model(probe, front, wanted);
        const Estimated found = meet_target(probe, cost, errors, wanted);
        choice = found.choice;
        out.estimated_error = found.error;
        out.target_met = found.met;
        out.promised_ms = probe.frame_ms(choice);
    }
    // With both wishes: only where the target costs more than the budget.
    if (wish.budget_ms && (!wish.target_error || *out.promised_ms > *wish.budget_ms)) {
        const Timed found = meet_budget(probe, front, cost, *wish.budget_ms);
        choice = found.choice;
        out.promised_ms = found.ms;
        out.budget_met = found.ms <= (1.0 + 2.0 * near_enough) * *wish.budget_ms;
        if (wish.target_error) {
            out.estimated_error = probe.error(choice);
            out.target_met = safety * *out.estimated_error <= *wish.target_error;
        }
    }
    out.settings = settings_of(front, choice);
    solver.reconfigure(applied(before, out.settings));
    out.probe_ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return out;
}

}  // namespace clgi::report
