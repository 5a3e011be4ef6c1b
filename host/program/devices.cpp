// clgi devices: all OpenCL devices, and the one that a command would use.
// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <clgi/device.hpp>
#include <memory>
#include <vector>

#include "program/commands.hpp"
#include "program/session.hpp"

namespace clgi::program {
namespace {

const char* kind_of(const cl::Device& device) {
    const cl_device_type type = device.getInfo<CL_DEVICE_TYPE>();
    return type & CL_DEVICE_TYPE_GPU ? "GPU" : type & CL_DEVICE_TYPE_CPU ? "CPU" : "other";
}

bool has(const cl::Device& device, const char* extension) {
    return device.getInfo<CL_DEVICE_EXTENSIONS>().find(extension) != std::string::npos;
}

// A platform without hardware reports an error.
std::vector<cl::Device> devices_of(const cl::Platform& platform) {
    std::vector<cl::Device> out;
    try {
        platform.getDevices(CL_DEVICE_TYPE_ALL, &out);
    } catch (const cl::Error&) {
    }
    return out;
}

void print_devices(const std::vector<cl::Device>& devices, const cl::Device& taken) {
    for (const cl::Device& device : devices) {
        fmt::print("{} {}\n", device() == taken() ? "*" : " ", describe(device));
        fmt::print("    {}, {} compute units at {} MHz, packets of {} floats\n", kind_of(device),
                   device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>(),
                   device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>(), packet_width(device));
        fmt::print("    memory {} MiB, largest buffer {} MiB, local {} KiB, work-group up to {}\n",
                   device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>() >> 20,
                   device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>() >> 20,
                   device.getInfo<CL_DEVICE_LOCAL_MEM_SIZE>() >> 10,
                   device.getInfo<CL_DEVICE_MAX_WORK_GROUP_SIZE>());
        fmt::print("    64-bit atomics {}, double {}, half {}, GL sharing {}\n",
                   has(device, "cl_khr_int64_extended_atomics") ? "yes" : "no",
                   has(device, "cl_khr_fp64") ? "yes" : "no",
                   has(device, "cl_khr_fp16") ? "yes" : "no",
                   has(device, "cl_khr_gl_sharing") ? "yes" : "no");
    }
}

void run_devices(const std::string& choice) {
    const cl::Device taken = choose_device(choice);
    std::vector<cl::Platform> platforms;
    cl::Platform::get(&platforms);
    for (const cl::Platform& platform : platforms) {
        fmt::print("{}, {}\n", platform.getInfo<CL_PLATFORM_NAME>(),
                   platform.getInfo<CL_PLATFORM_VERSION>());
        const std::vector<cl::Device> devices = devices_of(platform);
        if (devices.empty()) fmt::print("  no device\n");
        print_devices(devices, taken);
    }
}

}  // namespace

void add_devices(CLI::App& app) {
    CLI::App* command =
        app.add_subcommand("devices", "List the OpenCL devices; * marks the chosen one");
    const auto choice = std::make_shared<std::string>();
    add_device_option(*command, *choice);
    command->callback([choice] { run_devices(*choice); });
}

}  // namespace clgi::program
