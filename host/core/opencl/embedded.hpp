// The kernels and their headers that cmake/EmbedTable.cmake compiles in, each file once.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace clgi {

struct EmbeddedFile {
    const char* name;  // "kernels/<folder>/<pass>.cl", "include/clgi/shared/base.h"
    const char* text;
};

extern const EmbeddedFile embedded_files[];
extern const unsigned embedded_file_count;

// Throws Error unless there is a kernel "<folder>/<pass>".
void need_kernel(const std::string& name);

}  // namespace clgi
