// Files, the parts of a .glb, and their JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <vector>

namespace clgi::io::gltf {

using Bytes = std::span<const std::uint8_t>;

// The first `limit` bytes of a regular file, fewer when it is shorter.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path,
                                    std::uint64_t limit = UINT64_MAX);

struct Container {
    Bytes json;
    std::optional<Bytes> binary;  // the BIN chunk
};

// Splits the bytes of a .glb, or takes them for bare JSON. The parts point into them.
Container open_container(Bytes file);

// Throws InputError for a text that is no JSON object or nests deeper than glTF can need.
nlohmann::json parse_json(Bytes text);

}  // namespace clgi::io::gltf
