// SPDX-License-Identifier: MIT
#include "io/gltf_container.hpp"

#include <algorithm>
#include <clgi/error.hpp>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

namespace clgi::io::gltf {

namespace {

constexpr std::uint32_t glb_magic = 0x46546C67;   // "glTF"
constexpr std::uint32_t json_chunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t bin_chunk = 0x004E4942;   // "BIN\0"

// glTF nests about ten deep; the rest is for extras. Parsers and printers of JSON recurse.
constexpr int deepest_nesting = 256;

std::uint32_t little_endian(Bytes bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8 |
           std::uint32_t{bytes[at + 2]} << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

Container open_glb(Bytes file) {
    if (file.size() < 20) throw InputError("a GLB of " + std::to_string(file.size()) + " bytes");
    const std::uint32_t version = little_endian(file, 4);
    if (version != 2) throw InputError("GLB version " + std::to_string(version) + ", not 2");
    const std::uint32_t length = little_endian(file, 8);
    if (length != file.size()) {
        throw InputError("the GLB header says " + std::to_string(length) + " bytes, the file has " +
                         std::to_string(file.size()));
    }

    Container container;
    int chunk = 0;
    for (std::size_t at = 12; at < file.size(); ++chunk) {
        if (file.size() - at < 8) throw InputError("the GLB ends inside a chunk header");
        const std::uint32_t bytes = little_endian(file, at);
        const std::uint32_t type = little_endian(file, at + 4);
        at += 8;
        if (bytes > file.size() - at) throw InputError("the GLB ends inside a chunk");
        if (bytes % 4 != 0) throw InputError("a GLB chunk of a length not divisible by 4");
        if ((chunk == 0) != (type == json_chunk)) {
            throw InputError(chunk == 0 ? "the first GLB chunk is not JSON"
                                        : "a second JSON chunk in the GLB");
        }
        if (type == json_chunk) container.json = file.subspan(at, bytes);
        if (type == bin_chunk) {
            if (chunk != 1) throw InputError("a BIN chunk that is not the second of the GLB");
            container.binary = file.subspan(at, bytes);
        }
        at += bytes;
    }
    return container;
}

void check_nesting(Bytes text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = static_cast<char>(text[i]);
        if (quoted) {
            if (c == '\\') ++i;
            if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > deepest_nesting) {
                throw InputError("JSON nested deeper than " + std::to_string(deepest_nesting));
            }
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

}  // namespace

std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t limit) {
    std::error_code error;
    // Not a folder, and not a pipe or device either: those block or never end.
    if (!std::filesystem::is_regular_file(path, error)) {
        throw InputError(std::filesystem::exists(path, error) ? "not a file" : "no such file");
    }
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    if (error || !stream) throw InputError("cannot be opened");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(size, limit)));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    if (static_cast<std::size_t>(stream.gcount()) != bytes.size()) {
        throw InputError("cannot be read to its end");
    }
    return bytes;
}

Container open_container(Bytes file) {
    if (file.size() >= 4 && little_endian(file, 0) == glb_magic) return open_glb(file);
    if (file.empty()) throw InputError("the file is empty");
    return {file, std::nullopt};
}

nlohmann::json parse_json(Bytes text) {
    if (text.size() >= 3 && text[0] == 0xEF && text[1] == 0xBB && text[2] == 0xBF) {
        throw InputError("the JSON begins with a byte order mark");
    }
    check_nesting(text);
    try {
        nlohmann::json json = nlohmann::json::parse(text.begin(), text.end());
        if (!json.is_object()) throw InputError("the JSON is not an object");
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        throw InputError("neither a GLB nor JSON: syntax error at byte " +
                         std::to_string(error.byte));
    } catch (const nlohmann::json::exception&) {
        throw InputError("a number in the JSON is too large");
    }
}

}  // namespace clgi::io::gltf
