// Camera views drawn by OpenGL instead of OpenCL: render --gbuffer gl.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/renderer.hpp>
#include <memory>
#include <string>
#include <vector>

namespace clgi::program {

// Has its own OpenGL context, on the thread that makes it.
class GlFrames {
public:
    // Throws DeviceError if there is no OpenGL without a window, Error if the program was built
    // without OpenGL.
    GlFrames();
    ~GlFrames();
    GlFrames(const GlFrames&) = delete;
    GlFrames& operator=(const GlFrames&) = delete;

    // The properties that an OpenCL context needs to share textures; empty if the device cannot.
    std::vector<cl_context_properties> properties(const cl::Device& device) const;

    // Copies the scene of a renderer to OpenGL. The queue is in order.
    void open(const cl::CommandQueue& queue, const Renderer& renderer);

    // Draws the view, converts it to the renderer's G-buffer and enqueues the lighting.
    cl::Event render(Renderer& renderer, const Camera& camera);

    const std::string& renderer() const;  // "surfaceless: llvmpipe ..., OpenGL 4.5"
    const std::string& path() const;      // "zero copy: ...", "copied: ..."
    std::uint32_t non_finite() const;     // texels, since the start

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi::program
