// The outer shell of a glTF: a .glb's header and chunks, or a bare JSON text, parsed into a JSON
// tree whose nesting is bounded.
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

struct Container {
    Bytes json;
    std::optional<Bytes> binary;  // the BIN chunk
};

// The first `limit` bytes of a regular file, fewer when it is shorter.
std::vector<std::uint8_t> read_file(const std::filesystem::path& path,
                                    std::uint64_t limit = UINT64_MAX);

// Splits the bytes of a file; the parts point into them.
Container open_container(Bytes file);

// Throws InputError for a text that is not JSON or nests deeper than glTF can need.
nlohmann::json parse_json(Bytes text);

}  // namespace clgi::io::gltf
