// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
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

// As gnuplot wants a name: in single quotes, those inside doubled.
std::string quoted(const std::string& name) {
    std::string out = "'";
    for (const char c : name) out += c == '\'' ? "''" : std::string(1, c);
    return out + "'";
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
        "set output {}\n"
        "set logscale xy\nset xlabel 'milliseconds a frame'\n"
        "set ylabel 'relative error, %'\nset grid lc rgb '#dddddd'\nset border lc rgb '#666666'\n"
        "set key top right\nset title 'Error against the {} reference' noenhanced\n",
        file, truth_names[truth]);
    const auto shown = [&](const std::vector<const SweepPoint*>& points) {
        return std::any_of(points.begin(), points.end(),
                           [&](const SweepPoint* point) { return point->error[truth] > 0.0; });
    };
    std::string plots;
    const auto plot = [&](bool there, const std::string& what) {
        if (there) plots += (plots.empty() ? "plot " : ", ") + what;
    };
    plot(shown(all),
         "$all with points pt 7 ps 0.45 lc rgb '#9ecae1' title 'second-order, all settings'");
    plot(shown(front),
         "$front with linespoints pt 7 ps 0.7 lw 2 lc rgb '#08519c' title 'second-order, front'");
    plot(shown(traced),
         "$traced with linespoints pt 5 ps 0.6 lw 2 lc rgb '#d95f02' title 'path tracer'");
    return out + plots + "\n";
}

}  // namespace

// gnuplot reads its script from a pipe: no name of a user's ever reaches a shell.
std::string error_plot(const Sweep& sweep, int truth, const std::filesystem::path& folder,
                       std::string& why) {
    const std::filesystem::path picture = std::filesystem::absolute(folder / "error-plot.tmp.svg");
    std::string out;
    std::FILE* gnuplot = ::popen("gnuplot >/dev/null 2>&1", "w");
    bool done = gnuplot != nullptr;
    if (gnuplot) {
        const std::string text = script(sweep, truth, quoted(picture.string()));
        done = std::fwrite(text.data(), 1, text.size(), gnuplot) == text.size();
        const int status = ::pclose(gnuplot);
        if (status != 0) why = status >> 8 == 127 ? "gnuplot is not there" : "gnuplot failed";
        done = done && status == 0;
    }
    if (done) {
        std::ostringstream text;
        text << std::ifstream(picture).rdbuf();
        out = text.str();
    }
    std::error_code ignored;
    std::filesystem::remove(picture, ignored);
    return out;
}

}  // namespace clgi::report
