// SPDX-License-Identifier: MIT
#include "gl/current.hpp"

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <clgi/error.hpp>
#include <cstdio>

namespace clgi::gl {
namespace {

// A GLX context can be current only where the library that made it is loaded already; asking the
// loader for it spares everybody else X11.
void* glx_current(const char* function) {
    for (const char* library : {"libGLX.so.0", "libGL.so.1"}) {
        void* loaded = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
        if (!loaded) continue;
        using Get = void* (*)();
        const auto get = reinterpret_cast<Get>(dlsym(loaded, function));
        void* const current = get ? get() : nullptr;
        dlclose(loaded);
        if (current) return current;
    }
    return nullptr;
}

std::string code_of(GLenum error) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%04x", error);
    return text;
}

}  // namespace

CurrentContext current_context() {
    using Kind = CurrentContext::Kind;
    if (epoxy_has_egl())
        if (void* const context = eglGetCurrentContext())
            return {Kind::egl, context, eglGetCurrentDisplay()};
    if (void* const context = glx_current("glXGetCurrentContext"))
        return {Kind::glx, context, glx_current("glXGetCurrentDisplay")};
    return {};
}

void need_context(const std::string& who) {
    const std::string needed = ", OpenGL 3.3 or later needed";
    if (current_context().kind == CurrentContext::Kind::none)
        throw Error(who + ": no OpenGL context is current on this thread" + needed);
    const int version = epoxy_gl_version();
    if (!epoxy_is_desktop_gl() || version < 33)
        throw Error(who + ": the current context is OpenGL " +
                    (epoxy_is_desktop_gl() ? "" : "ES ") + std::to_string(version / 10) + "." +
                    std::to_string(version % 10) + needed);
}

void need_no_errors(const std::string& who) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    for (int i = 0; i < 8 && glGetError() != GL_NO_ERROR; ++i) continue;  // one flag a kind
    throw Error(who + ": OpenGL error " + code_of(error) + " is pending from an earlier call");
}

void check_errors(const std::string& what) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    throw DeviceError(what + " failed with OpenGL error " + code_of(error) +
                      (error == GL_OUT_OF_MEMORY ? " (out of memory)" : ""));
}

}  // namespace clgi::gl
