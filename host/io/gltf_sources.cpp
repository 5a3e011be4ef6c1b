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
    require(header.size() < uri.size() && header.ends_with(";base64"),
            "a data uri that is not base64");
    require(header.find(";;") == header.npos, "a data uri with an empty parameter");
    std::string_view text = uri.substr(header.size() + 1);
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) text.remove_suffix(1);
    require(text.size() % 4 != 1, "a data uri that ends inside a byte");
    const auto is_digit = [](unsigned char c) { return std::isalnum(c) || c == '+' || c == '/'; };
    require(std::all_of(text.begin(), text.end(), is_digit),
            "a data uri with a character outside base64");
    return text;
}

std::vector<std::uint8_t> decoded(std::string_view base64) {
    std::vector<std::uint8_t> bytes;
    std::string type = "data:application/octet-stream;base64,";
    tinygltf::DecodeDataURI(&bytes, type, type + std::string(base64), 0, false);
    return bytes;
}

// The view's compressed form; null where it has none that is read.
const json* packed_form(const json& view) {
    if (!meshopt_codec.built || !view.contains("extensions")) return nullptr;
    const auto found = view["extensions"].find(meshopt_codec.extension);
    return found == view["extensions"].end() ? nullptr : &*found;
}

// The buffers of which only compressed views are shown: their bytes, if there are any, are for
// readers without the extension.
std::vector<bool> find_fallbacks(const json& views, std::size_t buffers) {
    std::vector<bool> shown(buffers), read(buffers);
    for (const json& view : views) {
        const json* packed = packed_form(view);
        shown[view["buffer"].get<std::size_t>()] = true;
        read[(packed ? *packed : view)["buffer"].get<std::size_t>()] = true;
    }
    for (std::size_t i = 0; i < buffers; ++i) shown[i] = shown[i] && !read[i];
    return shown;
}

// Fills document.buffers. Several of them may be in one file, which is read once.
void take_buffers(const json& buffers, const std::vector<bool>& fallbacks,
                  std::optional<Bytes> binary, Document& document) {
    std::size_t longest = 0;
    for (const json& buffer : buffers) {
        longest = std::max(longest, buffer["byteLength"].get<std::size_t>());
    }
    std::map<fs::path, Bytes> known;
    const auto kept = [&](std::vector<std::uint8_t> bytes) {
        return Bytes(document.files.emplace_back(std::move(bytes)));
    };
    const auto bytes_of = [&](const std::string& uri, std::size_t length) {
        if (is_data(uri)) {
            const std::string_view text = base64_of(uri);
            const std::size_t there = text.size() / 4 * 3 + text.size() % 4 * 3 / 4;
            return kept(decoded(text.substr(0, (std::min(length, there) * 4 + 2) / 3)));
        }
        const auto [file, fresh] = known.try_emplace(resolve(document.folder, uri));
        if (fresh) file->second = kept(read_file(file->first, longest));
        return file->second;
    };
    each("buffers", buffers, [&](const json& buffer) {
        const auto length = buffer["byteLength"].get<std::size_t>();
        const bool has_uri = buffer.contains("uri");
        const json::json_pointer fallback("/extensions/EXT_meshopt_compression/fallback");
        if (fallbacks[document.buffers.size()] || (!has_uri && buffer.value(fallback, false))) {
            document.buffers.emplace_back();
            return;
        }
        require(has_uri || (binary && document.buffers.empty()),
                "has no uri and the file no binary chunk for it");
        const Bytes bytes =
            has_uri ? bytes_of(buffer["uri"].get_ref<const std::string&>(), length) : *binary;
        require(bytes.size() >= length, "has ", bytes.size(), " bytes, its byteLength is ", length);
        document.buffers.push_back(bytes.first(length));
    });
}

void check_range(const json& view, const json& buffers) {
    const json& buffer = buffers[view["buffer"].get<std::size_t>()];
    const auto length = view["byteLength"].get<std::size_t>();
    const auto offset = view.value("byteOffset", std::size_t{0});
    const auto there = buffer["byteLength"].get<std::size_t>();
    require(length <= there && offset <= there - length, "is ", length, " bytes at ", offset,
            ", its buffer has ", there);
}

void check_view(const json& view, const json& buffers) {
    check_range(view, buffers);
    if (const json* packed = packed_form(view)) {
        within([] { return std::string(".extensions.") + meshopt_codec.extension; },
               [&] { check_range(*packed, buffers); });
    }
    if (!view.contains("byteStride")) return;
    const auto stride = view["byteStride"].get<std::size_t>();
    require(stride >= 4 && stride <= 252 && stride % 4 == 0, "has a byteStride of ", stride,
            ", not a multiple of 4 up to 252");
    require(view.value("target", 0) != TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER,
            "holds indices, but has a byteStride");
}

Image image_of(const json& source) {
    Image image{short_name(source.value("name", "")),
                source.value("uri", ""),
                source.value("bufferView", -1),
                {}};
    require(source.contains("bufferView") != source.contains("uri"),
            "needs either a bufferView or a uri");
    require(image.view < 0 || source.contains("mimeType"),
            "is in a buffer view, but says no mimeType");
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
    json buffers = std::exchange(root["buffers"], nullptr);
    json& views = root["bufferViews"];
    take_buffers(buffers, find_fallbacks(views, buffers.size()), binary, document);
    std::size_t held = 0;
    for (const std::vector<std::uint8_t>& file : document.files) held += file.size();
    document.unpacking = UnpackBudget(held);
    each("bufferViews", views, [&](json& view) {
        check_view(view, buffers);
        if constexpr (meshopt_codec.built) {
            if (packed_form(view)) unpack_view(view, document);
        }
        view.erase("extensions");
    });
    json images = std::exchange(root["images"], nullptr);
    each("images", images, [&](const json& image) { document.images.push_back(image_of(image)); });
}

Bytes image_bytes(const Document& document, const Image& image, std::size_t limit,
                  std::vector<std::uint8_t>& held) {
    if (image.view >= 0) {
        const tinygltf::BufferView& view = document.model.bufferViews[image.view];
        const Bytes buffer = document.buffers[view.buffer];
        require(!buffer.empty(), "is in a buffer without data");
        return buffer.subspan(view.byteOffset, view.byteLength);
    }
    held = is_data(image.uri) ? decoded(base64_of(image.uri).substr(0, limit / 3 * 4 + 4))
                              : read_file(resolve(document.folder, image.uri), limit);
    return held;
}

}  // namespace clgi::io::gltf
