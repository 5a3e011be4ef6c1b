// Whether OpenCL reads OpenGL's textures directly, through cl_khr_gl_sharing, or from a copy.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <string>
#include <vector>

namespace clgi::gl {

// The properties that a cl::Context needs to share objects with the OpenGL context that is current
// on this thread, by EGL or GLX; ends with 0. Empty if the device cannot share: without
// cl_khr_gl_sharing, or if the OpenGL context is on another device.
// Throws Error when no OpenGL context is current.
CLGI_API std::vector<cl_context_properties> sharing_properties(const cl::Device& device);

// How textures are read. The default copies.
struct Sharing {
    bool zero_copy = false;
    std::string reason = "copied: as asked for";
    bool implicit = false;  // cl_khr_gl_event: acquiring waits for OpenGL

    // Entry points of cl_khr_gl_sharing; needed for zero_copy.
    cl_mem(CL_API_CALL* create)(cl_context, cl_mem_flags, cl_uint target, cl_int level,
                                cl_uint texture, cl_int* error) = nullptr;
    cl_int(CL_API_CALL* acquire)(cl_command_queue, cl_uint count, const cl_mem* objects,
                                 cl_uint wait_count, const cl_event* wait,
                                 cl_event* event) = nullptr;
    cl_int(CL_API_CALL* release)(cl_command_queue, cl_uint count, const cl_mem* objects,
                                 cl_uint wait_count, const cl_event* wait,
                                 cl_event* event) = nullptr;
};

// Zero copy when the device lists cl_khr_gl_sharing and has images, and the context was made with
// sharing_properties() of the OpenGL context that is current; else copied. reason says why, such as
// "copied: device does not list cl_khr_gl_sharing". Throws Error when no OpenGL context is current.
CLGI_API Sharing find_sharing(const cl::Context& context, const cl::Device& device);

}  // namespace clgi::gl
