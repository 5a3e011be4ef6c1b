// SPDX-License-Identifier: MIT
#include "io/gltf_text.hpp"

#include <algorithm>
#include <cctype>

namespace clgi::io::gltf {

namespace {

constexpr std::size_t most_warnings = 64;  // different ones; a hostile file could make millions

// Cuts UTF-8 between characters.
std::string shortened(const std::string& text, std::size_t length) {
    if (text.size() <= length) return text;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    return text.substr(0, length);
}

}  // namespace

std::string entry(const char* array, std::size_t index) {
    return std::string(array) + "[" + std::to_string(index) + "]";
}

std::string printable(const std::string& text) {
    std::string line = shortened(text, 96);
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return std::iscntrl(c); }, '?');
    return line.size() < text.size() ? line + "..." : line;
}

std::string short_name(const std::string& text) { return shortened(text, 128); }

void Warnings::add(const std::string& line) {
    const auto known = std::find_if(times_.begin(), times_.end(),
                                    [&](const auto& entry) { return entry.first == line; });
    if (known != times_.end()) {
        ++known->second;
    } else if (times_.size() < most_warnings) {
        times_.emplace_back(line, 1);
    } else {
        ++left_out_;
    }
}

std::vector<std::string> Warnings::lines() const {
    std::vector<std::string> lines;
    for (const auto& [line, times] : times_) {
        lines.push_back(times == 1 ? line : line + " (" + std::to_string(times) + " times)");
    }
    if (left_out_ > 0) lines.push_back("and " + std::to_string(left_out_) + " more warnings");
    return lines;
}

}  // namespace clgi::io::gltf
