// Options that count.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace clgi::program {

// An option that takes whole numbers from `least` to `most`.
template <typename T>
CLI::Option* add_count(CLI::App& command, const std::string& name, T& value,
                       const std::string& text, int least, int most) {
    return command.add_option(name, value, text)->type_name("N")->check(CLI::Range(least, most));
}

}  // namespace clgi::program
