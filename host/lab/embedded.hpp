// The Python programs and templates of host/lab/plots, which cmake/EmbedFiles.cmake compiles in.
// SPDX-License-Identifier: MIT
#pragma once

namespace clgi::lab {

struct EmbeddedPlot {
    const char* name;  // "sheet.py"
    const char* source;
};

extern const EmbeddedPlot embedded_plots[];
extern const unsigned embedded_plot_count;

}  // namespace clgi::lab
