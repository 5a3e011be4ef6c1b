// Setting arguments and enqueueing, once for all passes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/pass.hpp>
#include <clgi/error.hpp>
#include <string>

#include "core/opencl/error_text.hpp"
#include "core/opencl/kernel_slot.hpp"

namespace clgi {

// A value, or all buffers of what has several, such as a scene.
template <typename T>
void set_argument(cl::Kernel& kernel, cl_uint& index, const T& value) {
    if constexpr (requires { value.kernel_arguments(); })
        for (const cl::Buffer* buffer : value.kernel_arguments()) kernel.setArg(index++, *buffer);
    else
        kernel.setArg(index++, value);
}

// The largest group, up to the pass's size, that work-items of a part fill exactly: what lies
// beside the part is not touched.
inline std::size_t dividing_group(std::size_t most, std::size_t items) {
    std::size_t size = 1;
    while (2 * size <= most && items % (2 * size) == 0) size *= 2;
    return size;
}

// Kernels number their work-items in 32 bits. end: behind the last one.
inline void need_items(const std::string& owner, std::size_t end) {
    if (end > std::size_t{1} << 32)
        throw Error(owner + ": there are " + std::to_string(end) +
                    " work-items, at most 2^32 needed");
}

// Enqueues work-items in groups of the pass's size, at least as many as a whole range has and
// exactly those of a part, once for each of `rows` (the second dimension); none at all for an empty
// range, where the event only stands for the wait list.
template <typename... Arguments>
cl::Event launch_rows(const PassKernel& pass, const cl::CommandQueue& queue, const Range& range,
                      std::size_t rows, const WaitList& wait, const Arguments&... arguments) {
    const std::size_t items = range.count;
    cl::Event event;
    const WaitList* waits = wait.empty() ? nullptr : &wait;
    try {
        if (items == 0 || rows == 0) {
            queue.enqueueMarkerWithWaitList(waits, &event);
            return event;
        }
        const std::size_t most = group_size(pass);
        const std::size_t group = range.whole ? most : dividing_group(most, items);
        const std::size_t whole = (items + group - 1) / group * group;
        need_items(pass.name, range.first + whole);
        pass.slot->with_kernel([&](cl::Kernel& kernel) {
            cl_uint index = 0;
            (set_argument(kernel, index, arguments), ...);
            if (rows == 1)
                queue.enqueueNDRangeKernel(kernel, cl::NDRange(range.first), cl::NDRange(whole),
                                           cl::NDRange(group), waits, &event);
            else
                queue.enqueueNDRangeKernel(kernel, cl::NDRange(range.first, 0),
                                           cl::NDRange(whole, rows), cl::NDRange(group, 1), waits,
                                           &event);
        });
    } catch (const cl::Error& error) {
        const std::string text =
            pass.name + ": " + error.what() + " failed: " + error_text(error.err());
        if (is_wrong_call(error.err())) throw Error(text);
        throw DeviceError(text);
    }
    return event;
}

template <typename... Arguments>
cl::Event launch(const PassKernel& pass, const cl::CommandQueue& queue, const Range& range,
                 const WaitList& wait, const Arguments&... arguments) {
    return launch_rows(pass, queue, range, 1, wait, arguments...);
}

// Throws unless a buffer holds at least `needed` bytes.
inline void need(const PassKernel& pass, const char* argument, const cl::Buffer& buffer,
                 std::size_t needed) {
    std::size_t held = 0;
    try {
        if (buffer()) held = buffer.getInfo<CL_MEM_SIZE>();
    } catch (const cl::Error& error) {
        throw Error(pass.name + ": " + argument + " is no buffer: " + error_text(error.err()));
    }
    if (held < needed)
        throw Error(pass.name + ": " + argument + " holds " + std::to_string(held) + " bytes, " +
                    std::to_string(needed) + " needed");
}

inline std::size_t packets(const PassKernel& pass, std::size_t items) {
    return (items + pass.packet_width - 1) / pass.packet_width;
}

// Where a range ends; no sum of two numbers wraps around to a small one.
inline std::size_t end_of(const Range& range) {
    return std::max(range.first + range.count, std::max(range.first, range.count));
}

// The same for a range of points, which must begin with a packet of any width.
inline Range packets(const PassKernel& pass, const Range& points) {
    if (points.first % 16 != 0)
        throw Error(pass.name + ": the range begins at " + std::to_string(points.first) +
                    ", a multiple of 16 needed");
    Range out = points;
    out.first = points.first / pass.packet_width;
    out.count = packets(pass, points.count);
    return out;
}

}  // namespace clgi
