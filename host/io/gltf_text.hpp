// Text from a file as it may appear in a message or a name: of bounded length, and in a message
// one printable line.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <string>

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

std::string printable(const std::string& text);

// Safe to copy to many things.
std::string short_name(const std::string& text);

}  // namespace clgi::io::gltf
