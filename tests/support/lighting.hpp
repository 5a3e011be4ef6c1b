// Indirect lights placed by the passes, and points lit by them: the middle of a frame without its
// camera. Values are physical: lumen and lux, whatever the scene's frame and exposure are.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/emitters.hpp>
#include <utility>

#include "drawing.hpp"

namespace clgi::test {

inline const LightPasses& light_passes(const Build& build = usual_build()) {
    return shared_passes<LightPasses>(build);
}

inline const ImagePasses& image_passes(const Build& build = usual_build()) {
    return shared_passes<ImagePasses>(build);
}

struct PlacedLights {
    EmitterSet set;
    std::vector<cl_uint> accepted;  // [N] Halton index of each light of a spot
    std::vector<Vpl> lights;        // [N] local frame
};

// What multiplies all flux, and all discs.
struct FetchScale {
    float flux = 1.0f, footprint = 1.0f;
};

inline PlacedLights place_lights(const DeviceScene& scene, const EmitterOptions& options,
                                 const LightPasses& passes = light_passes(),
                                 const GBufferPasses& drawn_by = gbuffer_passes(),
                                 const FetchScale& scale = {}) {
    const cl::CommandQueue& queue = device().queue;
    PlacedLights out;
    out.set = make_emitters(scene, options);
    if (out.set.vpl_count == 0) return out;
    const RasterBuffers buffers = raster_buffers(scene, out.set.pixels);
    for (const View& view : out.set.views) draw_visibility(drawn_by, scene, view, buffers);
    const EmitterBuffers sources{upload(out.set.emitters), upload(out.set.views), buffers.pixels};
    const cl::Buffer accepted = upload(std::vector<cl_uint>(out.set.vpl_count));
    for (std::size_t e = 0; e < out.set.emitters.size(); ++e) {
        if (out.set.candidates[e] == 0) continue;
        const AcceptParams params{static_cast<cl_uint>(e), out.set.candidates[e], 0, 0};
        const cl::Buffer mask = empty<cl_uint>(params.candidate_count / 32);
        passes.accept_mask(queue, params, sources.emitters, mask);
        passes.accept_list(queue, params, sources.emitters, mask, accepted);
        queue.finish();
    }
    const cl::Buffer lights = empty<Vpl>(out.set.vpl_count);
    const FetchParams params{static_cast<cl_uint>(out.set.vpl_count),
                             static_cast<cl_uint>(out.set.emitters.size()), scale.flux,
                             scale.footprint};
    passes.fetch(queue, params, scene, sources, accepted, lights);
    out.accepted = download<cl_uint>(accepted, out.set.vpl_count);
    out.lights = download<Vpl>(lights, out.set.vpl_count);
    return out;
}

inline PlacedLights place_lights(const DeviceScene& scene, const EmitterOptions& options,
                                 const Build& build) {
    return place_lights(scene, options, light_passes(build), gbuffer_passes(build));
}

inline double total_flux(const DeviceScene& scene, const std::vector<Vpl>& lights) {
    double sum = 0.0;
    for (const Vpl& light : lights) sum += double{light.flux.x};
    return sum * scene.frame().exposure / (scene.frame().scale * scene.frame().scale);
}

struct Receiver {
    glm::vec3 position;  // local frame
    glm::vec3 normal;
};

inline std::vector<float> point_planes(const std::vector<Receiver>& receivers,
                                       std::uint32_t stride) {
    std::vector<float> planes(POINT_PLANES * std::size_t{stride});
    for (std::size_t i = 0; i < receivers.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            planes[c * stride + i] = receivers[i].position[c];
            planes[(3 + c) * stride + i] = receivers[i].normal[c];
        }
    return planes;
}

// Irradiance of every receiver as the device has it: in local units, exposed.
inline std::vector<glm::vec3> gather(const std::vector<Receiver>& receivers,
                                     const std::vector<Vpl>& lights,
                                     const std::vector<Vpl>& negative,
                                     const ImagePasses& passes = image_passes()) {
    const auto count = static_cast<cl_uint>(receivers.size());
    const std::uint32_t stride = std::max(padded(count), 16u);
    const cl::Buffer irradiance = empty<float>(IRRADIANCE_PLANES * stride);
    const cl::Buffer points = upload_planes(point_planes(receivers, stride), stride);
    const cl::Buffer point_count = upload(std::vector<cl_uint>{count});
    const auto held = [](std::vector<Vpl> values) {
        if (values.empty()) values.resize(1);
        return upload(values);
    };
    const cl::Buffer positive_lights = held(lights), negative_vpls = held(negative);
    const GatherParams params{stride, static_cast<cl_uint>(lights.size()),
                              static_cast<cl_uint>(negative.size()), 0};
    passes.gather(device().queue, params, count, point_count, points, positive_lights,
                  negative_vpls, irradiance);
    const auto planes = read_irradiance(irradiance, stride);
    std::vector<glm::vec3> out;
    for (std::size_t i = 0; i < count; ++i)
        out.emplace_back(planes[i], planes[stride + i], planes[2 * stride + i]);
    return out;
}

// The same lights without their discs: the pure 1/d^2 kernel, which the closed forms are about.
inline std::vector<Vpl> bare(std::vector<Vpl> lights) {
    for (Vpl& light : lights) light.position.w = light.normal.w = 0.0f;
    return lights;
}

// Lux at one place of the world from these lights.
inline double lux_at(const DeviceScene& scene, const std::vector<Vpl>& lights,
                     const glm::dvec3& position, const glm::vec3& normal,
                     const Build& build = usual_build()) {
    const Receiver receiver{scene.frame().to_local(position), normal};
    const UsualBuild usual(build);
    return gather({receiver}, lights, {})[0].x * scene.frame().exposure;
}

}  // namespace clgi::test
