// SPDX-License-Identifier: MIT
#include "lab/gnuplot.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <sstream>

namespace clgi::lab {
namespace {

// As gnuplot wants a name: in single quotes, those inside doubled.
std::string quoted(const std::string& name) {
    std::string out = "'";
    for (const char c : name) out += c == '\'' ? "''" : std::string(1, c);
    return out + "'";
}

}  // namespace

// gnuplot reads its script from a pipe: no name of a user's ever reaches a shell.
std::string draw_svg(const std::function<std::string(const std::string& file)>& script,
                     const std::filesystem::path& folder, std::string& why) {
    const std::filesystem::path picture = std::filesystem::absolute(folder / "plot.tmp.svg");
    std::string out;
    std::FILE* gnuplot = ::popen("gnuplot >/dev/null 2>&1", "w");
    bool done = gnuplot != nullptr;
    if (gnuplot) {
        const std::string text = script(quoted(picture.string()));
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

std::string plot_head(const std::string& file, int width, int height) {
    return fmt::format(
        "set terminal svg size {},{} font 'sans-serif,13' background '#ffffff'\n"
        "set output {}\nset grid lc rgb '#dddddd'\nset border lc rgb '#666666'\n",
        width, height, file);
}

}  // namespace clgi::lab
