// Where the bytes of buffers and images are: in the file itself, in data uris, or in files of the
// scene's folder.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cctype>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

// A percent sign that begins no code stands for itself.
std::string percent_decoded(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        unsigned code = 0;
        const char* digits = uri.data() + i + 1;
        const bool coded = uri[i] == '%' && i + 2 < uri.size() &&
                           std::from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
        text += coded ? static_cast<char>(code) : uri[i];
        if (coded) i += 2;
    }
    return text;
}

// "file:", "http:", and on Windows "C:"
bool has_scheme(const std::string& uri) {
    const std::size_t colon = uri.find(':');
    if (colon == std::string::npos || colon == 0) return false;
    return std::all_of(uri.data(), uri.data() + colon, [](unsigned char c) {
        return std::isalnum(c) || c == '+' || c == '-' || c == '.';
    });
}

// The existing file that a relative uri names: links followed, inside the folder.
fs::path resolve(const fs::path& folder, const std::string& uri) {
    const std::string quoted = "uri \"" + printable(uri) + "\"";
    const InputError outside(quoted + " is not a file in the folder of the scene");
    if (has_scheme(uri)) throw outside;

    std::error_code error;
    const fs::path root = fs::canonical(folder.empty() ? fs::path(".") : folder, error);
    // Exporters disagree whether a percent sign in a file's name is encoded: try both.
    for (const std::string& name : {percent_decoded(uri), uri}) {
        if (name.empty() || name.find('\0') != std::string::npos || name[0] == '\\' ||
            fs::path(name).has_root_path() || *fs::path(name).lexically_normal().begin() == "..") {
            throw outside;
        }
        const fs::path file = fs::canonical(root / name, error);
        if (error) continue;
        const auto [end, rest] = std::mismatch(root.begin(), root.end(), file.begin(), file.end());
        if (end != root.end() || rest == file.end()) throw outside;
        return file;
    }
    throw InputError(quoted + " names no file");
}

bool is_data(std::string_view uri) { return uri.starts_with("data:"); }

// The text of "data:<type>;base64,<text>" without its padding.
std::string_view base64_of(std::string_view uri) {
    const std::string_view header = uri.substr(0, uri.find(','));
    if (header.size() == uri.size() || !header.ends_with(";base64")) {
        throw InputError("a data uri that is not base64");
    }
    if (header.find(";;") != std::string_view::npos) {
        throw InputError("a data uri with an empty parameter");
    }
    std::string_view text = uri.substr(header.size() + 1);
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    if (text.size() % 4 == 1) throw InputError("a data uri that ends inside a byte");
    const auto is_digit = [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '/'; };
    if (!std::all_of(text.begin(), text.end(), is_digit)) {
        throw InputError("a data uri with a character outside base64");
    }
    return text;
}

std::vector<std::uint8_t> decoded(std::string_view base64) {
    std::vector<std::uint8_t> bytes;
    std::string type = "data:application/octet-stream;base64,";
    tinygltf::DecodeDataURI(&bytes, type, type + std::string(base64), 0, false);
    return bytes;
}

void require_length(std::size_t there, std::size_t declared) {
    if (there >= declared) return;
    throw InputError("has " + std::to_string(there) + " bytes, its byteLength is " +
                     std::to_string(declared));
}

struct File {
    std::size_t wanted = 0;
    Bytes bytes;
};

class BufferSources {
public:
    BufferSources(const json& buffers, std::optional<Bytes> binary, Document& document)
        : binary_(binary), document_(document), file_of_(buffers.size()) {
        // Several buffers may be in one file, which is read once.
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            of_entry("buffers", i, [&] { find_file(buffers[i], i); });
        }
        for (std::size_t i = 0; i < buffers.size(); ++i) {
            of_entry("buffers", i, [&] { take(buffers[i], i); });
        }
    }

