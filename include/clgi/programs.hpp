// Built kernels of one context and device, shared by all passes and solvers made with them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/opencl.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace clgi {

// Each kernel is built when a pass is first enqueued, once for each set of options, and kept as
// long as this object, a copy of it or a pass made with it exists. Copies share what is built. All
// calls may come from several threads.
class CLGI_API Programs {
public:
    Programs(const cl::Context& context, const cl::Device& device);

    // kernels/<room>/<pass>.cl built with these options. defines: more compiler options, for a
    // variant of the pass. together: passes of the room, this one among them, that are always one
    // program with it on drivers that build one after the other (PoCL): a compiler takes longer to
    // read the built-in functions of OpenCL C than most kernels. Builds nothing yet. Throws Error
    // when there is no such kernel.
    PassKernel kernel(const std::string& room, const std::string& pass,
                      const BuildOptions& options = {}, const std::string& defines = "",
                      const std::vector<std::string>& together = {}) const;

    // Programs that are built from now on are kept in this folder as the driver's binaries, and
    // taken from there by the next process: for runtimes that keep none themselves. Empty: none are
    // kept, as without this call. A file that is broken, or of another source, device or driver, is
    // built anew; nothing is thrown where the folder cannot be read or written. Processes may share
    // it.
    void keep_binaries(const std::filesystem::path& folder);

    // How many kernels have been built so far.
    std::size_t built() const;

    // Which: "lights/direct -cl-std=CL1.2 ...", in alphabetical order. Kernels that were asked for
    // but not enqueued are not among them.
    std::vector<std::string> built_kernels() const;

    const cl::Context& context() const { return context_; }
    const cl::Device& device() const { return device_; }

private:
    cl::Context context_;
    cl::Device device_;
    struct Store;
    std::shared_ptr<Store> store_;
};

// Builds these kernels now, those of a folder with the same options as one program, and several
// programs at a time; kernels that are built already cost nothing. A solver calls it when it is
// made, so that its first picture does not wait for the compiler.
// Throws DeviceError with the compiler's log when one does not build.
CLGI_API void build(const std::vector<PassKernel>& kernels);

}  // namespace clgi
