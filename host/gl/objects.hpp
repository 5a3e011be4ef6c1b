// OpenGL objects that delete themselves. The context that made one must be current then.
// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <utility>

namespace clgi::gl {

// One name and how to give it back.
class Object {
public:
    using Delete = void (*)(GLuint);

    Object() = default;
    Object(GLuint name, Delete remove) : name_(name), remove_(remove) {}
    ~Object() {
        if (name_) remove_(name_);
    }
    Object(Object&& other) noexcept
        : name_(std::exchange(other.name_, 0)), remove_(other.remove_) {}
    Object& operator=(Object&& other) noexcept {
        std::swap(name_, other.name_);
        std::swap(remove_, other.remove_);
        return *this;
    }

    GLuint name() const { return name_; }

private:
    GLuint name_ = 0;
    Delete remove_ = nullptr;
};

inline Object make_texture() {
    GLuint name = 0;
    glGenTextures(1, &name);
    return {name, [](GLuint old) { glDeleteTextures(1, &old); }};
}

inline Object make_buffer() {
    GLuint name = 0;
    glGenBuffers(1, &name);
    return {name, [](GLuint old) { glDeleteBuffers(1, &old); }};
}

inline Object make_framebuffer() {
    GLuint name = 0;
    glGenFramebuffers(1, &name);
    return {name, [](GLuint old) { glDeleteFramebuffers(1, &old); }};
}

inline Object make_vertex_array() {
    GLuint name = 0;
    glGenVertexArrays(1, &name);
    return {name, [](GLuint old) { glDeleteVertexArrays(1, &old); }};
}

inline Object make_shader(GLenum stage) {
    return {glCreateShader(stage), [](GLuint old) { glDeleteShader(old); }};
}

inline Object make_program() {
    return {glCreateProgram(), [](GLuint old) { glDeleteProgram(old); }};
}

}  // namespace clgi::gl
