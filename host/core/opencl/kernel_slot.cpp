// SPDX-License-Identifier: MIT
#include "core/opencl/kernel_slot.hpp"

#include <clgi/advanced/kernel_source.hpp>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <utility>

#include "core/opencl/error_text.hpp"

namespace clgi {
namespace {

// What the compiler said; empty where there is no program, or the device is lost.
std::string build_log(const cl::Program& program, const cl::Device& device) {
    if (!program()) return "";
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error&) {
        return "";
    }
}

}  // namespace

KernelSlot::KernelSlot(const cl::Context& context, const cl::Device& device, std::string file,
                       std::string function, std::string options)
    : context_(context),
      device_(device),
      file_(std::move(file)),
      function_(std::move(function)),
      options_(std::move(options)) {}

void KernelSlot::build() {
    std::call_once(once_, [&] {
        cl::Program program;
        try {
            program = cl::Program(context_, kernel_source(file_));
            program.build(device_, options_.c_str());
            kernel_ = cl::Kernel(program, function_.c_str());
            most_items_ = kernel_.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device_);
        } catch (const cl::Error& error) {
            throw DeviceError("program: " + file_ + ".cl does not build on " + describe(device_) +
                              ": " + error_text(error.err()) + "\n" + build_log(program, device_));
        }
        built_ = true;
    });
}

std::size_t KernelSlot::most_items() {
    build();
    return most_items_;
}

}  // namespace clgi
