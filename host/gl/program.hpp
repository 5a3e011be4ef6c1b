// From embedded shaders to an OpenGL program.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>

#include "gl/objects.hpp"

namespace clgi::gl {

// Texels in a row of a DataTexture; every OpenGL 3.3 driver in use allows it.
constexpr int data_width = 4096;

// Each stage is the constants that C++ and GLSL share, then the named shaders in a row.
// Throws DeviceError with the compiler's log.
Object build_program(std::initializer_list<const char*> vertex,
                     std::initializer_list<const char*> fragment);

// Where a uniform is set; -1, which setting ignores, where the program has no such one.
GLint uniform(const Object& program, const char* name);

}  // namespace clgi::gl
