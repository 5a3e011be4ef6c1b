// The text of --help: one form for every option, with its range and its default.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>

namespace clgi::program {

// Gives an app the text below, and all commands that are added to it afterwards. Defaults are taken
// from the variables that options are bound to; where a default is computed, default_str says how.
//
//   --vpls N     Indirect lights [0 to 1048576; not with --target-error; default: 300]
void set_help(CLI::App& app);

}  // namespace clgi::program
