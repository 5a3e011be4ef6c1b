// What a glTF uri may be: data inside the file, or a file in the folder of the scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace clgi::io::gltf {

bool is_data_uri(std::string_view uri);

// The media type of a data uri, "" when it names none.
std::string_view data_uri_type(std::string_view uri);

// The text of "data:<type>;base64,<text>" without its padding. Throws InputError for a uri of
// another form and for text that is not base64.
std::string_view data_uri_base64(std::string_view uri);

// The existing file that a relative uri names. Throws InputError for any other scheme, for a file
// that does not exist, and for one that is, links followed, outside the folder.
std::filesystem::path resolve_uri(const std::filesystem::path& folder, const std::string& uri);

}  // namespace clgi::io::gltf
