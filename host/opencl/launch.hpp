// Setting arguments and enqueueing, once for all passes.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/error.hpp>
#include <clgi/pass.hpp>
#include <string>

namespace clgi {

inline void set_argument(cl::Kernel& kernel, cl_uint& index, const DeviceScene& scene) {
    for (const cl::Buffer* buffer : scene.kernel_arguments()) kernel.setArg(index++, *buffer);
}

template <typename T>
void set_argument(cl::Kernel& kernel, cl_uint& index, const T& value) {
    kernel.setArg(index++, value);
}

// Enqueues at least `items` work-items in groups of the pass's size; none at all for items = 0,
// where the event only stands for the wait list.
template <typename... Arguments>
cl::Event launch(const PassKernel& pass, const cl::CommandQueue& queue, std::size_t items,
                 const WaitList& wait, const Arguments&... arguments) {
    cl::Event event;
    const WaitList* waits = wait.empty() ? nullptr : &wait;
    try {
        if (items == 0) {
            queue.enqueueMarkerWithWaitList(waits, &event);
            return event;
        }
        cl::Kernel kernel = pass.kernel;  // a second handle: arguments live in the kernel itself
        cl_uint index = 0;
        (set_argument(kernel, index, arguments), ...);
        const std::size_t groups = (items + pass.local_size - 1) / pass.local_size;
        queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(groups * pass.local_size),
                                   cl::NDRange(pass.local_size), waits, &event);
    } catch (const cl::Error& error) {
        throw DeviceError(pass.name + ": enqueueing failed with OpenCL error " +
                          std::to_string(error.err()) + " in " + error.what());
    }
    return event;
}

// Throws unless a buffer holds at least `needed` bytes.
inline void need(const PassKernel& pass, const char* argument, const cl::Buffer& buffer,
                 std::size_t needed) {
    const std::size_t held = buffer() ? buffer.getInfo<CL_MEM_SIZE>() : 0;
    if (held < needed)
        throw Error(pass.name + ": " + argument + " holds " + std::to_string(held) + " bytes, " +
                    std::to_string(needed) + " needed");
}

inline std::size_t packets(const PassKernel& pass, std::size_t items) {
    return (items + pass.packet_width - 1) / pass.packet_width;
}

}  // namespace clgi
