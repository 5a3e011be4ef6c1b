// The flattened kernels that cmake/EmbedTable.cmake compiles in.
// SPDX-License-Identifier: MIT
#pragma once

namespace clgi {

struct EmbeddedKernel {
    const char* name;  // "room/pass"
    const char* source;
};

extern const EmbeddedKernel embedded_kernels[];
extern const unsigned embedded_kernel_count;

}  // namespace clgi
