// Files, the parts of a .glb, and their JSON.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <system_error>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

// glTF nests about ten deep; the rest is for extras. Parsers and printers of JSON recurse.
constexpr int deepest_nesting = 256;

std::uint32_t little_endian(Bytes bytes, std::size_t at) {
    return std::uint32_t{bytes[at]} | std::uint32_t{bytes[at + 1]} << 8 |
           std::uint32_t{bytes[at + 2]} << 16 | std::uint32_t{bytes[at + 3]} << 24;
}

Container open_glb(Bytes file) {
    require(file.size() >= 20, "a GLB of ", file.size(), " bytes");
    const std::uint32_t version = little_endian(file, 4);
    require(version == 2, "GLB version ", version, ", not 2");
    const std::uint32_t length = little_endian(file, 8);
    require(length == file.size(), "the GLB header says ", length, " bytes, the file has ",
            file.size());
    Container container;
    int chunk = 0;
    for (std::size_t at = 12; at < file.size(); ++chunk) {
        require(file.size() - at >= 8, "the GLB ends inside a chunk header");
        const std::uint32_t bytes = little_endian(file, at);
        const bool is_json = little_endian(file, at + 4) == 0x4E4F534A;    // "JSON"
        const bool is_binary = little_endian(file, at + 4) == 0x004E4942;  // "BIN\0"
        at += 8;
        require(bytes <= file.size() - at, "the GLB ends inside a chunk");
        require(bytes % 4 == 0, "a GLB chunk of a length not divisible by 4");
        require(is_json || chunk != 0, "the first GLB chunk is not JSON");
        require(!is_json || chunk == 0, "a second JSON chunk in the GLB");
        require(!is_binary || chunk == 1, "a BIN chunk that is not the second of the GLB");
        if (is_json) container.json = file.subspan(at, bytes);
        if (is_binary) container.binary = file.subspan(at, bytes);
        at += bytes;
    }
    return container;
}

void check_nesting(Bytes text) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = static_cast<char>(text[i]);
        if (c == '"') quoted = !quoted;
        if (quoted && c == '\\') ++i;
        if (quoted) continue;
        depth += (c == '{' || c == '[') - (c == '}' || c == ']');
        require(depth <= deepest_nesting, "JSON nested deeper than ", deepest_nesting);
    }
}

}  // namespace

std::vector<std::uint8_t> read_file(const std::filesystem::path& path, std::uint64_t limit) {
    std::error_code error;
    // Not a folder, and not a pipe or device either: those block or never end.
    require(std::filesystem::is_regular_file(path, error),
            std::filesystem::exists(path, error) ? "not a file" : "no such file");
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    std::ifstream stream(path, std::ios::binary);
    require(!error && stream.is_open(), "cannot be opened");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(size, limit)));
    stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    require(!stream.fail(), "cannot be read to its end");
    return bytes;
}

Container open_container(Bytes file) {
    require(!file.empty(), "the file is empty");
    const bool is_glb = file.size() >= 4 && little_endian(file, 0) == 0x46546C67;  // "glTF"
    return is_glb ? open_glb(file) : Container{file, std::nullopt};
}

nlohmann::json parse_json(Bytes text) {
    require(text.size() < 3 || text[0] != 0xEF || text[1] != 0xBB || text[2] != 0xBF,
            "the JSON begins with a byte order mark");
    check_nesting(text);
    try {
        nlohmann::json json = nlohmann::json::parse(text.begin(), text.end());
        require(json.is_object(), "the JSON is not an object");
        return json;
    } catch (const nlohmann::json::parse_error& error) {
        fail("neither a GLB nor JSON: syntax error at byte ", error.byte);
    } catch (const nlohmann::json::exception&) {
        fail("a number in the JSON is too large");
    }
}

}  // namespace clgi::io::gltf
