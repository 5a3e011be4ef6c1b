// SPDX-License-Identifier: MIT
#include "io/gltf_warnings.hpp"

namespace clgi::io::gltf {

namespace {

constexpr std::size_t most_lines = 64;  // different ones; a hostile file could make millions

}  // namespace

void Warnings::add(const std::string& line) {
    const auto known = times_.find(line);
    if (known != times_.end()) {
        ++known->second;
    } else if (order_.size() < most_lines) {
        times_.emplace(line, 1);
        order_.push_back(line);
    } else {
        ++left_out_;
    }
}

std::vector<std::string> Warnings::lines() const {
    std::vector<std::string> lines;
    for (const std::string& line : order_) {
        const std::size_t times = times_.at(line);
        lines.push_back(times == 1 ? line : line + " (" + std::to_string(times) + " times)");
    }
    if (left_out_ > 0) lines.push_back("and " + std::to_string(left_out_) + " more warnings");
    return lines;
}

}  // namespace clgi::io::gltf