private:
    void find_file(const json& buffer, std::size_t index) {
        const std::string uri = buffer.value("uri", "data:");
        if (is_data(uri)) return;
        file_of_[index] = &*files_.try_emplace(resolve(document_.folder, uri)).first;
        std::size_t& wanted = file_of_[index]->second.wanted;
        wanted = std::max(wanted, buffer["byteLength"].get<std::size_t>());
    }

    Bytes kept(std::vector<std::uint8_t> bytes) {
        return document_.files.emplace_back(std::move(bytes));
    }

    void take(const json& buffer, std::size_t index) {
        const auto length = buffer["byteLength"].get<std::size_t>();
        const json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
        Bytes bytes;
        if (file_of_[index]) {
            auto& [path, file] = *file_of_[index];
            if (file.bytes.empty()) file.bytes = kept(read_file(path, file.wanted));
            bytes = file.bytes;
        } else if (buffer.contains("uri")) {
            const std::string_view text = base64_of(buffer["uri"].get_ref<const std::string&>());
            require_length(text.size() / 4 * 3 + text.size() % 4 * 3 / 4, length);
            bytes = kept(decoded(text.substr(0, (length * 4 + 2) / 3)));
        } else if (buffer.value(fallback, false)) {
            document_.buffers.emplace_back();
            return;
        } else if (index == 0 && binary_) {
            bytes = *binary_;
        } else {
            throw InputError("has no uri and the file no binary chunk for it");
        }
        require_length(bytes.size(), length);
        document_.buffers.push_back(bytes.first(length));
    }

    using Files = std::map<fs::path, File>;

    std::optional<Bytes> binary_;
    Document& document_;
    Files files_;
    std::vector<Files::value_type*> file_of_;  // of the buffers, null: none
};

void check_view(const json& view, const json& buffer) {
    const auto length = view["byteLength"].get<std::size_t>();
    const auto offset = view.value("byteOffset", std::size_t{0});
    const auto there = buffer["byteLength"].get<std::size_t>();
    if (length > there || offset > there - length) {
        throw InputError("is " + std::to_string(length) + " bytes at " + std::to_string(offset) +
                         ", its buffer has " + std::to_string(there));
    }
    if (!view.contains("byteStride")) return;
    const auto stride = view["byteStride"].get<std::size_t>();
    if (stride < 4 || stride > 252 || stride % 4 != 0) {
        throw InputError("has a byteStride of " + std::to_string(stride) +
                         ", not a multiple of 4 up to 252");
    }
    if (view.value("target", 0) == TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER) {
        throw InputError("holds indices, but has a byteStride");
    }
}

Image image_of(const json& source) {
    Image image{short_name(source.value("name", "")),
                source.value("uri", ""),
                source.value("bufferView", -1),
                {}};
    if (source.contains("bufferView") == source.contains("uri")) {
        throw InputError("needs either a bufferView or a uri");
    }
    if (image.view >= 0 && !source.contains("mimeType")) {
        throw InputError("is in a buffer view, but says no mimeType");
    }
    if (is_data(image.uri)) {
        base64_of(image.uri);
        const std::string header = image.uri.substr(5, image.uri.find_first_of(";,") - 5);
        image.types = {header, source.value("mimeType", "")};
    } else if (image.name.empty()) {
        image.name = printable(image.uri);
    }
    return image;
}

}  // namespace

void take_sources(json& root, std::optional<Bytes> binary, Document& document) {
    const json buffers = std::exchange(root["buffers"], json::array());
    BufferSources(buffers, binary, document);
    const json& views = root["bufferViews"];
    for (std::size_t i = 0; i < views.size(); ++i) {
        of_entry("bufferViews", i,
                 [&] { check_view(views[i], buffers[views[i]["buffer"].get<std::size_t>()]); });
    }
    const json images = std::exchange(root["images"], json::array());
    for (std::size_t i = 0; i < images.size(); ++i) {
        of_entry("images", i, [&] { document.images.push_back(image_of(images[i])); });
    }
}

Bytes image_bytes(const Document& document, const Image& image, std::size_t limit,
                  std::vector<std::uint8_t>& held) {
    if (image.view >= 0) {
        const tinygltf::BufferView& view = document.model.bufferViews[image.view];
        const Bytes buffer = document.buffers[view.buffer];
        if (buffer.empty()) throw InputError("is in a buffer without data");
        return buffer.subspan(view.byteOffset, view.byteLength);
    }
    held = is_data(image.uri) ? decoded(base64_of(image.uri).substr(0, limit / 3 * 4 + 4))
                              : read_file(resolve(document.folder, image.uri), limit);
    return held;
}

}  // namespace clgi::io::gltf
