// The only place that includes the OpenCL C++ bindings, so that their macros are always the same.
// SPDX-License-Identifier: MIT
#pragma once

#if !defined(CL_HPP_ENABLE_EXCEPTIONS) || CL_HPP_TARGET_OPENCL_VERSION != 120 || \
    CL_HPP_MINIMUM_OPENCL_VERSION != 120
#error "Link clgi::clgi: it defines the macros that CL/opencl.hpp must be seen with"
#endif

#include <CL/opencl.hpp>
#include <vector>

namespace clgi {

using WaitList = std::vector<cl::Event>;

}  // namespace clgi
