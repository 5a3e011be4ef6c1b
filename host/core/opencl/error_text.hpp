// OpenCL's error codes in words.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <string>

namespace clgi {

// "out of device memory (CL_MEM_OBJECT_ALLOCATION_FAILURE, OpenCL error -4)".
CLGI_API std::string error_text(int code);

// Whether the call was wrong, rather than the device: objects of different contexts, or a pass on
// a queue of another device than it was built for.
bool is_wrong_call(int code);

}  // namespace clgi
