// The curves of convergence as table, data and plot.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "lab/convergence.hpp"
#include "lab/drawing.hpp"

namespace clgi::lab {
namespace {

nlohmann::ordered_json curve_json(const ConvergenceCurve& curve) {
    return {{"name", curve.name},
            {"iteration", curve.iteration == Iteration::symmetric ? "symmetric" : "asymmetric"},
            {"through_steps", curve.through_steps},
            {"diverged", curve.diverged},
            {"residuals", curve.residuals},
            {"errors", curve.errors}};
}

}  // namespace

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
        out["curves"].push_back(curve_json(curve));
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
