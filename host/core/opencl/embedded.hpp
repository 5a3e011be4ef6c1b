// The kernels and their headers that cmake/EmbedTable.cmake compiles in, each file once.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace clgi {

struct EmbeddedFile {
    const char* name;  // "kernels/<folder>/<pass>.cl", "include/clgi/shared/base.h"
    const char* text;
};

extern const EmbeddedFile embedded_files[];
extern const unsigned embedded_file_count;

// The kernels "<folder>/<pass>" as one text, each header once. Throws Error for an unknown name.
std::string kernels_source(const std::vector<std::string>& names);

}  // namespace clgi
