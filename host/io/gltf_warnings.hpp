// The lines that become Scene::warnings: equal ones once, with a count.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace clgi::io::gltf {

class Warnings {
public:
    void add(const std::string& line);
    std::vector<std::string> lines() const;  // in the order of their first appearance

private:
    std::map<std::string, std::size_t> times_;
    std::vector<std::string> order_;
    std::size_t left_out_ = 0;
};

}  // namespace clgi::io::gltf
