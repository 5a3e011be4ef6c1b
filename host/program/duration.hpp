// Times as people write them.
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <clgi/error.hpp>
#include <string>
#include <string_view>

namespace clgi::program {

// "33ms" or "0.5s", as milliseconds. Throws Error naming command and flag for anything but a
// positive number with a unit.
inline double parse_milliseconds(const std::string& command, const std::string& flag,
                                 const std::string& text) {
    double value = 0.0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    const std::string_view unit(end, static_cast<std::size_t>(last - end));
    if (error == std::errc() && value > 0.0 && value < 1e9) {
        if (unit == "ms") return value;
        if (unit == "s") return 1000.0 * value;
    }
    throw Error(
        fmt::format("{}: {} is '{}', a time such as 33ms or 0.5s needed", command, flag, text));
}

}  // namespace clgi::program
