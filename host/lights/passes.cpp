// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/passes/lights.hpp>
#include <clgi/planes.hpp>

#include "opencl/launch.hpp"
#include "opencl/program.hpp"

namespace clgi {

LightPasses::LightPasses(const cl::Context& context, const cl::Device& device,
                         const BuildOptions& options) {
    // A work-item is a light here, not a packet: one lane serves, and compiles in half the time.
    BuildOptions scalar = options;
    scalar.packet_width = 1;
    auto kernels = build_room(context, device, "lights",
                              {"accept_mask", "accept_list", "fetch", "negative"}, scalar);
    accept_mask_ = kernels[0];
    accept_list_ = kernels[1];
    fetch_ = kernels[2];
    negative_ = kernels[3];
    textures_ = options.textures;
    for (PassKernel* pass : {&accept_mask_, &fetch_, &negative_})
        prefer_small_groups(*pass, device, options);
}

cl::Event LightPasses::accept_mask(const cl::CommandQueue& queue, const AcceptParams& params,
                                   const cl::Buffer& emitters, const cl::Buffer& mask,
                                   const WaitList& wait) const {
    if (params.candidate_count % 32 != 0)
        throw Error("lights.accept_mask: candidate_count is " +
                    std::to_string(params.candidate_count) + ", a multiple of 32 needed");
    need(accept_mask_, "emitters", emitters, (std::size_t{params.emitter} + 1) * sizeof(Emitter));
    need(accept_mask_, "mask", mask, params.candidate_count / 8);
    return launch(accept_mask_, queue, params.candidate_count / 32, wait, params, emitters, mask);
}

cl::Event LightPasses::accept_list(const cl::CommandQueue& queue, const AcceptParams& params,
                                   const cl::Buffer& emitters, const cl::Buffer& mask,
                                   const cl::Buffer& accepted, const WaitList& wait) const {
    need(accept_list_, "emitters", emitters, (std::size_t{params.emitter} + 1) * sizeof(Emitter));
    need(accept_list_, "mask", mask, params.candidate_count / 8);
    need(accept_list_, "accepted", accepted,
         std::max(params.light_count, 1u) * sizeof(std::uint32_t));
    return launch(accept_list_, queue, accept_list_.local_size, wait, params, emitters, mask,
                  accepted, cl::Local(accept_list_.local_size * sizeof(std::uint32_t)));
}

cl::Event LightPasses::fetch(const cl::CommandQueue& queue, const FetchParams& params,
                             const DeviceScene& scene, const SourceBuffers& sources,
                             const cl::Buffer& accepted, const cl::Buffer& lights,
                             const WaitList& wait) const {
    if (scene.needs_textures() && !textures_)
        throw Error(
            "lights.fetch: the scene has textures or alpha masks, the kernels were built "
            "without (BuildOptions::textures)");
    need(fetch_, "views", sources.views, sources.view_count * sizeof(View));
    need(fetch_, "visibility", sources.visibility, sources.pixels * sizeof(std::uint64_t));
    need(fetch_, "emitters", sources.emitters, params.emitter_count * sizeof(Emitter));
    need(fetch_, "accepted", accepted, params.light_count * sizeof(std::uint32_t));
    need(fetch_, "lights", lights, params.light_count * sizeof(IndirectLight));
    return launch(fetch_, queue, params.light_count, wait, params, scene.info(), sources.emitters,
                  sources.views, sources.visibility, accepted, scene, lights);
}

cl::Event LightPasses::negative(const cl::CommandQueue& queue, const NegativeParams& params,
                                const View& view, const cl::Buffer& planes,
                                const cl::Buffer& lights, const cl::Buffer& negative,
                                const WaitList& wait) const {
    return this->negative(queue, params, Range(params.negative_count), view, planes, lights,
                          negative, wait);
}

cl::Event LightPasses::negative(const cl::CommandQueue& queue, const NegativeParams& params,
                                const Range& samples, const View& view, const cl::Buffer& planes,
                                const cl::Buffer& lights, const cl::Buffer& negative,
                                const WaitList& wait) const {
    if (samples.first + samples.count > params.negative_count)
        throw Error("lights.negative: the range ends at " +
                    std::to_string(samples.first + samples.count) + ", at most " +
                    std::to_string(params.negative_count) + " needed");
    if (params.stride < static_cast<std::size_t>(view.width) * view.height)
        throw Error("lights.negative: stride is " + std::to_string(params.stride) + ", at least " +
                    std::to_string(view.width * view.height) + " needed");
    need(negative_, "planes", planes,
         gbuffer_bytes(negative_.storage, params.stride, GBUFFER_GEOMETRIC + 3));
    need(negative_, "lights", lights, params.light_count * sizeof(IndirectLight));
    need(negative_, "negative", negative, params.negative_count * sizeof(IndirectLight));
    return launch(negative_, queue, samples, wait, params, view, planes, lights, negative);
}

}  // namespace clgi
