// Textures to device buffers: OpenGL copies into pixel buffers, OpenCL from there.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/passes/import.hpp>

#include "gl/objects.hpp"
#include "gl/texture_facts.hpp"

namespace clgi::gl {

class Readback {
public:
    explicit Readback(const cl::Context& context) : context_(context) {}
    ~Readback();
    Readback(const Readback&) = delete;
    Readback& operator=(const Readback&) = delete;

    // Reads all textures; `copied` are the events after which the buffers hold them. Pixel buffers
    // stay mapped while OpenCL reads them, until the next call or the destructor, which wait for
    // it to end, well or not.
    ImportBuffers read(const cl::CommandQueue& queue, Channels& channels, const View& view,
                       WaitList& copied);

    // The kernel that reads the buffers.
    void set_reader(const cl::Event& event) { users_.push_back(event); }

private:
    struct Slot {
        Object pixels;  // OpenGL's, packed rows of texels
        std::size_t bytes = 0;
        cl::Buffer buffer;  // the device's
        bool mapped = false;
    };
    void settle();

    cl::Context context_;
    std::array<Slot, 7> slots_;  // in the order of Channels
    WaitList users_;             // what the slots are still used by
};

}  // namespace clgi::gl
