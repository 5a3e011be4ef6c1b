// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <vector>

#include "lab/gnuplot.hpp"
#include "lab/sweep_files.hpp"

namespace clgi::lab {
namespace {

// Larger errors are listed in the tables only; they would compress the plot.
constexpr double most_shown = 10.0;

bool shown(const SweepPoint& point, std::size_t truth) {
    return !point.given_up && point.error[truth] > 0.0 && point.error[truth] <= most_shown;
}

// How many points the plot leaves out, and why: " (2 diverged, 1 above 1000 % left out)".
std::string left_out(const Sweep& sweep, std::size_t truth) {
    std::size_t diverged = 0, not_finite = 0, above = 0, within_noise = 0;
    for (const SweepPoint& point : sweep.points) {
        if (point.method == path_tracer_name && point.series != sweep.truths[truth].name) continue;
        const double error = point.error[truth];
        if (point.given_up)
            ++diverged;
        else if (!std::isfinite(error))
            ++not_finite;
        else if (error > most_shown)
            ++above;
        else if (!(error > 0.0))
            ++within_noise;
    }
    std::string out;
    const auto add = [&](std::size_t count, const std::string& what) {
        if (count > 0) out += fmt::format("{}{} {}", out.empty() ? "" : ", ", count, what);
    };
    add(diverged, "diverged");
    add(not_finite, "not finite");
    add(above, fmt::format("above {:.0f} %", 100.0 * most_shown));
    add(within_noise, "within noise");
    return out.empty() ? out : " (" + out + " left out)";
}

// A gnuplot data block: time, error in per cent.
std::string block(const std::string& name, std::vector<const SweepPoint*> points,
                  std::size_t truth) {
    std::sort(points.begin(), points.end(), [](const SweepPoint* a, const SweepPoint* b) {
        return a->milliseconds < b->milliseconds;
    });
    std::string out = "$" + name + " << EOD\n";
    for (const SweepPoint* point : points)
        if (shown(*point, truth))
            out += fmt::format("{} {}\n", point->milliseconds, 100.0 * point->error[truth]);
    return out + "EOD\n";
}

// All settings and the front of each method, and the path tracer.
std::string script(const Sweep& sweep, std::size_t truth, const std::string& file) {
    constexpr struct {
        const char *all, *front;
    } colors[] = {{"#9ecae1", "#08519c"},
                  {"#a1d99b", "#006d2c"},
                  {"#bcbddc", "#54278f"},
                  {"#fcc5e8", "#c51b8a"}};
    const char* unit = sweep.of == SweepOf::atlas      ? "a bake"
                       : sweep.of == SweepOf::vertices ? "for all vertices"
                                                       : "a frame";
    // Where no curve is: the path tracer begins at the top, and ends above what it judges.
    const bool many = sweep.methods.size() > 2 && sweep.of == SweepOf::pictures;
    const char* key = many                            ? "outside right top Left reverse"
                      : sweep.of == SweepOf::vertices ? "bottom left Left reverse"
                                                      : "top right";
    std::string data, plots;
    const auto plot = [&](const std::string& name, const std::vector<const SweepPoint*>& points,
                          const std::string& how) {
        const bool any = std::any_of(points.begin(), points.end(),
                                     [&](const SweepPoint* point) { return shown(*point, truth); });
        if (!any) return;
        data += block(name, points, truth);
        plots += (plots.empty() ? "plot $" : ", $") + name + " with " + how;
    };
    for (std::size_t m = 0; m < sweep.methods.size(); ++m) {
        const std::string& method = sweep.methods[m];
        const auto& color = colors[m % std::size(colors)];
        std::vector<const SweepPoint*> all, front;
        for (const SweepPoint& point : sweep.points) {
            if (point.method != method) continue;
            all.push_back(&point);
            if (point.front[truth]) front.push_back(&point);
        }
        plot(fmt::format("all{}", m), all,
             fmt::format("points pt 7 ps 0.45 lc rgb '{}' title '{}, all settings'", color.all,
                         method));
        plot(fmt::format("front{}", m), front,
             fmt::format("linespoints pt 7 ps 0.7 lw 2 lc rgb '{}' title '{}, front'", color.front,
                         method));
    }
    std::vector<const SweepPoint*> traced;
    for (const SweepPoint& point : sweep.points)
        if (point.method == path_tracer_name && point.series == sweep.truths[truth].name)
            traced.push_back(&point);
    plot("traced", traced, "linespoints pt 5 ps 0.6 lw 2 lc rgb '#d95f02' title 'path tracer'");
    return data + plot_head(file, many ? 960 : 760, 460) +
           fmt::format(
               "set logscale xy\nset xlabel 'milliseconds {}'\n"
               "set ylabel 'relative error, %'\n"
               "set key {}\nset title 'Error against the {} reference{}' noenhanced\n",
               unit, key, sweep.truths[truth].name, left_out(sweep, truth)) +
           plots + "\n";
}

}  // namespace

std::string error_plot(const Sweep& sweep, std::size_t truth, const std::filesystem::path& folder,
                       std::string& why) {
    return draw_svg([&](const std::string& file) { return script(sweep, truth, file); }, folder,
                    why);
}

}  // namespace clgi::lab
