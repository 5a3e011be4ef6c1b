// The flags of a command that set options of a renderer: one for each row of the table.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/options.hpp>
#include <string>
#include <vector>

namespace clgi::program {

// Rows that one of the methods has, but `without`. options: what the flags set.
void add_option_flags(CLI::App& command, RendererOptions& options, unsigned methods,
                      const std::vector<std::string>& without = {});

// Those of the flags that the user gave.
std::vector<const OptionRow*> given_options(const CLI::App& command, unsigned methods);

// Throws Error "render: --bins goes only with --method antiradiance" for an option that the method
// does not have.
void check_methods(const std::string& command, const std::vector<const OptionRow*>& given,
                   const std::string& method);

}  // namespace clgi::program
