// Pictures by gnuplot, where it is installed.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace clgi::lab {

// The SVG that a script makes. script: takes the name of the picture as gnuplot wants it, for
// "set output". Empty, with the reason in `why`, when gnuplot is not there or fails. folder: where
// it may work.
std::string draw_svg(const std::function<std::string(const std::string& file)>& script,
                     const std::filesystem::path& folder, std::string& why);

// Terminal and colours that all plots share, as the first lines of a script.
std::string plot_head(const std::string& file, int width, int height);

}  // namespace clgi::lab
