// Before tinygltf sees a document: every member that will be read is of its kind and every index
// in its range. tinygltf 2.7 takes what is not of its kind as absent, cuts large numbers to 32
// bits, aborts on materials that are no objects, and reads past its arrays.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "io/gltf_rules.hpp"

namespace clgi::io::gltf {

// Throws InputError "nodes[3].mesh is 99, there are 24 meshes" for the first rule that is broken.
// Whole numbers that are written like 3.0, which glTF allows, become integers.
void guard(nlohmann::json& root, std::span<const Rule> rules);

// An array of the root; an empty one is put where there is none.
nlohmann::json& list_in(nlohmann::json& root, const char* name);

// Takes out what clgi does not read, extras and foreign extensions: in tinygltf's model they would
// be a hundred times the size of their text.
void drop_foreign(nlohmann::json& root);

}  // namespace clgi::io::gltf
