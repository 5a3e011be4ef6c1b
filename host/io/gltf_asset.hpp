// The version of a document and the extensions that it names.
// SPDX-License-Identifier: MIT
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

// Expects asset_rules to have passed. Throws InputError for another version than 2 and for a
// required extension that is not read. Sets Document::quantized; warns of what is ignored.
void check_asset(const nlohmann::json& root, Document& document);

}  // namespace clgi::io::gltf
