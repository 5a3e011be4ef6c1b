// SPDX-License-Identifier: MIT
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

constexpr std::size_t longest_name = 128;
constexpr std::size_t longest_quote = 96;

// Cuts UTF-8 between characters.
std::string shortened(std::string text, std::size_t length) {
    if (text.size() <= length) return text;
    while (length > 0 && (static_cast<unsigned char>(text[length]) & 0xC0) == 0x80) --length;
    text.resize(length);
    return text;
}

}  // namespace

void refuse(const std::string& path, const std::string& what) {
    throw InputError(path.empty() ? what : path + " " + what);
}

std::string entry(const char* array, std::size_t index) {
    return std::string(array) + "[" + std::to_string(index) + "]";
}

std::string printable(const std::string& text) {
    std::string line = shortened(text, longest_quote);
    for (char& c : line) {
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    }
    return line.size() < text.size() ? line + "..." : line;
}

std::string short_name(const std::string& text) { return shortened(text, longest_name); }

}  // namespace clgi::io::gltf
