// SPDX-License-Identifier: MIT
#include "opencl/program.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/kernel_source.hpp>
#include <future>

#include "opencl/embedded.hpp"
#include "opencl/error_text.hpp"

namespace clgi {
namespace {

int width_of(const cl::Device& device, const BuildOptions& options) {
    const int width = options.packet_width > 0 ? options.packet_width : packet_width(device);
    if (width != 1 && width != 4 && width != 8 && width != 16)
        throw Error("program: packet_width is " + std::to_string(width) + ", 1, 4, 8 or 16 needed");
    return width;
}

// oclgrind's compiler breaks when two threads call it, though OpenCL lets them.
bool builds_from_threads(const cl::Device& device) {
    return cl::Platform(device.getInfo<CL_DEVICE_PLATFORM>()).getInfo<CL_PLATFORM_NAME>() !=
           "Oclgrind";
}

// What the compiler said; empty where there is no program or nobody to ask any more.
std::string build_log(const cl::Program& program, const cl::Device& device) {
    if (!program()) return "";
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error&) {
        return "";
    }
}

PassKernel build_pass(const cl::Context& context, const cl::Device& device, const std::string& room,
                      const std::string& pass, const BuildOptions& options) {
    const int width = width_of(device, options);
    const std::string build = compiler_options(device, options);
    const std::string source = kernel_source(room + "/" + pass);
    cl::Program program;
    PassKernel out;
    try {
        program = cl::Program(context, source);
        program.build(device, build.c_str());
        out.kernel = cl::Kernel(program, (room + "_" + pass).c_str());
    } catch (const cl::Error& error) {
        throw DeviceError("program: " + room + "/" + pass + ".cl does not build on " +
                          describe(device) + ": " + error_text(error.err()) + "\n" +
                          build_log(program, device));
    }
    out.name = room + "." + pass;
    const std::size_t most = out.kernel.getWorkGroupInfo<CL_KERNEL_WORK_GROUP_SIZE>(device);
    out.local_size = std::min(options.local_size > 0 ? options.local_size : 64, most);
    out.packet_width = width;
    out.storage = options.storage;
    return out;
}

}  // namespace

const char* kernel_source(const std::string& name) {
    for (unsigned i = 0; i < embedded_kernel_count; ++i)
        if (name == embedded_kernels[i].name) return embedded_kernels[i].source;
    throw Error("program: no embedded kernel is called " + name);
}

std::string compiler_options(const cl::Device& device, const BuildOptions& options) {
    std::string text = "-cl-std=CL1.2 -DCLGI_WIDTH=" + std::to_string(width_of(device, options));
    if (uses_atomics64(device, options)) text += " -DCLGI_ATOMIC64";
    if (!options.textures) text += " -DCLGI_NO_TEXTURES";
    if (options.storage == Storage::half) text += " -DCLGI_HALF";
    if (options.math == Math::fast) {
        text += " -cl-fast-relaxed-math";
    } else if (device.getInfo<CL_DEVICE_SINGLE_FP_CONFIG>() & CL_FP_CORRECTLY_ROUNDED_DIVIDE_SQRT) {
        text += " -cl-fp32-correctly-rounded-divide-sqrt";
    }
    return text;
}

bool uses_atomics64(const cl::Device& device, const BuildOptions& options) {
    return options.atomics64 && device.getInfo<CL_DEVICE_EXTENSIONS>().find(
                                    "cl_khr_int64_extended_atomics") != std::string::npos;
}

void prefer_small_groups(PassKernel& pass, const cl::Device& device, const BuildOptions& options) {
    constexpr std::size_t few = 4;
    if (options.local_size == 0 && (device.getInfo<CL_DEVICE_TYPE>() & CL_DEVICE_TYPE_CPU))
        pass.local_size = std::min(pass.local_size, few);
}

std::vector<PassKernel> build_room(const cl::Context& context, const cl::Device& device,
                                   const std::string& room,
                                   std::initializer_list<const char*> passes,
                                   const BuildOptions& options) {
    const bool parallel = options.parallel && builds_from_threads(device);
    const auto how = parallel ? std::launch::async : std::launch::deferred;
    std::vector<std::future<PassKernel>> builds;
    for (const char* pass : passes)
        builds.push_back(std::async(how, [&, name = std::string(pass)] {
            return build_pass(context, device, room, name, options);
        }));
    for (auto& build : builds) build.wait();  // context and device outlive every thread
    std::vector<PassKernel> kernels;
    for (auto& build : builds) kernels.push_back(build.get());
    return kernels;
}

}  // namespace clgi
