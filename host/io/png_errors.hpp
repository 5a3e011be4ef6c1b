// What libpng calls at an error and at a warning.
// SPDX-License-Identifier: MIT
#pragma once

#include <png.h>

namespace clgi::io {

// To the caller's setjmp.
[[noreturn]] inline void leave_png(png_structp png, png_const_charp) { png_longjmp(png, 1); }

inline void ignore_png(png_structp, png_const_charp) {}

}  // namespace clgi::io
