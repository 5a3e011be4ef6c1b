// Functions of OpenCL that count, fail where they are told to, and call the loader's.
// SPDX-License-Identifier: MIT
#include "opencl_calls.hpp"

#include <dlfcn.h>

namespace clgi::test {

Calls calls;

namespace {

// Counts down to the call that is to fail.
bool fails(std::atomic<int>& countdown) { return countdown > 0 && --countdown == 0; }

template <typename Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace
}  // namespace clgi::test

#define CLGI_NEXT(function) clgi::test::next<decltype(function)>(#function)

extern "C" {

cl_mem clCreateBuffer(cl_context context, cl_mem_flags flags, size_t size, void* host,
                      cl_int* error) {
    using namespace clgi::test;
    ++calls.buffers;
    calls.bytes += static_cast<int>(size);
    if (fails(calls.fail_buffer)) {
        if (error) *error = calls.code;
        return nullptr;
    }
    return CLGI_NEXT(clCreateBuffer)(context, flags, size, host, error);
}

cl_kernel clCreateKernel(cl_program program, const char* name, cl_int* error) {
    ++clgi::test::calls.kernels;
    return CLGI_NEXT(clCreateKernel)(program, name, error);
}

cl_int clBuildProgram(cl_program program, cl_uint count, const cl_device_id* devices,
                      const char* options, void (*notify)(cl_program, void*), void* data) {
    ++clgi::test::calls.builds;
    const std::string all = options + clgi::test::calls.build_option;
    return CLGI_NEXT(clBuildProgram)(program, count, devices, all.c_str(), notify, data);
}

cl_int clGetDeviceIDs(cl_platform_id platform, cl_device_type type, cl_uint most,
                      cl_device_id* devices, cl_uint* count) {
    if (clgi::test::calls.fail_devices != CL_SUCCESS) return clgi::test::calls.fail_devices;
    return CLGI_NEXT(clGetDeviceIDs)(platform, type, most, devices, count);
}

cl_int clFinish(cl_command_queue queue) {
    ++clgi::test::calls.blocking;
    return CLGI_NEXT(clFinish)(queue);
}

cl_int clFlush(cl_command_queue queue) {
    ++clgi::test::calls.blocking;
    return CLGI_NEXT(clFlush)(queue);
}

cl_int clWaitForEvents(cl_uint count, const cl_event* events) {
    ++clgi::test::calls.blocking;
    return CLGI_NEXT(clWaitForEvents)(count, events);
}

cl_int clEnqueueReadBuffer(cl_command_queue queue, cl_mem buffer, cl_bool block, size_t first,
                           size_t bytes, void* to, cl_uint count, const cl_event* wait,
                           cl_event* event) {
    clgi::test::calls.blocking += block == CL_TRUE;
    return CLGI_NEXT(clEnqueueReadBuffer)(queue, buffer, block, first, bytes, to, count, wait,
                                          event);
}

cl_int clEnqueueWriteBuffer(cl_command_queue queue, cl_mem buffer, cl_bool block, size_t first,
                            size_t bytes, const void* from, cl_uint count, const cl_event* wait,
                            cl_event* event) {
    clgi::test::calls.blocking += block == CL_TRUE;
    return CLGI_NEXT(clEnqueueWriteBuffer)(queue, buffer, block, first, bytes, from, count, wait,
                                           event);
}

cl_int clEnqueueNDRangeKernel(cl_command_queue queue, cl_kernel kernel, cl_uint dimensions,
                              const size_t* offset, const size_t* global, const size_t* local,
                              cl_uint count, const cl_event* wait, cl_event* event) {
    using namespace clgi::test;
    ++calls.enqueued;
    if (fails(calls.fail_enqueue)) return calls.code;
    return CLGI_NEXT(clEnqueueNDRangeKernel)(queue, kernel, dimensions, offset, global, local,
                                             count, wait, event);
}

}  // extern "C"
