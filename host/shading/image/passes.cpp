// SPDX-License-Identifier: MIT
#include <clgi/passes/gbuffer.hpp>
#include <clgi/passes/image.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

#include "core/opencl/check.hpp"
#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "shading/lights/emitter_buffers.hpp"

namespace clgi {
namespace {

std::size_t blocks(std::size_t pixels) { return (pixels + COMPACT_BLOCK - 1) / COMPACT_BLOCK; }

std::size_t pixels_of(const RefineParams& params) {
    return static_cast<std::size_t>(params.width) * params.height;
}

void need_strides(const PassKernel& pass, const RefineParams& params) {
    need_step(pass, params.step);
    need_stride(pass, "stride", params.stride,
                static_cast<std::size_t>(params.width) * params.height);
    need_stride(pass, "low_stride", params.low_stride,
                low_size(params.width, params.step) * low_size(params.height, params.step));
}

std::size_t plane_bytes(std::size_t planes, std::size_t stride) {
    return planes * stride * sizeof(float);
}

}  // namespace

ImagePasses::ImagePasses(const Programs& programs, const BuildOptions& options) {
    const auto kernel = [&](const char* pass) { return programs.kernel("image", pass, options); };
    const auto showing = [&](const char* pass) {
        return programs.kernel("image", pass, options, "", {"combine", "environment"});
    };
    const auto refining = [&](const char* pass) {
        return programs.kernel("image", pass, options, "",
                               {"gather", "count", "compact", "upsample", "place"});
    };
    const auto few = [&](const char* pass) {
        return in_small_groups(refining(pass), programs.device(), options);
    };
    gather_ = refining("gather");
    count_ = few("count");
    compact_ = few("compact");
    upsample_ = refining("upsample");
    place_ = refining("place");
    combine_ = showing("combine");
    accumulate_ = kernel("accumulate");
    tonemap_ = kernel("tonemap");
    environment_ = showing("environment");
}

void ImagePasses::build(std::initializer_list<const char*> passes) const {
    build_named({gather_, count_, compact_, upsample_, place_, combine_, accumulate_, tonemap_,
                 environment_},
                passes);
}

cl::Event ImagePasses::gather(const cl::CommandQueue& queue, const GatherParams& params,
                              const Range& range, const cl::Buffer& point_count,
                              const cl::Buffer& points, const cl::Buffer& lights,
                              const cl::Buffer& negative, const cl::Buffer& irradiance,
                              const WaitList& wait) const {
    need_stride(gather_, "stride", params.stride, end_of(range));
    need(gather_, "point_count", point_count, sizeof(std::uint32_t));
    need(gather_, "points", points, point_bytes(gather_.storage, params.stride));
    need(gather_, "lights", lights, params.vpl_count * sizeof(Vpl));
    need(gather_, "negative", negative, params.negative_count * sizeof(Vpl));
    need(gather_, "irradiance", irradiance, irradiance_bytes(gather_.storage, params.stride));
    return launch(gather_, queue, packets(gather_, range), wait, params, point_count, points,
                  lights, negative, irradiance);
}

cl::Event ImagePasses::count(const cl::CommandQueue& queue, std::uint32_t pixels,
                             const cl::Buffer& flags, const cl::Buffer& counts,
                             const WaitList& wait) const {
    need(count_, "flags", flags, pixels);
    need(count_, "counts", counts, blocks(pixels) * sizeof(std::uint32_t));
    return launch(count_, queue, blocks(pixels), wait, pixels, flags, counts);
}

cl::Event ImagePasses::compact(const cl::CommandQueue& queue, const RefineParams& params,
                               const cl::Buffer& flags, const cl::Buffer& offsets,
                               const cl::Buffer& planes, const cl::Buffer& listed,
                               const cl::Buffer& points, const cl::Buffer& point_count,
                               const WaitList& wait) const {
    const std::size_t pixels = pixels_of(params);
    need_stride(compact_, "stride", params.stride, pixels);
    need(compact_, "flags", flags, pixels);
    need(compact_, "offsets", offsets, blocks(pixels) * sizeof(std::uint32_t));
    need(compact_, "planes", planes, point_bytes(compact_.storage, params.stride));
    need(compact_, "listed", listed, plane_bytes(1, params.stride));
    need(compact_, "points", points, point_bytes(compact_.storage, params.stride));
    need(compact_, "point_count", point_count, sizeof(std::uint32_t));
    return launch(compact_, queue, blocks(pixels), wait, params, flags, offsets, planes, listed,
                  points, point_count);
}

cl::Event ImagePasses::upsample(const cl::CommandQueue& queue, const RefineParams& params,
                                const cl::Buffer& planes, const cl::Buffer& points,
                                const cl::Buffer& low, const cl::Buffer& irradiance,
                                const cl::Buffer& flags, const WaitList& wait) const {
    need_strides(upsample_, params);
    need(upsample_, "planes", planes, point_bytes(upsample_.storage, params.stride));
    need(upsample_, "points", points, point_bytes(upsample_.storage, params.low_stride));
    need(upsample_, "low", low, irradiance_bytes(upsample_.storage, params.low_stride));
    need(upsample_, "irradiance", irradiance, irradiance_bytes(upsample_.storage, params.stride));
    need(upsample_, "flags", flags, pixels_of(params));
    return launch(upsample_, queue,
                  packets(upsample_, params.width) * low_size(params.height, params.step), wait,
                  params, planes, points, low, irradiance, flags);
}

cl::Event ImagePasses::place(const cl::CommandQueue& queue, const RefineParams& params,
                             const cl::Buffer& point_count, const cl::Buffer& listed,
                             const cl::Buffer& refined, const cl::Buffer& irradiance,
                             const WaitList& wait) const {
    need_stride(place_, "stride", params.stride, pixels_of(params));
    need(place_, "point_count", point_count, sizeof(std::uint32_t));
    need(place_, "listed", listed, plane_bytes(1, params.stride));
    need(place_, "refined", refined, irradiance_bytes(place_.storage, params.stride));
    need(place_, "irradiance", irradiance, irradiance_bytes(place_.storage, params.stride));
    return launch(place_, queue, packets(place_, pixels_of(params)), wait, params, point_count,
                  listed, refined, irradiance);
}

cl::Event ImagePasses::combine(const cl::CommandQueue& queue, const CombineParams& params,
                               const View& view, const DeviceScene& scene,
                               const CombineBuffers& buffers, const WaitList& wait) const {
    const std::size_t pixels = static_cast<std::size_t>(params.width) * params.height;
    need_stride(combine_, "stride", params.stride, pixels);
    if (view.width != params.width || view.height != params.height)
        throw Error("image.combine: the view is " + std::to_string(view.width) + "x" +
                    std::to_string(view.height) + ", " + std::to_string(params.width) + "x" +
                    std::to_string(params.height) + " needed");
    need_depth_words(combine_, params.depth_words, buffers.emitters.kind);
    need_emitters(combine_, buffers.emitters, params.emitter_count);
    need(combine_, "planes", buffers.gbuffer.planes,
         gbuffer_bytes(combine_.storage, params.stride));
    need(combine_, "ids", buffers.gbuffer.ids, plane_bytes(GBUFFER_ID_PLANES, params.stride));
    if (params.effects & COMBINE_INDIRECT)
        need(combine_, "irradiance", buffers.irradiance,
             irradiance_bytes(combine_.storage, params.stride));
    need(combine_, "radiance", buffers.radiance, plane_bytes(RADIANCE_PLANES, params.stride));
    need(combine_, "non_finite", buffers.non_finite, sizeof(std::uint32_t));
    return launch(combine_, queue, packets(combine_, pixels), wait, params, view,
                  buffers.emitters.emitters, buffers.emitters.views, buffers.emitters.visibility,
                  scene.materials(), buffers.gbuffer.planes, buffers.gbuffer.ids,
                  buffers.irradiance, buffers.radiance, buffers.non_finite);
}

CombineParams combine_params(const DeviceScene& scene, const View& view, std::uint32_t stride,
                             std::size_t emitters, Pixels shadow_maps) {
    CombineParams out{};
    out.width = view.width;
    out.height = view.height;
    out.stride = stride;
    out.emitter_count = static_cast<std::uint32_t>(emitters);
    out.exposure = static_cast<float>(scene.frame().exposure);
    out.texel_bias = 1.0f;
    out.effects = scene.info().flags & SCENE_HAS_SHARES ? COMBINE_MATERIALS : 0;
    if (scene.info().flags & SCENE_HAS_DETAIL) out.effects |= COMBINE_MAPPED_NORMALS;
    out.depth_words = shadow_maps == Pixels::depth ? 1 : 2;
    return out;
}

EnvironmentParams environment_params(const DeviceScene& scene, std::uint32_t stride,
                                     double turned) {
    const Environment& environment = scene.environment().value();
    const double turns = (double{environment.rotation} + turned) / glm::two_pi<double>();
    return {glm::vec4(environment.factor, 0.0f), static_cast<std::uint32_t>(environment.width),
            static_cast<std::uint32_t>(environment.height), stride,
            static_cast<float>(turns - std::floor(turns))};
}

cl::Event ImagePasses::environment(const cl::CommandQueue& queue, const EnvironmentParams& params,
                                   const View& view, const cl::Buffer& texels,
                                   const cl::Buffer& planes, const cl::Buffer& radiance,
                                   const WaitList& wait) const {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
    if (params.environment_width < 1 || params.environment_height < 1)
        throw Error("image.environment: the picture is " +
                    std::to_string(params.environment_width) + "x" +
                    std::to_string(params.environment_height) + ", at least 1x1 needed");
    need_stride(environment_, "stride", params.stride, pixels);
    need(environment_, "texels", texels,
         plane_bytes(3, std::size_t{params.environment_width} * params.environment_height));
    need(environment_, "planes", planes,
         gbuffer_bytes(environment_.storage, params.stride, GBUFFER_NORMAL + 3));
    need(environment_, "radiance", radiance, plane_bytes(RADIANCE_PLANES, params.stride));
    return launch(environment_, queue, packets(environment_, pixels), wait, params, view, texels,
                  planes, radiance);
}

cl::Event ImagePasses::accumulate(const cl::CommandQueue& queue, const AccumulateParams& params,
                                  const cl::Buffer& radiance, const cl::Buffer& mean,
                                  const WaitList& wait) const {
    need_stride(accumulate_, "stride", params.stride, params.pixels);
    need(accumulate_, "radiance", radiance, plane_bytes(RADIANCE_PLANES, params.stride));
    need(accumulate_, "mean", mean, plane_bytes(MEAN_PLANES, params.stride));
    if (params.kept != 0)
        need_range<int>("image.accumulate", "kept", static_cast<int>(params.kept), MEAN_BEFORE,
                        MEAN_PLANES - 1);
    return launch(accumulate_, queue, packets(accumulate_, params.pixels), wait, params, radiance,
                  mean);
}

cl::Event ImagePasses::tonemap(const cl::CommandQueue& queue, const TonemapParams& params,
                               const cl::Buffer& radiance, const cl::Buffer& preview,
                               const WaitList& wait) const {
    const std::size_t pixels = static_cast<std::size_t>(params.width) * params.height;
    need_stride(tonemap_, "stride", params.stride, pixels);
    need(tonemap_, "radiance", radiance, plane_bytes(RADIANCE_PLANES, params.stride));
    need(tonemap_, "preview", preview, pixels * sizeof(std::uint32_t));
    return launch(tonemap_, queue, pixels, wait, params, radiance, preview);
}

}  // namespace clgi
