// Whether so many VPLs can be baked at all, before they are placed: that takes long, and memory of
// its own.
// SPDX-License-Identifier: MIT
#pragma once

#include <fmt/format.h>

#include <clgi/error.hpp>
#include <clgi/opencl.hpp>
#include <clgi/solvers/light_atlas.hpp>
#include <string>

namespace clgi::cli {

// Throws DeviceError that begins with the command's name.
inline void need_room(const std::string& command, const cl::Device& device,
                      const VplOptions& options) {
    const std::size_t samples = std::size_t{options.count} * options.samples_per_vpl;
    const std::size_t needed = light_atlas_least_bytes(options.count, samples);
    const std::size_t memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    if (needed <= memory) return;
    throw DeviceError(fmt::format(
        "{}: {} VPLs with {} samples each need {} MB at the least, the device has {} MB; lower "
        "--vpls or --samples-per-vpl",
        command, options.count, options.samples_per_vpl, needed / 1000000, memory / 1000000));
}

}  // namespace clgi::cli
