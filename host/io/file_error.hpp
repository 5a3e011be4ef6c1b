// What is said of a file that cannot be read or written.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/error.hpp>
#include <filesystem>
#include <string>

namespace clgi::io {

[[noreturn]] inline void fail(const std::filesystem::path& path, const std::string& what) {
    throw InputError(path.string() + ": " + what);
}

}  // namespace clgi::io
