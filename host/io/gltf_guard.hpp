// What stands before tinygltf: every member that will be read is of its kind and every index in its
// range. tinygltf 2.7 takes what is not of its kind as absent, cuts large numbers to 32 bits,
// aborts on materials that are no objects, and reads past its arrays.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace clgi::io::gltf {

// Throws InputError "nodes[3].mesh is 99, there are 24 meshes" for what breaks the schema. Whole
// numbers that are written like 3.0, which glTF allows, become integers. Members that the schema
// does not name are taken out: in tinygltf's model they would be a hundred times the size of their
// text.
void guard(nlohmann::json& root);

// The schema: an example of a document that has "kind arguments" in place of its values.
//   "name!"         the member may not be absent where what holds it is there
//   "*", "*Texture" every other member whose name ends so
//   [kind, most]    an array of at most so many entries, 2^20 if nothing is said: a million empty
//                   objects take three megabytes of text, and a hundred times that as nodes
//   flag, text, number, above_zero, not_negative
//   whole, count    a whole number, at least 0 or 1; int: one that fits into an int
//   numbers 3       an array of so many numbers; of any number without the 3
//   code, word      a whole number or a string that is among the arguments
//   index nodes     into that array of the root
//   $texture        what the schema says under that name
extern const char* const schema;

}  // namespace clgi::io::gltf
