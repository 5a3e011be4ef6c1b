// SPDX-License-Identifier: MIT
#include "gl/program.hpp"

#include <clgi/shared/gbuffer.h>
#include <clgi/shared/scene.h>

#include <clgi/error.hpp>
#include <cstddef>
#include <cstring>
#include <vector>

#include "gl/embedded.hpp"

namespace clgi::gl {
namespace {

const char* find_source(const char* name) {
    for (unsigned i = 0; i < embedded_shader_count; ++i)
        if (std::strcmp(name, embedded_shaders[i].name) == 0) return embedded_shaders[i].source;
    throw Error(std::string("gl: no embedded shader is called ") + name);
}

// The numbers of clgi/shared/*.h, so that shaders have no copy of them.
std::string constants() {
    std::string text = "#version 330 core\n";
    const auto number = [&](const char* name, long value) {
        text += std::string("#define ") + name + " " + std::to_string(value) + "\n";
    };
    const auto word = [&](const char* name, long value) {
        text += std::string("#define ") + name + " " +
                std::to_string(static_cast<std::uint32_t>(value)) + "u\n";
    };
    constexpr long row = sizeof(float4);
    number("DATA_WIDTH", data_width);
    number("SUBPIXELS", SUBPIXELS);
    number("GUARD_PIXELS", GUARD_PIXELS);
    number("MATERIAL_ROWS", MATERIAL_ROWS);
    number("MATERIAL_BASE", MATERIAL_BASE);
    number("MATERIAL_EMISSION", MATERIAL_EMISSION);
    number("MATERIAL_REFLECTANCE", MATERIAL_REFLECTANCE);
    number("MATERIAL_TEXTURES", offsetof(MaterialRecord, base_texture) / row);
    number("MATERIAL_BASE_UV", MATERIAL_BASE_UV);
    number("MATERIAL_EMISSION_UV", MATERIAL_EMISSION_UV);
    number("TEXTURE_LEVELS_SHIFT", TEXTURE_LEVELS_SHIFT);
    number("ALPHA_BLENDED", static_cast<long>(ALPHA_BLENDED));
    word("TRIANGLE_MATERIAL", TRIANGLE_MATERIAL);
    word("TRIANGLE_MASKED", TRIANGLE_MASKED);
    word("TRIANGLE_DOUBLE_SIDED", TRIANGLE_DOUBLE_SIDED);
    word("TEXTURE_WRAP_S", TEXTURE_WRAP_S);
    word("TEXTURE_WRAP_T", TEXTURE_WRAP_T);
    word("TEXTURE_NEAREST", TEXTURE_NEAREST);
    word("TEXTURE_LINEAR", TEXTURE_LINEAR);
    word("SCENE_HAS_UVS", SCENE_HAS_UVS);
    word("SCENE_HAS_COLORS", SCENE_HAS_COLORS);
    word("SCENE_HAS_TEXTURES", SCENE_HAS_TEXTURES);
    word("SCENE_HAS_EMISSION", SCENE_HAS_EMISSION);
    return text;
}

Object compile(GLenum stage, std::initializer_list<const char*> names) {
    const std::string head = constants();
    std::vector<const char*> sources = {head.c_str()};
    for (const char* name : names) sources.push_back(find_source(name));
    Object shader = make_shader(stage);
    glShaderSource(shader.name(), static_cast<GLsizei>(sources.size()), sources.data(), nullptr);
    glCompileShader(shader.name());
    GLint done = 0;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &done);
    if (!done) {
        char log[4096] = "";
        glGetShaderInfoLog(shader.name(), sizeof log, nullptr, log);
        throw DeviceError(std::string("gl: the shader ") + *(names.end() - 1) +
                          " does not build\n" + log);
    }
    return shader;
}

}  // namespace

Object build_program(std::initializer_list<const char*> vertex,
                     std::initializer_list<const char*> fragment) {
    const Object first = compile(GL_VERTEX_SHADER, vertex);
    const Object second = compile(GL_FRAGMENT_SHADER, fragment);
    Object program = make_program();
    glAttachShader(program.name(), first.name());
    glAttachShader(program.name(), second.name());
    glLinkProgram(program.name());
    GLint done = 0;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &done);
    if (!done) {
        char log[4096] = "";
        glGetProgramInfoLog(program.name(), sizeof log, nullptr, log);
        throw DeviceError(std::string("gl: the program of ") + *(fragment.end() - 1) +
                          " does not link\n" + log);
    }
    return program;
}

GLint uniform(const Object& program, const char* name) {
    return glGetUniformLocation(program.name(), name);
}

}  // namespace clgi::gl
