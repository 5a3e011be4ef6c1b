// A kernel that is built when it is first needed, and the lock that its arguments live behind.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <atomic>
#include <clgi/advanced/pass.hpp>
#include <clgi/opencl.hpp>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/opencl/binary_cache.hpp"

namespace clgi {

// Kernels of a room with the same options that are one program, whichever of them is built first.
// So a driver that keeps what it built has each kernel once, whoever asks for which of them.
struct KernelUnit {
    KernelUnit(const std::string& room, const std::vector<std::string>& passes) {
        for (const std::string& pass : passes) files.push_back(room + "/" + pass);
    }
    std::vector<std::string> files;
    std::mutex mutex;
    cl::Program program;  // once it is built
};

class KernelSlot {
public:
    // file: "folder/pass" of the embedded kernel. function: its entry point. unit: that it belongs
    // to, or null. cache: not null.
    KernelSlot(const cl::Context& context, const cl::Device& device, std::string file,
               std::string function, std::shared_ptr<KernelUnit> unit, std::string options,
               std::shared_ptr<const BinaryCache> cache);

    // Builds once. Throws DeviceError with the compiler's log.
    void build();

    // Builds kernels of one context and device, with equal options, the same family and different
    // files, as one program: a compiler takes longer to read the built-in functions of OpenCL C
    // than most kernels. What does not build with others is built alone.
    static void build_together(const std::vector<std::shared_ptr<KernelSlot>>& slots);

    // calls use(kernel) while no other thread sets arguments of it or enqueues it.
    template <typename Use>
    auto with_kernel(Use&& use) {
        build();
        const std::lock_guard lock(arguments_);
        return use(kernel_);
    }

    // Work-items of a group that the kernel allows at most.
    std::size_t most_items();

    bool built() const { return built_; }

    const cl::Context& context() const { return context_; }
    const cl::Device& device() const { return device_; }
    const std::string& file() const { return file_; }
    // What kernels that may be one program have alike: their unit, else their folder.
    std::string family() const;
    const std::string& options() const { return options_; }

private:
    cl::Program compiled(const std::vector<std::string>& files) const;
    cl::Program own_program() const;
    void take(const cl::Program& program);

    cl::Context context_;
    cl::Device device_;
    std::string file_, function_, options_;
    std::shared_ptr<KernelUnit> unit_;
    std::shared_ptr<const BinaryCache> cache_;
    std::once_flag once_;
    std::atomic<bool> built_ = false;
    std::mutex arguments_;
    cl::Kernel kernel_;
    std::size_t most_items_ = 1;
};

// The options without the macros that the source does not name: they would change nothing, and
// kernels that differ by them alone are one.
std::string options_for(const std::string& source, const std::string& options);

// The group that a pass is enqueued with.
inline std::size_t group_size(const PassKernel& pass) {
    return std::min(pass.local_size, pass.slot->most_items());
}

}  // namespace clgi
