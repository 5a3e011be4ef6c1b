// The shaders that cmake/EmbedFiles.cmake compiles in.
// SPDX-License-Identifier: MIT
#pragma once

namespace clgi::gl {

struct EmbeddedShader {
    const char* name;  // "resolve_fragment"
    const char* source;
};

extern const EmbeddedShader embedded_shaders[];
extern const unsigned embedded_shader_count;

}  // namespace clgi::gl
