// Messages about a file: of bounded length and one printable line, whatever the file says.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <string>
#include <utility>
#include <vector>

namespace clgi::io::gltf {

// Throws InputError "<path> <what>".
[[noreturn]] void refuse(const std::string& path, const std::string& what);

// "nodes[3]"
std::string entry(const char* array, std::size_t index);

// Does the work; what it refuses is said of that entry.
template <typename Work>
auto of_entry(const char* array, std::size_t index, Work work) {
    try {
        return work();
    } catch (const InputError& error) {
        refuse(entry(array, index), error.what());
    }
}

// For messages.
std::string printable(const std::string& text);

// A name that is safe to copy to many things.
std::string short_name(const std::string& text);

// The lines that become Scene::warnings: equal ones once, with a count.
class Warnings {
public:
    void add(const std::string& line);
    std::vector<std::string> lines() const;  // in the order of their first appearance

private:
    std::vector<std::pair<std::string, std::size_t>> times_;
    std::size_t left_out_ = 0;
};

}  // namespace clgi::io::gltf
