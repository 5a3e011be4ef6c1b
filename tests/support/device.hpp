// The device that all tests of a process share, and buffers on it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/clgi.hpp>
#include <cstdlib>
#include <limits>
#include <vector>

namespace clgi::test {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

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

// Lanes of packets: none, those of small vectors, and as many as the device prefers, last. With
// CLGI_ALL_WIDTHS, which tests/run.sh --all sets, those that it does not prefer as well.
inline std::vector<int> widths() {
    const int preferred = packet_width(device().device);
    std::vector<int> out{1, 4};
    if (std::getenv("CLGI_ALL_WIDTHS"))
        for (const int other : {8, 16})
            if (other != preferred) out.push_back(other);
    out.push_back(preferred);
    return out;
}

inline DeviceScene on_device(const Scene& scene) {
    return DeviceScene(device().context, device().device, scene);
}

// Build options, or a kind of math alone.
struct Build : BuildOptions {
    Build(const BuildOptions& options) : BuildOptions(options) {}
    Build(Math kind) { math = kind; }
};

// How kernels are built where a test does not say otherwise: by the mode that it runs in
// (math_modes.hpp).
inline BuildOptions& usual_build() {
    static BuildOptions build;
    return build;
}

// Another one as long as it lives.
class UsualBuild {
public:
    explicit UsualBuild(const Build& build) { usual_build() = build; }
    ~UsualBuild() { usual_build() = before_; }
    UsualBuild(const UsualBuild&) = delete;
    UsualBuild& operator=(const UsualBuild&) = delete;

private:
    BuildOptions before_ = usual_build();
};

// A room's passes in each kind of math and storage, as they are built by default otherwise.
template <typename Passes>
const Passes& shared_passes(const Build& build) {
    static const auto of = [](Math math, Storage storage) {
        return Passes(programs(), BuildOptions{.math = math, .storage = storage});
    };
    static const Passes strict = of(Math::strict, Storage::full);
    static const Passes fast = of(Math::fast, Storage::full);
    static const Passes half = of(Math::strict, Storage::half);
    if (build.storage == Storage::half) return half;
    return build.math == Math::fast ? fast : strict;
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
