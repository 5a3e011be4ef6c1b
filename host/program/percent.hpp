// Shares as people write them.
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <clgi/error.hpp>
#include <string>

namespace clgi::program {

// "0.5%" or "0.005". Throws Error naming command and flag for anything but a positive number.
inline double parse_percent(const std::string& command, const std::string& flag,
                            const std::string& text) {
    double value = 0.0;
    const char* last = text.data() + text.size();
    const auto [end, error] = std::from_chars(text.data(), last, value);
    const bool percent = end != last && *end == '%' && end + 1 == last;
    if (error != std::errc() || (end != last && !percent) || !(value > 0.0) || !(value < 1e9))
        throw Error(
            fmt::format("{}: {} is '{}', a share such as 2% or 0.02 needed", command, flag, text));
    return percent ? value / 100.0 : value;
}

// Of a share, about: two figures, or all before the point.
inline std::string about_percent(double share) {
    return share < 0.995 ? fmt::format("{:.2g}", 100.0 * share)
                         : fmt::format("{:.0f}", 100.0 * share);
}

}  // namespace clgi::program
