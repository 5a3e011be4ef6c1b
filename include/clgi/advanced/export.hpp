// Marks the public symbols of a shared library; all others are hidden.
// SPDX-License-Identifier: MIT
#pragma once

#if defined(__GNUC__)
#define CLGI_API __attribute__((visibility("default")))
#else
#define CLGI_API
#endif

// Marks what no solver needs from outside, or none calls: it may change in any version.
#define CLGI_EXPERIMENTAL
