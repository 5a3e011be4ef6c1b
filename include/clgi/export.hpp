// Marks what a shared clgi lets its users call; everything else stays inside the library.
// SPDX-License-Identifier: MIT
#pragma once

#if defined(__GNUC__)
#define CLGI_API __attribute__((visibility("default")))
#else
#define CLGI_API
#endif
