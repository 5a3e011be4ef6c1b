// SPDX-License-Identifier: MIT
#include "lab/convergence.hpp"

#include <fmt/format.h>

#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/programs.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "lab/drawing.hpp"
#include "lab/sweep_run.hpp"
#include "scene/luminance.hpp"

namespace clgi::lab {
namespace {

// Of each leaf: what arrives over links and from the sky, exposed lux, in rgb; and m^2.
std::vector<glm::vec4> leaf_irradiances(const cl::CommandQueue& queue,
                                        const AntiradianceSolver& solver) {
    std::vector<glm::vec4> out(solver.leaf_elements().size());
    queue.enqueueReadBuffer(solver.leaves().irradiances, CL_TRUE, 0, out.size() * sizeof(out[0]),
                            out.data());
    return out;
}

std::vector<double> leaf_areas(const AntiradianceSolver& solver) {
    std::vector<double> out;
    for (const std::uint32_t element : solver.leaf_elements())
        out.push_back(solver.elements().areas[element]);
    return out;
}

constexpr double least_residual = 1e-6;  // what floats still tell
constexpr int solution_steps = 2000;
constexpr int paper_through_steps = 4;  // for each reflection, of the asymmetric iteration

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
        trace(fmt::format("asymmetric, {} to 1", paper_through_steps), Iteration::asymmetric,
              paper_through_steps);
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

double leaf_difference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                       const std::vector<double>& areas) {
    if (a.size() != areas.size() || b.size() != areas.size())
        throw Error("leaf_difference: " + std::to_string(a.size()) + " and " +
                    std::to_string(b.size()) + " leaves, " + std::to_string(areas.size()) +
                    " areas; as many of each needed");
    double square = 0.0, mean = 0.0, area = 0.0;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        const double wanted = luminance(glm::dvec3(b[i]));
        const double difference = luminance(glm::dvec3(a[i])) - wanted;
        square += areas[i] * difference * difference;
        mean += areas[i] * wanted;
        area += areas[i];
    }
    return mean == 0.0 ? 0.0 : std::sqrt(square * area) / mean;
}

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

std::string convergence_csv(const Convergence& convergence) {
    std::string out = "iteration,step,residual,error,diverged\n";
    for (const ConvergenceCurve& curve : convergence.curves)
        for (std::size_t step = 0; step < curve.residuals.size(); ++step)
            out += fmt::format("\"{}\",{},{:.6g},{:.6g},{}\n", curve.name, step + 1,
                               curve.residuals[step], curve.errors.at(step),
                               curve.diverged && step + 1 == curve.residuals.size() ? 1 : 0);
    return out;
}

std::string convergence_json(const Convergence& convergence, const SweepNote& note) {
    nlohmann::ordered_json out = {
        {"clgi", note.version},
        {"command", note.command},
        {"device", convergence.device},
        {"scene", {{"name", convergence.scene}, {"triangles", convergence.triangles}}},
        {"elements", convergence.elements},
        {"leaves", convergence.leaves},
        {"links", convergence.links},
        {"bins", convergence.bins},
        {"solution",
         {{"steps", convergence.solution_steps}, {"residual", convergence.solution_residual}}},
        {"summary", summary(convergence)},
        {"curves", nlohmann::ordered_json::array()}};
    for (const ConvergenceCurve& curve : convergence.curves)
        out["curves"].push_back(
            {{"name", curve.name},
             {"iteration", curve.iteration == Iteration::symmetric ? "symmetric" : "asymmetric"},
             {"through_steps", curve.through_steps},
             {"diverged", curve.diverged},
             {"residuals", curve.residuals},
             {"errors", curve.errors}});
    return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
}

std::string save_convergence(const Convergence& convergence, const SweepNote& note,
                             const std::filesystem::path& folder) {
    const std::string json = convergence_json(convergence, note);
    save_text(folder / "convergence.csv", convergence_csv(convergence));
    save_text(folder / "convergence.json", json);
    const Drawing drawing;
    const std::string why = drawing.draw("convergence", nlohmann::ordered_json::parse(json));
    if (why.empty()) save_text(folder / "convergence.svg", drawing.text("convergence.svg"));
    return why;
}

}  // namespace clgi::lab
