// SPDX-License-Identifier: MIT
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/receivers.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

void need_seen(const PassKernel& pass, const GBuffer& seen, std::size_t stride) {
    if (seen.stride != stride)
        throw Error(pass.name + ": the G-buffer's stride is " + std::to_string(seen.stride) + ", " +
                    std::to_string(stride) + " needed");
    need(pass, "planes", seen.planes, gbuffer_bytes(pass.storage, stride, GBUFFER_BASE + 3));
    need(pass, "ids", seen.ids, GBUFFER_ID_PLANES * word * stride);
}

void need_list(const PassKernel& pass, const PixelParams& params, const PixelList& list) {
    need_stride(pass, "stride", params.stride, params.count);
    need(pass, "pixels", list.pixels, (std::size_t{params.first} + params.count) * word);
    need(pass, "listed", list.listed, word);
}

void need_probes(const PassKernel& pass, const ProbeParams& params, const GBuffer& seen,
                 const cl::Buffer& shown, const cl::Buffer& probes, const cl::Buffer& states) {
    if (params.step < 2 || params.step > 64)
        throw Error(pass.name + ": step is " + std::to_string(params.step) + ", 2 to 64 needed");
    const auto across = [&](std::uint32_t size) {
        return (size - params.step / 2 + params.step - 1) / params.step;
    };
    if (params.width <= params.step / 2 || params.height <= params.step / 2 ||
        params.columns != across(params.width) || params.rows != across(params.height))
        throw Error(pass.name + ": " + std::to_string(params.columns) + "x" +
                    std::to_string(params.rows) + " probes every " + std::to_string(params.step) +
                    " pixels do not fit a picture of " + std::to_string(params.width) + "x" +
                    std::to_string(params.height));
    const std::size_t count = std::size_t{params.columns} * params.rows;
    need_stride(pass, "pixel_stride", params.pixel_stride,
                std::size_t{params.width} * params.height);
    need_stride(pass, "probe_stride", params.probe_stride, count);
    need_seen(pass, seen, params.pixel_stride);
    need(pass, "shown", shown, irradiance_bytes(pass.storage, params.pixel_stride));
    need(pass, "probes", probes, 4 * word * params.probe_stride);
    need(pass, "states", states, count * word);
}

}  // namespace

ReceiverPasses::ReceiverPasses(const Programs& programs, const BuildOptions& options) {
    BuildOptions one = options;
    one.packet_width = 1;
    const auto kernel = [&](const char* pass) { return programs.kernel("transfer", pass, one); };
    other_sides_ = kernel("other_sides");
    pixels_ = kernel("pixels");
    place_ = kernel("place");
    show_ = kernel("show");
    compare_probes_ = kernel("compare_probes");
    compare_gloss_ = kernel("compare_gloss");
    undersampled_ = kernel("undersampled");
    add_gloss_ = kernel("add_gloss");
}

void ReceiverPasses::build(std::initializer_list<const char*> passes) const {
    build_named({other_sides_, pixels_, place_, show_, compare_probes_, compare_gloss_,
                 undersampled_, add_gloss_},
                passes);
}

cl::Event ReceiverPasses::other_sides(const cl::CommandQueue& queue, const SidesParams& params,
                                      const cl::Buffer& fronts, const ReceiverBuffers& receivers,
                                      const WaitList& wait) const {
    need_stride(other_sides_, "stride", params.stride, std::size_t{params.first} + params.count);
    need(other_sides_, "fronts", fronts, params.count * word);
    need(other_sides_, "receivers", receivers.planes, RECEIVER_PLANES * word * params.stride);
    return launch(other_sides_, queue, params.count, wait, params, fronts, receivers.planes);
}

cl::Event ReceiverPasses::pixels(const cl::CommandQueue& queue, const PixelParams& params,
                                 const PixelList& list, const DeviceScene& scene,
                                 const GBuffer& seen, const ReceiverBuffers& receivers,
                                 const cl::Buffer& exponents, const WaitList& wait) const {
    need_list(pixels_, params, list);
    need_seen(pixels_, seen, params.pixel_stride);
    need(pixels_, "receivers", receivers.planes, RECEIVER_PLANES * word * params.stride);
    need(pixels_, "exponents", exponents, word * params.stride);
    return launch(pixels_, queue, params.count, wait, params, list.pixels, list.listed, seen.planes,
                  seen.ids, scene.materials(), receivers.planes, exponents);
}

