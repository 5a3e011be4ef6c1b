// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/lights.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "shading/lights/emitter_buffers.hpp"

namespace clgi {

LightPasses::LightPasses(const Programs& programs, const BuildOptions& options)
    : textures_(options.textures) {
    // A work-item is a light here, not a packet: one lane serves, and compiles in half the time.
    BuildOptions scalar = options;
    scalar.packet_width = 1;
    const auto placing = [&](const char* pass) {
        return programs.kernel("lights", pass, scalar, "",
                               {"accept_mask", "accept_list", "fetch", "negative"});
    };
    const auto few = [&](const char* pass) {
        return in_small_groups(placing(pass), programs.device(), options);
    };
    accept_mask_ = few("accept_mask");
    accept_list_ = placing("accept_list");
    fetch_ = few("fetch");
    negative_ = few("negative");
    direct_ = programs.kernel("lights", "direct", options);
}

void LightPasses::build(std::initializer_list<const char*> passes) const {
    build_named({accept_mask_, accept_list_, fetch_, negative_, direct_}, passes);
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
         std::max(params.vpl_count, 1u) * sizeof(std::uint32_t));
    const std::size_t items = group_size(accept_list_);
    return launch(accept_list_, queue, items, wait, params, emitters, mask, accepted,
                  cl::Local(items * sizeof(std::uint32_t)));
}

cl::Event LightPasses::fetch(const cl::CommandQueue& queue, const FetchParams& params,
                             const DeviceScene& scene, const EmitterBuffers& sources,
                             const cl::Buffer& accepted, const cl::Buffer& lights,
                             const WaitList& wait) const {
    if (scene.needs_textures() && !textures_)
        throw Error(
            "lights.fetch: the scene has textures, alpha masks or blended surfaces, the kernels "
            "were built "
            "without (BuildOptions::textures)");
    if (sources.kind != Pixels::visibility)
        throw Error("lights.fetch: the shadow maps hold depth alone, visibility needed");
    need_emitters(fetch_, sources, params.emitter_count);
    need(fetch_, "accepted", accepted, params.vpl_count * sizeof(std::uint32_t));
    need(fetch_, "lights", lights, params.vpl_count * sizeof(Vpl));
    return launch(fetch_, queue, params.vpl_count, wait, params, scene.info(), sources.emitters,
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
    need(negative_, "lights", lights, params.vpl_count * sizeof(Vpl));
    need(negative_, "negative", negative, params.negative_count * sizeof(Vpl));
    return launch(negative_, queue, samples, wait, params, view, planes, lights, negative);
}

cl::Event LightPasses::direct(const cl::CommandQueue& queue, const DirectParams& params,
                              const EmitterBuffers& sources, const cl::Buffer& planes,
                              const cl::Buffer& irradiance, const cl::Buffer& non_finite,
                              const WaitList& wait) const {
    need_stride(direct_, "stride", params.stride, params.point_count);
    need_depth_words(direct_, params.depth_words, sources.kind);
    need_emitters(direct_, sources, std::size_t{params.first_emitter} + params.emitter_count);
    need(direct_, "planes", planes,
         gbuffer_bytes(direct_.storage, params.stride, GBUFFER_GEOMETRIC + 3));
    need(direct_, "irradiance", irradiance, irradiance_bytes(direct_.storage, params.stride));
    need(direct_, "non_finite", non_finite, sizeof(std::uint32_t));
    return launch(direct_, queue, packets(direct_, params.point_count), wait, params,
                  sources.emitters, sources.views, sources.visibility, planes, irradiance,
                  non_finite);
}

}  // namespace clgi
