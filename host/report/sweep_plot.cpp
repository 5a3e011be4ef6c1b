// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <vector>

#include "report/gnuplot.hpp"
#include "report/sweep_files.hpp"

namespace clgi::report {
namespace {

// What diverged is told by the tables; in the plot it would press all else to the floor.
constexpr double most_shown = 10.0;

bool shown(const SweepPoint& point, std::size_t truth) {
    return point.error[truth] > 0.0 && point.error[truth] <= most_shown;
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
        const bool any = std::any_of(points.begin(), points.end(), [&](const SweepPoint* point) {
            return shown(*point, truth);
        });
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
    const auto above =
        std::count_if(sweep.points.begin(), sweep.points.end(), [&](const SweepPoint& point) {
            return point.method != path_tracer_name && !(point.error[truth] <= most_shown);
        });
    const std::string left_out =
        above > 0 ? fmt::format(" ({} above {:.0f} % left out)", above, 100.0 * most_shown) : "";
    return data + plot_head(file, many ? 960 : 760, 460) +
           fmt::format(
               "set logscale xy\nset xlabel 'milliseconds {}'\n"
               "set ylabel 'relative error, %'\n"
               "set key {}\nset title 'Error against the {} reference{}' noenhanced\n",
               unit, key, sweep.truths[truth].name, left_out) +
           plots + "\n";
}

}  // namespace

std::string error_plot(const Sweep& sweep, std::size_t truth, const std::filesystem::path& folder,
                       std::string& why) {
    return draw_svg([&](const std::string& file) { return script(sweep, truth, file); }, folder,
                    why);
}

}  // namespace clgi::report
