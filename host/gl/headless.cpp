// SPDX-License-Identifier: MIT
#include <clgi/gl/context.hpp>

#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <clgi/error.hpp>
#include <cstdio>
#include <vector>

namespace clgi::gl {
namespace {

bool lists(const char* extensions, const char* wanted) {
    return extensions && epoxy_extension_in_string(extensions, wanted);
}

std::string egl_error() {
    char text[32];
    std::snprintf(text, sizeof text, "EGL error 0x%04x", static_cast<unsigned>(eglGetError()));
    return text;
}

// A display counts its users where it can; otherwise it may be someone else's too, and is never
// given back.
EGLDisplay open_display(EGLenum platform, void* native, bool counted) {
    const EGLint count[] = {EGL_TRACK_REFERENCES_KHR, EGL_TRUE, EGL_NONE};
    return eglGetPlatformDisplayEXT(platform, native, counted ? count : nullptr);
}

}  // namespace

HeadlessContext::HeadlessContext() {
    const std::string failed = "gl: no OpenGL context without a window: ";
    const std::string install = " (Debian: libegl1, libgl1, libgl1-mesa-dri)";
    if (!epoxy_has_egl()) throw DeviceError(failed + "libEGL.so.1 is not there" + install);
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    if (!lists(client, "EGL_EXT_platform_base"))
        throw DeviceError(failed + "EGL does not list EGL_EXT_platform_base" + install);
    counted_ = lists(client, "EGL_KHR_display_reference");

    std::string tried;
    if (lists(client, "EGL_MESA_platform_surfaceless")) {
        if (open(open_display(EGL_PLATFORM_SURFACELESS_MESA, nullptr, counted_), "surfaceless",
                 tried))
            return;
    } else {
        tried = "surfaceless: EGL does not list EGL_MESA_platform_surfaceless";
    }
    if (lists(client, "EGL_EXT_platform_device") &&
        (lists(client, "EGL_EXT_device_enumeration") || lists(client, "EGL_EXT_device_base"))) {
        EGLint count = 0;
        std::vector<EGLDeviceEXT> devices;
        if (eglQueryDevicesEXT(0, nullptr, &count) && count > 0) {
            devices.resize(static_cast<std::size_t>(count));
            if (!eglQueryDevicesEXT(count, devices.data(), &count)) count = 0;
        }
        devices.resize(static_cast<std::size_t>(count));
        if (devices.empty()) tried += "; device: there is none";
        for (std::size_t i = 0; i < devices.size(); ++i)
            if (open(open_display(EGL_PLATFORM_DEVICE_EXT, devices[i], counted_),
                     "device " + std::to_string(i), tried))
                return;
    } else {
        tried += "; device: EGL does not list EGL_EXT_platform_device";
    }
    throw DeviceError(failed + tried + install);
}

// False with the reason added to `why`, and nothing left open.
bool HeadlessContext::open(void* display, const std::string& platform, std::string& why) {
    const auto refuse = [&](const std::string& reason) {
        close();
        why += (why.empty() ? "" : "; ") + platform + ": " + reason;
        return false;
    };
    if (!display) return refuse("no display, " + egl_error());
    EGLint major = 0, minor = 0;
    if (!eglInitialize(display, &major, &minor)) return refuse("no display, " + egl_error());
    display_ = display;

    const EGLenum before = eglQueryAPI();
    if (!eglBindAPI(EGL_OPENGL_API)) return refuse("EGL has OpenGL ES only");
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_PBUFFER_BIT,
                             EGL_NONE};
    EGLConfig config = nullptr;
    EGLint configs = 0;
    const bool found = eglChooseConfig(display, wanted, &config, 1, &configs) && configs == 1;
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION_KHR,
                                 3,
                                 EGL_CONTEXT_MINOR_VERSION_KHR,
                                 3,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK_KHR,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT_KHR,
                                 EGL_NONE};
    if (found) context_ = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    const std::string reason = context_ ? "" : egl_error();
    eglBindAPI(before);
    if (!context_) return refuse("no OpenGL 3.3 core context, " + reason);

    if (!lists(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
        const EGLint pixel[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
        surface_ = eglCreatePbufferSurface(display, config, pixel);
        if (!surface_) return refuse("no surface, " + egl_error());
    }
    if (!eglMakeCurrent(display_, surface_, surface_, context_))
        return refuse("the context cannot be made current, " + egl_error());
    const int version = epoxy_gl_version();
    if (version < 33) return refuse("OpenGL is older than 3.3");
    description_ = platform + ": " + reinterpret_cast<const char*>(glGetString(GL_RENDERER)) +
                   ", OpenGL " + std::to_string(version / 10) + "." + std::to_string(version % 10);
    return true;
}

void HeadlessContext::close() {
    if (!display_) return;
    if (context_) {
        if (eglGetCurrentContext() == context_)
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
    }
    if (surface_) eglDestroySurface(display_, surface_);
    if (counted_) eglTerminate(display_);
    display_ = context_ = surface_ = nullptr;
}

HeadlessContext::~HeadlessContext() { close(); }

void HeadlessContext::make_current() const {
    if (!eglMakeCurrent(display_, surface_, surface_, context_))
        throw DeviceError("gl: the context cannot be made current, " + egl_error());
}

}  // namespace clgi::gl
