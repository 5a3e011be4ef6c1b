// What clgi throws. Three types, because a caller can do three different things about it.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/export.hpp>
#include <stdexcept>
#include <string>

namespace clgi {

// A call was wrong: an argument out of range, a buffer too small. The text names the pass or
// function, the argument, what it got and what it needed.
class CLGI_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Input data is broken or asks for something that is not supported: a scene, an image.
class CLGI_API InputError : public Error {
public:
    using Error::Error;
};

// The device or its memory failed: no platform, a kernel that does not build, out of memory.
class CLGI_API DeviceError : public Error {
public:
    using Error::Error;
};

}  // namespace clgi