cl::Event ReceiverPasses::place(const cl::CommandQueue& queue, const PixelParams& params,
                                const PixelList& list, const cl::Buffer& light,
                                const cl::Buffer& shown, const WaitList& wait) const {
    need_list(place_, params, list);
    need(place_, "light", light, 3 * word * params.stride);
    need(place_, "shown", shown, irradiance_bytes(place_.storage, params.pixel_stride));
    return launch(place_, queue, params.count, wait, params, list.pixels, list.listed, light,
                  shown);
}

cl::Event ReceiverPasses::show(const cl::CommandQueue& queue, const ShowVerticesParams& params,
                               const DeviceScene& scene, const cl::Buffer& other_side,
                               const GBuffer& seen, const cl::Buffer& light,
                               const cl::Buffer& shown, const WaitList& wait) const {
    need_stride(show_, "pixel_stride", params.pixel_stride, params.pixel_count);
    need_stride(show_, "receiver_stride", params.receiver_stride, scene.info().vertex_count);
    if (params.triangle_count > scene.info().triangle_count)
        throw Error("transfer.show: triangle_count is " + std::to_string(params.triangle_count) +
                    ", the scene has " + std::to_string(scene.info().triangle_count));
    need_seen(show_, seen, params.pixel_stride);
    need(show_, "other_side", other_side, scene.info().vertex_count * word);
    need(show_, "light", light, 3 * word * params.receiver_stride);
    need(show_, "shown", shown, irradiance_bytes(show_.storage, params.pixel_stride));
    return launch(show_, queue, params.pixel_count, wait, params, scene.triangles(),
                  scene.positions(), other_side, seen.planes, seen.ids, light, shown);
}

cl::Event ReceiverPasses::compare_probes(const cl::CommandQueue& queue, const ProbeParams& params,
                                         const GBuffer& seen, const cl::Buffer& shown,
                                         const cl::Buffer& probes, const cl::Buffer& states,
                                         const WaitList& wait) const {
    need_probes(compare_probes_, params, seen, shown, probes, states);
    return launch(compare_probes_, queue, std::size_t{params.columns} * params.rows, wait, params,
                  seen.ids, shown, probes, states);
}

cl::Event ReceiverPasses::compare_gloss(const cl::CommandQueue& queue, const ProbeParams& params,
                                        const DeviceScene& scene, const GBuffer& seen,
                                        const cl::Buffer& shown, const cl::Buffer& gloss,
                                        const cl::Buffer& probes, const cl::Buffer& states,
                                        const WaitList& wait) const {
    need_probes(compare_gloss_, params, seen, shown, probes, states);
    need(compare_gloss_, "gloss", gloss,
         irradiance_bytes(compare_gloss_.storage, params.pixel_stride));
    return launch(compare_gloss_, queue, std::size_t{params.columns} * params.rows, wait, params,
                  scene.materials(), seen.planes, seen.ids, shown, gloss, probes, states);
}

cl::Event ReceiverPasses::undersampled(const cl::CommandQueue& queue, const ProbeParams& params,
                                       const GBuffer& seen, const cl::Buffer& probes,
                                       const cl::Buffer& states, const cl::Buffer& shown,
                                       const cl::Buffer& flags, const WaitList& wait) const {
    need_probes(undersampled_, params, seen, shown, probes, states);
    const std::size_t pixels = std::size_t{params.width} * params.height;
    need(undersampled_, "flags", flags, pixels);
    return launch(undersampled_, queue, pixels, wait, params, seen.ids, probes, states, shown,
                  flags);
}

cl::Event ReceiverPasses::add_gloss(const cl::CommandQueue& queue, const AddGlossParams& params,
                                    const DeviceScene& scene, const GBuffer& seen,
                                    const cl::Buffer& light, const cl::Buffer& radiance,
                                    const cl::Buffer& non_finite, const WaitList& wait) const {
    need_stride(add_gloss_, "pixel_stride", params.pixel_stride, params.pixel_count);
    need_seen(add_gloss_, seen, params.pixel_stride);
    need(add_gloss_, "light", light, irradiance_bytes(add_gloss_.storage, params.pixel_stride));
    need(add_gloss_, "radiance", radiance, 3 * word * params.pixel_stride);
    need(add_gloss_, "non_finite", non_finite, word);
    return launch(add_gloss_, queue, params.pixel_count, wait, params, scene.materials(),
                  seen.planes, seen.ids, light, radiance, non_finite);
}

}  // namespace clgi
