// SPDX-License-Identifier: MIT
#include "lab/convergence.hpp"

#include <fmt/format.h>

#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/programs.hpp>

#include "lab/leaf_difference.hpp"
#include "lab/sweep_run.hpp"

namespace clgi::lab {
namespace {

constexpr double least_residual = 1e-6;  // what floats still tell
constexpr int solution_steps = 2000;

class ConvergenceRun {
public:
    explicit ConvergenceRun(const ConvergenceSetup& setup)
        : setup_(setup),
          progress_(setup.progress),
          device_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(), setup.queue.getInfo<CL_QUEUE_DEVICE>(),
                  setup.scene),
          programs_(setup.queue.getInfo<CL_QUEUE_CONTEXT>(),
                    setup.queue.getInfo<CL_QUEUE_DEVICE>()) {}

    Convergence operator()() {
        out_.scene = setup_.scene.name;
        out_.device = describe(setup_.queue.getInfo<CL_QUEUE_DEVICE>());
        out_.triangles = setup_.scene.triangles.size();
        out_.bins = setup_.options.bins;
        progress_.part(0.0, 0.25);
        solve();
        progress_.part(0.25, 0.25);
        trace("symmetric", Iteration::symmetric, 0);
        progress_.part(0.5, 0.25);
        trace(fmt::format("asymmetric, {} to 1", setup_.through_steps), Iteration::asymmetric,
              setup_.through_steps);
        progress_.part(0.75, 0.25);
        trace("asymmetric, as many as it takes", Iteration::asymmetric, 0);
        return std::move(out_);
    }

private:
    AntiradianceOptions options_of(Iteration iteration, int through_steps, int steps) const {
        AntiradianceOptions out = setup_.options;
        out.iteration = iteration;
        out.through_steps = through_steps;
        out.steps = steps;
        out.residual = least_residual;
        out.most_steps = solution_steps;
        return out;
    }

    // What light comes to, by the iteration that converges where any does.
    void solve() {
        AntiradianceSolver solver(programs_, setup_.queue, setup_.scene, device_,
                                  options_of(Iteration::asymmetric, 0, 0));
        if (!solver.run([&](double done) { return progress_.goes_on(done); })) throw_cancelled();
        const AntiradianceStatus status = solver.status();
        if (status.given_up)
            throw Error(
                "sweep: the asymmetric iteration diverged; there is nothing to converge to");
        out_.elements = solver.elements().count();
        out_.leaves = solver.elements().leaves;
        out_.links = solver.link_count();
        out_.solution_steps = status.residuals.size();
        out_.solution_residual = status.residuals.back();
        solution_ = leaf_irradiances(setup_.queue, solver);
        areas_ = leaf_areas(solver);
        const std::vector<glm::vec4> black(solution_.size(), glm::vec4(0.0f));
        if (!(leaf_difference(black, solution_, areas_) > 0.0))
            throw Error("sweep: no indirect light arrives that could converge");
    }

    void trace(const std::string& name, Iteration iteration, int through_steps) {
        AntiradianceSolver solver(programs_, setup_.queue, setup_.scene, device_,
                                  options_of(iteration, through_steps, setup_.steps));
        ConvergenceCurve curve{name, iteration, through_steps, false, {}, {}};
        // It reports after each step but the last of some iterations, and at the end.
        const bool ended = solver.run([&](double done) {
            if (solver.status().residuals.size() > curve.errors.size())
                curve.errors.push_back(
                    leaf_difference(leaf_irradiances(setup_.queue, solver), solution_, areas_));
            return progress_.goes_on(done);
        });
        if (!ended) throw_cancelled();
        const AntiradianceStatus status = solver.status();
        curve.diverged = status.given_up;
        curve.residuals = status.residuals;
        out_.curves.push_back(std::move(curve));
    }

    const ConvergenceSetup& setup_;
    SweepProgress progress_;
    DeviceScene device_;
    Programs programs_;
    std::vector<glm::vec4> solution_;
    std::vector<double> areas_;
    Convergence out_;
};

// "0.001 after 14", of the first step from which on the values stay below.
std::string first_below(const std::vector<double>& values, double bound) {
    std::size_t step = values.size();
    while (step > 0 && values[step - 1] < bound) --step;
    return step == values.size() ? fmt::format("not below {:g}", bound)
                                 : fmt::format("below {:g} from step {} on", bound, step + 1);
}

}  // namespace

Convergence measure_convergence(const ConvergenceSetup& setup) { return ConvergenceRun(setup)(); }

std::vector<std::string> summary(const Convergence& convergence) {
    std::vector<std::string> out;
    for (const ConvergenceCurve& curve : convergence.curves) {
        std::string text = fmt::format(
            "{}: residual {}, error {} and {}", curve.name, first_below(curve.residuals, 1e-3),
            first_below(curve.errors, 1e-2), first_below(curve.errors, 1e-3));
        text += curve.diverged
                    ? fmt::format("; it diverges, given up after {} steps", curve.residuals.size())
                    : fmt::format("; {:.2g} and {:.2g} after {} steps", curve.residuals.back(),
                                  curve.errors.back(), curve.residuals.size());
        out.push_back(text + ".");
    }
    out.push_back(fmt::format(
        "Errors are of what arrives at {} leaves over {} links, {} bins, against {} steps of the "
        "asymmetric iteration, whose residual is {:.2g}.",
        convergence.leaves, convergence.links, convergence.bins, convergence.solution_steps,
        convergence.solution_residual));
    return out;
}

}  // namespace clgi::lab
