// SPDX-License-Identifier: MIT
#include "program/gl_frames.hpp"

#include <clgi/gl/context.hpp>
#include <clgi/gl/gbuffer.hpp>
#include <clgi/gl/renderer.hpp>
#include <optional>

namespace clgi::program {

class GlFrames::State {
public:
    gl::HeadlessContext context;  // first, so that it outlives what needs it
    cl::CommandQueue queue;
    const DeviceScene* scene = nullptr;
    std::optional<gl::SceneRenderer> renderer;
    std::optional<gl::GBufferImport> import;
};

GlFrames::GlFrames() : state_(std::make_unique<State>()) {}

GlFrames::~GlFrames() = default;

std::vector<cl_context_properties> GlFrames::properties(const cl::Device& device) const {
    return gl::sharing_properties(device);
}

void GlFrames::open(const cl::CommandQueue& queue, const Renderer& renderer) {
    const DeviceScene& scene = renderer.scene();
    state_->queue = queue;
    state_->scene = &scene;
    state_->renderer.emplace(queue, scene);
    state_->import.emplace(queue.getInfo<CL_QUEUE_CONTEXT>(), queue.getInfo<CL_QUEUE_DEVICE>(),
                           renderer.second_order()->options().build);
}

cl::Event GlFrames::render(Renderer& renderer, const Camera& camera) {
    const SecondOrderSolver& solver = *renderer.second_order();
    const View view =
        make_view(camera, state_->scene->frame(), solver.options().width, solver.options().height);
    state_->renderer->draw(view);
    // On a queue in order the last frame has been lit before its G-buffer is written anew.
    const cl::Event ready = state_->import->convert(state_->queue, view, *state_->scene,
                                                    state_->renderer->textures(), solver.gbuffer());
    return renderer.render(camera, solver.gbuffer(), {ready});
}

const std::string& GlFrames::renderer() const { return state_->context.description(); }

const std::string& GlFrames::path() const { return state_->import->path(); }

std::uint32_t GlFrames::non_finite() const { return state_->import->non_finite(); }

}  // namespace clgi::program
