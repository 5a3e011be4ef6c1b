// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <vector>

#include "report/sweep_files.hpp"

namespace clgi::report {
namespace {

// A gnuplot data block: time, error in per cent.
std::string block(const std::string& name, std::vector<const SweepPoint*> points, int truth) {
    std::sort(points.begin(), points.end(), [](const SweepPoint* a, const SweepPoint* b) {
        return a->milliseconds < b->milliseconds;
    });
    std::string out = "$" + name + " << EOD\n";
    for (const SweepPoint* point : points)
        if (point->error[truth] > 0.0)
            out += fmt::format("{} {}\n", point->milliseconds, 100.0 * point->error[truth]);
    return out + "EOD\n";
}

std::string script(const Sweep& sweep, int truth, const std::string& file) {
    std::vector<const SweepPoint*> all, front, traced;
    for (const SweepPoint& point : sweep.points) {
        if (point.method == "second-order") {
            all.push_back(&point);
            if (point.front[truth]) front.push_back(&point);
        } else if (point.series == truth_names[truth]) {
            traced.push_back(&point);
        }
    }
    std::string out =
        block("all", all, truth) + block("front", front, truth) + block("traced", traced, truth);
    out += fmt::format(
        "set terminal svg size 760,460 font 'sans-serif,13' background '#ffffff'\n"
        "set output '{}'\n"
        "set logscale xy\nset xlabel 'milliseconds a frame'\n"
        "set ylabel 'relative error, %'\nset grid lc rgb '#dddddd'\nset border lc rgb '#666666'\n"
        "set key top right\nset title 'Error against the {} reference' noenhanced\n",
        file, truth_names[truth]);
    std::string plots;
    const auto plot = [&](bool there, const std::string& what) {
        if (there) plots += (plots.empty() ? "plot " : ", ") + what;
    };
    plot(!all.empty(),
         "$all with points pt 7 ps 0.45 lc rgb '#9ecae1' title 'second-order, all settings'");
    plot(!front.empty(),
         "$front with linespoints pt 7 ps 0.7 lw 2 lc rgb '#08519c' title 'second-order, front'");
    plot(!traced.empty(),
         "$traced with linespoints pt 5 ps 0.6 lw 2 lc rgb '#d95f02' title 'path tracer'");
    return out + plots + "\n";
}

}  // namespace

std::string error_plot(const Sweep& sweep, int truth, std::string& why) {
    namespace fs = std::filesystem;
    std::random_device random;
    const fs::path base =
        fs::temp_directory_path() / fmt::format("clgi-plot-{:08x}{:08x}", random(), random());
    const fs::path commands = base.string() + ".gp", picture = base.string() + ".svg";
    std::ofstream(commands) << script(sweep, truth, picture.string());
    const int status = std::system(("gnuplot '" + commands.string() + "' 2>/dev/null").c_str());
    std::ostringstream text;
    if (status == 0) text << std::ifstream(picture).rdbuf();
    std::error_code ignored;
    fs::remove(commands, ignored);
    fs::remove(picture, ignored);
    if (status != 0) why = "gnuplot is needed for plots";
    return status == 0 ? text.str() : "";
}

}  // namespace clgi::report
