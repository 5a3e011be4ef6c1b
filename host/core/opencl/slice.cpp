// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/slice.hpp>
#include <clgi/error.hpp>
#include <string>

#include "core/opencl/error_text.hpp"

namespace clgi {

std::size_t slice_alignment(const cl::Context& context) {
    std::size_t alignment = 1;
    for (const cl::Device& device : context.getInfo<CL_CONTEXT_DEVICES>())
        alignment =
            std::max<std::size_t>(alignment, device.getInfo<CL_DEVICE_MEM_BASE_ADDR_ALIGN>() / 8);
    return alignment;
}

cl::Buffer slice(const cl::Buffer& buffer, std::size_t first, std::size_t bytes) {
    if (!buffer()) throw Error("slice: the buffer is none");
    const std::size_t held = buffer.getInfo<CL_MEM_SIZE>();
    if (bytes == 0 || first > held || bytes > held - first)
        throw Error("slice: bytes " + std::to_string(first) + " to " +
                    std::to_string(first + bytes) + " were asked for, at least one and within " +
                    std::to_string(held) + " needed");
    const std::size_t alignment = slice_alignment(buffer.getInfo<CL_MEM_CONTEXT>());
    if (first % alignment != 0)
        throw Error("slice: it begins at byte " + std::to_string(first) + ", a multiple of " +
                    std::to_string(alignment) + " needed (CL_DEVICE_MEM_BASE_ADDR_ALIGN)");
    // OpenCL has no sub-buffers of sub-buffers: take the part from the whole.
    const cl::Memory parent = buffer.getInfo<CL_MEM_ASSOCIATED_MEMOBJECT>();
    cl::Buffer whole = parent() ? cl::Buffer(parent(), true) : buffer;
    const cl_buffer_region region{buffer.getInfo<CL_MEM_OFFSET>() + first, bytes};
    try {
        return whole.createSubBuffer(0, CL_BUFFER_CREATE_TYPE_REGION, &region);
    } catch (const cl::Error& error) {
        throw DeviceError("slice: OpenCL gives no sub-buffer: " + error_text(error.err()));
    }
}

}  // namespace clgi
