// Textures as OpenCL images, without a copy, for the time of one kernel.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/passes/import.hpp>
#include <functional>
#include <string>

#include "gl/texture_facts.hpp"

namespace clgi::gl {

// Formats of two-dimensional images that a context can read.
std::vector<cl::ImageFormat> readable_formats(const cl::Context& context);

// Makes an image of every texture. Empty with the reason in `why`, and nothing is left behind,
// where one cannot be shared; nothing has been enqueued then.
bool share(const Sharing& sharing, const cl::Context& context,
           const std::vector<cl::ImageFormat>& formats, Channels& channels, ImportImages& images,
           std::string& why);

// Hands the images to OpenCL after `wait`, enqueues `kernel` with what it must wait for, and hands
// them back: the returned event is the end of that. They are handed back when `kernel` throws too.
// Throws DeviceError.
cl::Event while_acquired(const Sharing& sharing, const cl::CommandQueue& queue,
                         const ImportImages& images, const WaitList& wait,
                         const std::function<cl::Event(const WaitList&)>& kernel);

}  // namespace clgi::gl
