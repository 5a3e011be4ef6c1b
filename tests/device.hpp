// The device that all tests of a process share, and buffers on it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <vector>

namespace clgi::test {

struct Device {
    cl::Device device;
    cl::Context context;
    cl::CommandQueue queue;  // in order, with profiling
};

// Throws DeviceError where there is none, so that a test that needs a device fails without one.
inline const Device& device() {
    static const Device shared = [] {
        Device out;
        out.device = choose_device();
        out.context = cl::Context(out.device);
        out.queue = cl::CommandQueue(out.context, out.device, CL_QUEUE_PROFILING_ENABLE);
        return out;
    }();
    return shared;
}

// Kernels that all tests of a process share: each is built once for each kind of build.
inline const Programs& programs() {
    static const Programs shared(device().context, device().device);
    return shared;
}

inline DeviceScene on_device(const Scene& scene) {
    return DeviceScene(device().context, device().device, scene);
}

// A room's passes as they are built by default, of each kind of math.
template <typename Passes>
const Passes& shared_passes(Math math) {
    static const Passes strict(programs(), BuildOptions{.math = Math::strict});
    static const Passes fast(programs(), BuildOptions{.math = Math::fast});
    return math == Math::fast ? fast : strict;
}

template <typename T>
cl::Buffer upload(const std::vector<T>& values) {
    return cl::Buffer(device().context, CL_MEM_READ_WRITE | CL_MEM_COPY_HOST_PTR,
                      values.size() * sizeof(T), const_cast<T*>(values.data()));
}

template <typename T>
cl::Buffer empty(std::size_t count) {
    return cl::Buffer(device().context, CL_MEM_READ_WRITE, count * sizeof(T));
}

template <typename T>
std::vector<T> download(const cl::Buffer& buffer, std::size_t count, std::size_t first = 0) {
    std::vector<T> values(count);
    if (count == 0) return values;  // which OpenCL would refuse
    device().queue.enqueueReadBuffer(buffer, CL_TRUE, first * sizeof(T), count * sizeof(T),
                                     values.data());
    return values;
}

}  // namespace clgi::test
