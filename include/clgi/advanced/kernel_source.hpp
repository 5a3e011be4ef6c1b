// The kernels that are embedded in the library, for programs that build them themselves.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <string>
#include <vector>

namespace clgi {

// "<room>/<pass>" of every embedded kernel, sorted.
CLGI_API std::vector<std::string> kernel_names();

// The self-contained text of <room>/<pass>.cl, byte for byte that of share/clgi/kernels; its kernel
// is <room>_<pass>. name: "image/gather". Throws Error for an unknown name.
CLGI_API std::string kernel_source(const std::string& name);

// The options that a room's passes are compiled with on this device. Throws Error for an invalid
// packet width.
CLGI_API std::string compiler_options(const cl::Device& device, const BuildOptions& options = {});

}  // namespace clgi
