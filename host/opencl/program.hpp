// From embedded source to kernels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/pass.hpp>
#include <initializer_list>
#include <string>
#include <vector>

namespace clgi {

// Builds kernels/<room>/<pass>.cl of each pass, several at a time, and returns its kernel
// <room>_<pass>. Throws DeviceError with the compiler's log when one does not build.
std::vector<PassKernel> build_room(const cl::Context& context, const cl::Device& device,
                                   const std::string& room,
                                   std::initializer_list<const char*> passes,
                                   const BuildOptions& options);

// A smaller group for a kernel whose work-items are few and long, unless the options chose one:
// on a CPU a group is what one core takes at a time.
void prefer_small_groups(PassKernel& pass, const cl::Device& device, const BuildOptions& options);

// Whether the device's kernels are built with 64-bit atomics under these options.
bool uses_atomics64(const cl::Device& device, const BuildOptions& options);

}  // namespace clgi
