// Checks of what describes planes of pixels, before a kernel is enqueued.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/pass.hpp>
#include <clgi/error.hpp>
#include <string>

namespace clgi {

// Planes are read and written in whole packets, so a plane must hold the last one.
inline void need_stride(const PassKernel& pass, const char* name, std::size_t stride,
                        std::size_t points) {
    if (stride < points || stride % 16 != 0)
        throw Error(pass.name + ": " + name + " is " + std::to_string(stride) +
                    ", a multiple of 16 of at least " + std::to_string(points) + " needed");
}

// Kernels count the numbers of planes in 32 bits.
inline void need_countable(const std::string& owner, const std::string& name, std::size_t planes,
                           std::size_t stride) {
    if (planes > 0 && stride > (std::size_t{1} << 32) / planes)
        throw Error(owner + ": " + name + " has " + std::to_string(planes) + " planes of " +
                    std::to_string(stride) + ", at most 2^32 numbers needed");
}

inline void need_step(const PassKernel& pass, std::uint32_t step) {
    if (step != 2 && step != 4)
        throw Error(pass.name + ": step is " + std::to_string(step) + ", 2 or 4 needed");
}

}  // namespace clgi
