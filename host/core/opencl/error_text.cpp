// SPDX-License-Identifier: MIT
#include "core/opencl/error_text.hpp"

#include <algorithm>
#include <clgi/opencl.hpp>
#include <iterator>

namespace clgi {
namespace {

struct Known {
    int code;
    const char* name;
    const char* meaning;
};

constexpr Known known[] = {
    {CL_DEVICE_NOT_FOUND, "CL_DEVICE_NOT_FOUND", "there is no such device"},
    {CL_DEVICE_NOT_AVAILABLE, "CL_DEVICE_NOT_AVAILABLE", "the device was lost or is in use"},
    {CL_COMPILER_NOT_AVAILABLE, "CL_COMPILER_NOT_AVAILABLE", "the platform has no compiler"},
    {CL_MEM_OBJECT_ALLOCATION_FAILURE, "CL_MEM_OBJECT_ALLOCATION_FAILURE", "out of device memory"},
    {CL_OUT_OF_RESOURCES, "CL_OUT_OF_RESOURCES", "the device is out of resources, or failed"},
    {CL_OUT_OF_HOST_MEMORY, "CL_OUT_OF_HOST_MEMORY", "out of host memory"},
    {CL_BUILD_PROGRAM_FAILURE, "CL_BUILD_PROGRAM_FAILURE", "the compiler refused"},
    {CL_MISALIGNED_SUB_BUFFER_OFFSET, "CL_MISALIGNED_SUB_BUFFER_OFFSET",
     "a sub-buffer begins at a place that the device cannot use"},
    {CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST, "CL_EXEC_STATUS_ERROR_FOR_EVENTS_IN_WAIT_LIST",
     "something that was waited for had failed"},
    {CL_INVALID_DEVICE, "CL_INVALID_DEVICE", "the device does not belong to the context"},
    {CL_INVALID_CONTEXT, "CL_INVALID_CONTEXT",
     "queue, buffers, events and pass are of different contexts"},
    {CL_INVALID_COMMAND_QUEUE, "CL_INVALID_COMMAND_QUEUE", "the queue is none"},
    {CL_INVALID_MEM_OBJECT, "CL_INVALID_MEM_OBJECT", "a buffer is none"},
    {CL_INVALID_PROGRAM_EXECUTABLE, "CL_INVALID_PROGRAM_EXECUTABLE",
     "the pass was built for another device than the queue's"},
    {CL_INVALID_EVENT_WAIT_LIST, "CL_INVALID_EVENT_WAIT_LIST", "the wait list holds no events"},
    {CL_INVALID_BUFFER_SIZE, "CL_INVALID_BUFFER_SIZE", "the buffer is too large for the device"},
    {CL_PROFILING_INFO_NOT_AVAILABLE, "CL_PROFILING_INFO_NOT_AVAILABLE",
     "the queue does not profile, or the command has not ended"},
};

const Known* find(int code) {
    const auto* at = std::find_if(std::begin(known), std::end(known),
                                  [&](const Known& entry) { return entry.code == code; });
    return at == std::end(known) ? nullptr : at;
}

}  // namespace

std::string error_text(int code) {
    const Known* entry = find(code);
    const std::string number = "OpenCL error " + std::to_string(code);
    if (!entry) return number;
    return std::string(entry->meaning) + " (" + entry->name + ", " + number + ")";
}

bool is_wrong_call(int code) {
    for (const int wrong : {CL_INVALID_CONTEXT, CL_INVALID_COMMAND_QUEUE, CL_INVALID_MEM_OBJECT,
                            CL_INVALID_PROGRAM_EXECUTABLE, CL_INVALID_EVENT_WAIT_LIST,
                            CL_MISALIGNED_SUB_BUFFER_OFFSET})
        if (code == wrong) return true;
    return false;
}

}  // namespace clgi
