// Three numbers with commas between them.
// SPDX-License-Identifier: MIT
#pragma once

#include <charconv>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace clgi::program {

// "1,2,3"; nothing for any other text, and for numbers that are not finite.
inline std::optional<glm::dvec3> parse_triple(const std::string& text) {
    glm::dvec3 out(0.0);
    const char *at = text.data(), *last = at + text.size();
    for (int c = 0; c < 3; ++c) {
        if (c > 0 && (at == last || *at++ != ',')) return std::nullopt;
        while (at != last && *at == ' ') ++at;
        const auto [end, error] = std::from_chars(at, last, out[c]);
        if (error != std::errc() || !std::isfinite(out[c])) return std::nullopt;
        at = end;
    }
    return at == last ? std::optional<glm::dvec3>(out) : std::nullopt;
}

}  // namespace clgi::program
