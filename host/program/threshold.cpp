// SPDX-License-Identifier: MIT
#include "program/threshold.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>

namespace clgi::program {

float parse_threshold(const std::string& flag, const std::string& text,
                      std::initializer_list<std::pair<const char*, float>> words) {
    std::string known;
    for (const auto& [word, value] : words) {
        if (text == word) return value;
        known += (known.empty() ? "" : ", ") + std::string(word);
    }
    std::size_t used = 0;
    float value = -1.0f;
    try {
        value = std::stof(text, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used != text.size() || !(value >= 0.0f))
        throw Error(fmt::format("render: {} is '{}', {} or a threshold of at least 0 needed", flag,
                                text, known));
    return value;
}

}  // namespace clgi::program
