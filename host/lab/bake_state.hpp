// A bake that was cancelled, in a file, so that the next run goes on from there.
//
// The file: "clgi bake state\n", version, the key as length and text, four counts, four arrays as
// length and floats, and a checksum (FNV-1a, 64 bits) of all that. Numbers as the machine has them:
// the file belongs to the machine that wrote it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/light_atlas.hpp>
#include <filesystem>
#include <string>

namespace clgi::lab {

// key: what the bake depends on, scene and options; another key is another bake. The file appears
// whole or not at all. Throws InputError if it cannot be written.
void save_bake_state(const LightAtlasState& state, const std::string& key,
                     const std::filesystem::path& file);

// Throws InputError "FILE: what is wrong" if it cannot be read, is damaged, is of another version
// or belongs to another bake.
LightAtlasState load_bake_state(const std::filesystem::path& file, const std::string& key);

}  // namespace clgi::lab
