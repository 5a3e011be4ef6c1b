// Which variants of kernels there are, and how their work is grouped.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>
#include <string>
#include <vector>

namespace clgi {

// The pass with a smaller group, for a kernel whose work-items are few and long, unless the options
// chose one: on a CPU a group is what one core takes at a time. In groups it stays as it is.
PassKernel in_small_groups(PassKernel pass, const cl::Device& device, const BuildOptions& options);

// Whether the driver builds one program after the other, whatever threads ask for them: PoCL.
bool builds_in_turn(const cl::Device& device);

// Whether kernels that have a form for groups are built in it.
bool in_groups(const cl::Device& device, const BuildOptions& options);

// The form for groups of a pass, kernel <pass>_group: with so many lanes unless the options chose,
// and at most `most`, for which its lists in local memory have room. It keeps the name of the pass.
PassKernel group_form(const Programs& programs, const std::string& folder, const std::string& pass,
                      const BuildOptions& options, const std::string& defines, std::size_t lanes,
                      std::size_t most);

// Work-items that a pass has for each item: those of a group, or one.
std::size_t items_each(const PassKernel& pass, bool grouped);

// Builds those of a room's kernels whose names, without the room's, are given.
// Throws Error for a name that is not among them.
void build_named(const std::vector<PassKernel>& kernels, std::initializer_list<const char*> passes);

// Whether the device's kernels are built with 64-bit atomics under these options.
bool uses_atomics64(const cl::Device& device, const BuildOptions& options);

}  // namespace clgi
