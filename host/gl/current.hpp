// The OpenGL context that is current on this thread, whoever made it.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace clgi::gl {

struct CurrentContext {
    enum class Kind { none, egl, glx };
    Kind kind = Kind::none;
    void* context = nullptr;
    void* display = nullptr;
};

CurrentContext current_context();

// Throws Error, begun with `who`, unless desktop OpenGL 3.3 or later is current.
void need_context(const std::string& who);

// Throws Error, begun with `who`, when an earlier call of the caller left an error pending, which
// would pass for one of ours. It is pending no more then.
void need_no_errors(const std::string& who);

// Throws DeviceError, begun with `what`, when OpenGL has an error to report.
void check_errors(const std::string& what);

}  // namespace clgi::gl
