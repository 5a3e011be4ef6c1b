// Parts of a buffer as sub-buffers, to give a pass an offset.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/opencl.hpp>
#include <cstddef>

namespace clgi {

// The beginning of a slice must be a multiple of this many bytes, on all devices of the context.
CLGI_API std::size_t slice_alignment(const cl::Context& context);

// Bytes first .. first + bytes - 1 of a buffer or sub-buffer, as a sub-buffer on the same memory.
// Nothing is allocated on the device.
// Throws Error naming what it got and needed for a beginning that is not aligned, for an empty
// slice and for one that reaches past the end.
CLGI_API cl::Buffer slice(const cl::Buffer& buffer, std::size_t first, std::size_t bytes);

// The same in elements of T.
template <typename T>
cl::Buffer slice_of(const cl::Buffer& buffer, std::size_t first, std::size_t count) {
    return slice(buffer, first * sizeof(T), count * sizeof(T));
}

}  // namespace clgi
