// Messages about a file: of bounded length and one printable line, whatever the file says.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <sstream>
#include <utility>
#include <vector>

namespace clgi::io::gltf {

// Throws InputError. The parts, which may be numbers, are joined to its text.
template <typename... Parts>
[[noreturn]] void fail(const Parts&... parts) {
    std::ostringstream text;
    (text << ... << parts);
    throw InputError(text.str());
}

template <typename... Parts>
void require(bool right, const Parts&... parts) {
    if (!right) fail(parts...);
}

// "nodes[3]"
std::string entry(const char* array, std::size_t index);

// Does the work. What it refuses is said of that place: "nodes[3] has ...", or, where the text
// begins with a point or a bracket, "nodes[3].scale has ...".
template <typename Place, typename Work>
auto within(Place place, Work work) {
    try {
        return work();
    } catch (const InputError& error) {
        const std::string what = error.what();
        fail(place(), what[0] == '.' || what[0] == '[' ? "" : " ", what);
    }
}

template <typename Work>
auto of_entry(const char* array, std::size_t index, Work work) {
    return within([&] { return entry(array, index); }, work);
}

template <typename List, typename Work>
void each(const char* array, List& list, Work work) {
    for (std::size_t i = 0; i < list.size(); ++i) of_entry(array, i, [&] { work(list[i]); });
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
