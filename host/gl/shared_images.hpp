// Textures as OpenCL images, without a copy: made once, handed to OpenCL for each conversion.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/passes/import.hpp>
#include <functional>
#include <string>

#include "gl/texture_facts.hpp"

namespace clgi::gl {

// Formats of two-dimensional images that a context can read.
std::vector<cl::ImageFormat> readable_formats(const cl::Context& context);

// The images of the textures of one G-buffer, kept from one conversion to the next.
class SharedImages {
public:
    // Images of all given textures. An image is reused if its texture has the same name, size and
    // format as in the last call; images of textures that are no longer given are released.
    // False with the reason in `why` if a texture cannot be shared: then no image is kept, and
    // nothing has been enqueued.
    bool share(const Sharing& sharing, const cl::Context& context,
               const std::vector<cl::ImageFormat>& formats, Channels& channels, const View& view,
               ImportImages& images, std::string& why);

    // Releases all images. Commands that are under way still finish.
    void clear() { kept_ = {}; }

private:
    struct Kept {
        unsigned texture = 0;
        const TextureFormat* format = nullptr;
        std::uint32_t width = 0, height = 0;
        cl::Image2D image;
    };
    std::array<Kept, 7> kept_;  // in the order of Channels
};

// Hands the images to OpenCL after `wait`, enqueues `kernel` with what it must wait for, and hands
// them back: the returned event is the end of that. They are handed back when `kernel` throws too.
// Throws DeviceError.
cl::Event while_acquired(const Sharing& sharing, const cl::CommandQueue& queue,
                         const ImportImages& images, const WaitList& wait,
                         const std::function<cl::Event(const WaitList&)>& kernel);

}  // namespace clgi::gl
