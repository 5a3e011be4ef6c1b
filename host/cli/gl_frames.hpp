// Camera views drawn by OpenGL instead of OpenCL: render --gbuffer gl.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <memory>
#include <string>
#include <vector>

namespace clgi::cli {

// Lives in an OpenGL context of its own, on the thread that makes it.
class GlFrames {
public:
    // Throws DeviceError where there is no OpenGL without a window, Error where the program was
    // built without OpenGL.
    GlFrames();
    ~GlFrames();
    GlFrames(const GlFrames&) = delete;
    GlFrames& operator=(const GlFrames&) = delete;

    // What an OpenCL context must be made with to share textures; empty where the device cannot.
    std::vector<cl_context_properties> properties(const cl::Device& device) const;

    // Takes the scene over to OpenGL. The queue keeps its order; `build` is the solver's.
    void open(const cl::CommandQueue& queue, const DeviceScene& scene, const BuildOptions& build);

    // Enqueues a frame: the view is drawn, brought into the solver's G-buffer and lit.
    cl::Event render(SecondOrderSolver& solver, const Camera& camera);

    const std::string& renderer() const;  // "surfaceless: llvmpipe ..., OpenGL 4.5"
    const std::string& path() const;      // "zero copy: ...", "copied: ..."
    std::uint32_t non_finite() const;     // texels, since the start

private:
    class State;
    std::unique_ptr<State> state_;
};

}  // namespace clgi::cli
