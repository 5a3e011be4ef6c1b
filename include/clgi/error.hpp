// The exceptions of clgi. There are three types because callers react in three ways.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <stdexcept>
#include <string>

namespace clgi {

// A call was wrong: an argument out of range, a buffer too small. The text names the pass or
// function, the argument, what it got and what it needed.
class CLGI_API Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Input data, such as a scene or an image, is invalid or needs something that is not supported.
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
