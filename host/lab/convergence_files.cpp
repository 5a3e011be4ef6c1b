// The curves of convergence as table, data and plot.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "io/atomic_file.hpp"
#include "lab/convergence.hpp"
#include "lab/gnuplot.hpp"

namespace clgi::lab {
namespace {

// The step and the value; what no logarithm shows is left out, and the title says that it diverges.
std::string block(const std::string& name, const std::vector<double>& values) {
    std::string out = "$" + name + " << EOD\n";
    for (std::size_t step = 0; step < values.size(); ++step)
        if (values[step] > 0.0 && std::isfinite(values[step]))
            out += fmt::format("{} {}\n", step + 1, values[step]);
    return out + "EOD\n";
}

std::string script(const Convergence& convergence, const std::string& file) {
    constexpr const char* colors[] = {"#08519c", "#cb181d", "#238b45"};
    std::string data, panels[2];
    for (std::size_t k = 0; k < convergence.curves.size(); ++k) {
        const ConvergenceCurve& curve = convergence.curves[k];
        const std::vector<double>* values[2] = {&curve.residuals, &curve.errors};
        for (std::size_t panel = 0; panel < 2; ++panel) {
            const std::string name = fmt::format("values{}{}", panel, k);
            data += block(name, *values[panel]);
            panels[panel] +=
                fmt::format("{}${} with lines lw 2 lc rgb '{}' title '{}{}'",
                            panels[panel].empty() ? "plot " : ", ", name, colors[k % 3], curve.name,
                            curve.diverged ? ", diverges" : "");
            // A cross where it is given up.
            if (curve.diverged)
                panels[panel] +=
                    fmt::format(", ${} every ::{} with points pt 2 ps 1.5 lw 2 lc rgb '{}' notitle",
                                name, values[panel]->size() - 1, colors[k % 3]);
        }
    }
    return data + plot_head(file, 1000, 480) +
           "set multiplot layout 1,2\nset logscale y\nset format y '10^{%T}'\n"
           "set xlabel 'step' offset 0,0.5\nset xrange [0:]\nset key below vertical maxrows 3 Left "
           "reverse\n"
           "set title 'Change of what arrives in a step, of the first step'\n" +
           panels[0] + "\nset title 'Error of what arrives, against the converged solution'\n" +
           panels[1] + "\nunset multiplot\n";
}

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
    const auto save = [&](const std::string& name, const std::string& text) {
        io::AtomicFile file(folder / name);
        file.write(text.data(), text.size());
        file.commit();
    };
    save("convergence.csv", convergence_csv(convergence));
    save("convergence.json", convergence_json(convergence, note));
    std::string why;
    const std::string plot =
        draw_svg([&](const std::string& file) { return script(convergence, file); }, folder, why);
    if (!plot.empty()) save("convergence.svg", plot);
    return why;
}

}  // namespace clgi::lab
