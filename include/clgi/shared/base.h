// Types and macros for headers that both C++ and OpenCL C compile.
// Shared structs hold float4, float, int and uint only, in rows of 16 bytes.
// SPDX-License-Identifier: MIT
#ifndef CLGI_SHARED_BASE_H
#define CLGI_SHARED_BASE_H

#ifdef __OPENCL_VERSION__
#define CLGI_SHARED_BEGIN
#define CLGI_SHARED_END
#define CLGI_INLINE static inline __attribute__((always_inline))
// Multiply-adds are fused only where fma() is written, so every compiler gives the same bits.
#pragma OPENCL FP_CONTRACT OFF
#else
#include <cstdint>
#include <glm/glm.hpp>
#define CLGI_SHARED_BEGIN namespace clgi {
#define CLGI_SHARED_END }
#define CLGI_INLINE inline
namespace clgi {
using float4 = glm::vec4;
using uint = std::uint32_t;
using ulong = std::uint64_t;
}  // namespace clgi
#endif

#define CLGI_PI 3.14159265358979f

#endif
