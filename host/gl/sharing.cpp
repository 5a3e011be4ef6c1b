// SPDX-License-Identifier: MIT
#include "gl/sharing.hpp"

#include <CL/cl_gl.h>

#include <algorithm>
#include <cstdint>
#include <sstream>

#include "gl/current.hpp"

namespace clgi::gl {
namespace {

constexpr const char* sharing_extension = "cl_khr_gl_sharing";

cl_platform_id platform_of(const cl::Device& device) {
    return device.getInfo<CL_DEVICE_PLATFORM>();
}

// An entry point of an extension; nullptr where the platform lacks it.
template <typename Function>
bool find(cl_platform_id platform, const char* name, Function& function) {
    function = reinterpret_cast<Function>(clGetExtensionFunctionAddressForPlatform(platform, name));
    return function != nullptr;
}

// What the properties of a context say under this key; 0: nothing.
cl_context_properties value_of(const std::vector<cl_context_properties>& properties,
                               cl_context_properties key) {
    for (std::size_t i = 0; i + 1 < properties.size() && properties[i] != 0; i += 2)
        if (properties[i] == key) return properties[i + 1];
    return 0;
}

// Which devices the OpenGL context can be shared with, by the driver's own word.
bool shares_with(const cl::Device& device, const std::vector<cl_context_properties>& properties) {
    clGetGLContextInfoKHR_fn info = nullptr;
    if (!find(platform_of(device), "clGetGLContextInfoKHR", info)) return false;
    std::size_t bytes = 0;
    if (info(properties.data(), CL_DEVICES_FOR_GL_CONTEXT_KHR, 0, nullptr, &bytes) != CL_SUCCESS)
        return false;
    std::vector<cl_device_id> devices(bytes / sizeof(cl_device_id));
    if (devices.empty() || info(properties.data(), CL_DEVICES_FOR_GL_CONTEXT_KHR, bytes,
                                devices.data(), nullptr) != CL_SUCCESS)
        return false;
    return std::find(devices.begin(), devices.end(), device()) != devices.end();
}

}  // namespace

bool lists_extension(const std::string& extensions, const std::string& wanted) {
    std::istringstream names(extensions);
    for (std::string name; names >> name;)
        if (name == wanted) return true;
    return false;
}

std::vector<cl_context_properties> sharing_properties(const cl::Device& device) {
    need_context("gl.sharing");
    if (!lists_extension(device.getInfo<CL_DEVICE_EXTENSIONS>(), sharing_extension)) return {};
    const CurrentContext gl = current_context();
    const auto property = [](const void* pointer) {
        return static_cast<cl_context_properties>(reinterpret_cast<std::intptr_t>(pointer));
    };
    const cl_context_properties display =
        gl.kind == CurrentContext::Kind::egl ? CL_EGL_DISPLAY_KHR : CL_GLX_DISPLAY_KHR;
    const std::vector<cl_context_properties> out = {CL_CONTEXT_PLATFORM,
                                                    property(platform_of(device)),
                                                    CL_GL_CONTEXT_KHR,
                                                    property(gl.context),
                                                    display,
                                                    property(gl.display),
                                                    0};
    return shares_with(device, out) ? out : std::vector<cl_context_properties>();
}

Sharing decide(const SharingCapabilities& analysis) {
    const auto copied = [](const std::string& reason) {
        Sharing out;
        out.reason = "copied: " + reason;
        return out;
    };
    if (!lists_extension(analysis.extensions, sharing_extension))
        return copied(std::string("device does not list ") + sharing_extension);
    if (!analysis.images) return copied("device has no images");
    const cl_context_properties shared = value_of(analysis.properties, CL_GL_CONTEXT_KHR);
    if (shared == 0) return copied("OpenCL context was made without CL_GL_CONTEXT_KHR");
    if (reinterpret_cast<void*>(static_cast<std::intptr_t>(shared)) != analysis.current)
        return copied("OpenCL context was made for another OpenGL context than the current one");
    if (!analysis.missing.empty()) return copied("OpenCL platform lacks " + analysis.missing);
    Sharing out;
    out.zero_copy = true;
    out.reason = std::string("zero copy: ") + sharing_extension;
    out.implicit = lists_extension(analysis.extensions, "cl_khr_gl_event");
    return out;
}

Sharing find_sharing(const cl::Context& context, const cl::Device& device) {
    need_context("gl.sharing");
    SharingCapabilities analysis;
    analysis.extensions = device.getInfo<CL_DEVICE_EXTENSIONS>();
    analysis.images = device.getInfo<CL_DEVICE_IMAGE_SUPPORT>() != 0;
    // Some drivers (PoCL 3.1) crash when asked for the properties of a context without any.
    if (lists_extension(analysis.extensions, sharing_extension))
        analysis.properties = context.getInfo<CL_CONTEXT_PROPERTIES>();
    analysis.current = current_context().context;
    Sharing out = decide(analysis);
    if (!out.zero_copy) return out;

    const cl_platform_id platform = platform_of(device);
    if (!find(platform, "clCreateFromGLTexture", out.create))
        analysis.missing = "clCreateFromGLTexture";
    else if (!find(platform, "clEnqueueAcquireGLObjects", out.acquire))
        analysis.missing = "clEnqueueAcquireGLObjects";
    else if (!find(platform, "clEnqueueReleaseGLObjects", out.release))
        analysis.missing = "clEnqueueReleaseGLObjects";
    return analysis.missing.empty() ? out : decide(analysis);
}

}  // namespace clgi::gl
