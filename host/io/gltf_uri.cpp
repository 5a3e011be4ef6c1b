// SPDX-License-Identifier: MIT
#include "io/gltf_uri.hpp"

#include <algorithm>
#include <cctype>
#include <clgi/error.hpp>
#include <system_error>

#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace fs = std::filesystem;

namespace {

bool is_base64(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '+' ||
           c == '/';
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    const int letter = std::tolower(static_cast<unsigned char>(c));
    return letter >= 'a' && letter <= 'f' ? letter - 'a' + 10 : -1;
}

// A percent sign that begins no code stands for itself.
std::string percent_decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool code = uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 &&
                          hex_digit(uri[i + 2]) >= 0;
        if (!code) {
            text += uri[i];
            continue;
        }
        text += static_cast<char>(hex_digit(uri[i + 1]) * 16 + hex_digit(uri[i + 2]));
        i += 2;
    }
    return text;
}

// "file:", "http:", and on Windows "C:"
bool has_scheme(const std::string& uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string::npos || colon == 0) return false;
    return std::all_of(uri.begin(), uri.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.';
    });
}

bool is_inside(const fs::path& folder, const fs::path& file) {
    const auto [end, rest] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
    return end == folder.end() && rest != file.end();
}

}  // namespace

bool is_data_uri(std::string_view uri) { return uri.substr(0, 5) == "data:"; }

std::string_view data_uri_type(std::string_view uri) {
    return uri.substr(5, uri.find_first_of(";,") - 5);
}

std::string_view data_uri_base64(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    constexpr std::string_view marker = ";base64";
    if (comma == std::string_view::npos || comma < marker.size() ||
        uri.substr(comma - marker.size(), marker.size()) != marker) {
        throw InputError("a data uri that is not base64");
    }
    if (uri.substr(0, comma).find(";;") != std::string_view::npos) {
        throw InputError("a data uri with an empty parameter");
    }
    std::string_view text = uri.substr(comma + 1);
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    if (text.size() % 4 == 1) throw InputError("a data uri that ends inside a byte");
    if (!std::all_of(text.begin(), text.end(), is_base64)) {
        throw InputError("a data uri with a character outside base64");
    }
    return text;
}

fs::path resolve_uri(const fs::path& folder, const std::string& uri) {
    const std::string quoted = "uri \"" + printable(uri) + "\"";
    const std::string outside = quoted + " is not a file in the folder of the scene";
    if (has_scheme(uri)) throw InputError(outside);

    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    // Exporters disagree whether a percent sign in a file's name is encoded: try both.
    for (const std::string& name : {percent_decoded(uri), uri}) {
        const fs::path relative(name);
        if (name.empty() || name.find('\0') != std::string::npos || name[0] == '/' ||
            name[0] == '\\' || relative.has_root_path() ||
            *relative.lexically_normal().begin() == "..") {
            throw InputError(outside);
        }
        const fs::path file = fs::canonical(root / relative, error);
        if (error) continue;
        if (!is_inside(root, file)) throw InputError(outside);
        return file;
    }
    throw InputError(quoted + " names no file");
}

}  // namespace clgi::io::gltf
