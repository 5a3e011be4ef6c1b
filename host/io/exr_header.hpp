// A first look at an OpenEXR file, before the library sees it.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

namespace clgi::io {

// Throws InputError when an attribute of a header does not have the size that it claims: OpenEXR
// allocates what a header claims before it reads it, up to 2 GiB an attribute.
void check_exr_attributes(const std::filesystem::path& path);

}  // namespace clgi::io
