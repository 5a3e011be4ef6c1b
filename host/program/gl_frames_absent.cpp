// The program built without OpenGL: --gbuffer gl says so.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "program/gl_frames.hpp"

namespace clgi::program {

class GlFrames::State {
public:
    std::string text;
};

GlFrames::GlFrames() {
    throw Error("render: --gbuffer gl needs a program built with OpenGL (CLGI_GL)");
}

GlFrames::~GlFrames() = default;

// The constructor threw: none of these is ever reached.
std::vector<cl_context_properties> GlFrames::properties(const cl::Device&) const { return {}; }
void GlFrames::open(const cl::CommandQueue&, const Renderer&) {}
cl::Event GlFrames::render(Renderer&, const Camera&) { return {}; }
const std::string& GlFrames::renderer() const { return state_->text; }
const std::string& GlFrames::path() const { return state_->text; }
std::uint32_t GlFrames::non_finite() const { return 0; }

}  // namespace clgi::program
