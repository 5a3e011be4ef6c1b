// SPDX-License-Identifier: MIT
#include <clgi/passes/atlas.hpp>
#include <clgi/planes.hpp>

#include "opencl/launch.hpp"
#include "opencl/planes.hpp"
#include "opencl/program.hpp"

namespace clgi {
namespace {

constexpr std::size_t word = sizeof(float);

}  // namespace

AtlasPasses::AtlasPasses(const Programs& programs, const BuildOptions& options)
    : storage_(options.storage) {
    BuildOptions full = options;
    full.storage = Storage::full;
    gather_ = programs.kernel("atlas", "gather", full);
    nearest_ = programs.kernel("atlas", "nearest", full);
    complete_ = programs.kernel("atlas", "complete", full);
    show_ = programs.kernel("atlas", "show", options);
}

void AtlasPasses::build(std::initializer_list<const char*> passes) const {
    build_named({gather_, nearest_, complete_, show_}, passes);
}

cl::Event AtlasPasses::gather(const cl::CommandQueue& queue, const FillParams& params,
                              const SiteBuffers& b, const cl::Buffer& views,
                              const cl::Buffer& depth, const cl::Buffer& texels,
                              const cl::Buffer& irradiance, const cl::Buffer& filled,
                              const WaitList& wait) const {
    need_stride(gather_, "stride", params.stride, params.texel_count);
    need(gather_, "chosen", b.chosen,
         (std::size_t{params.first_shooter} + params.shooter_count) * word);
    need(gather_, "views", views, 5 * std::size_t{params.shooter_count} * sizeof(View));
    need(gather_, "sites", b.sites, b.site_count * sizeof(Site));
    need(gather_, "planes", b.planes, SITE_PLANES * word * params.site_stride);
    need(gather_, "light", b.light, SITE_LIGHT_PLANES * word * params.site_stride);
    need(gather_, "samples", b.samples, GBUFFER_PLANES * word * params.sample_stride);
    need(gather_, "weights", b.weights, word * params.sample_stride);
    need(gather_, "texels", texels, (GBUFFER_GEOMETRIC + 3) * word * params.stride);
    need(gather_, "irradiance", irradiance, 3 * word * params.stride);
    need(gather_, "filled", filled, word * params.stride);
    return launch(gather_, queue, packets(gather_, params.texel_count - params.first_texel), wait,
                  params, b.chosen, views, depth, b.sites, b.planes, b.light, b.samples, b.weights,
                  texels, irradiance, filled);
}

cl::Event AtlasPasses::nearest(const cl::CommandQueue& queue, const FillParams& params,
                               const SiteBuffers& b, const cl::Buffer& texels,
                               const cl::Buffer& reach, const WaitList& wait) const {
    need_stride(nearest_, "stride", params.stride, params.texel_count);
    need(nearest_, "planes", b.planes, SITE_PLANES * word * params.site_stride);
    need(nearest_, "balance", b.balance, BALANCE_PLANES * word * params.site_stride);
    need(nearest_, "texels", texels, (GBUFFER_GEOMETRIC + 3) * word * params.stride);
    need(nearest_, "reach", reach, word * params.stride);
    return launch(nearest_, queue, packets(nearest_, params.texel_count - params.first_texel), wait,
                  params, b.planes, b.balance, texels, reach);
}

cl::Event AtlasPasses::complete(const cl::CommandQueue& queue, const FillParams& params,
                                const cl::Buffer& reach, const cl::Buffer& filled,
                                const cl::Buffer& irradiance, const cl::Buffer& non_finite,
                                const WaitList& wait) const {
    need_stride(complete_, "stride", params.stride, params.texel_count);
    need(complete_, "reach", reach, word * params.stride);
    need(complete_, "filled", filled, word * params.stride);
    need(complete_, "irradiance", irradiance, 3 * word * params.stride);
    need(complete_, "non_finite", non_finite, word);
    return launch(complete_, queue, packets(complete_, params.texel_count - params.first_texel),
                  wait, params, reach, filled, irradiance, non_finite);
}

cl::Event AtlasPasses::show(const cl::CommandQueue& queue, const ShowParams& params,
                            const DeviceScene& scene, const GBuffer& points, const AtlasMap& map,
                            const cl::Buffer& light, const cl::Buffer& irradiance,
                            const WaitList& wait) const {
    const std::size_t triangles = params.triangle_count;
    need_stride(show_, "stride", params.stride, params.point_count);
    if (triangles > scene.info().triangle_count)
        throw Error(show_.name + ": triangle_count is " + std::to_string(triangles) +
                    ", the scene has " + std::to_string(scene.info().triangle_count));
    if (params.texel_stride < params.texel_count)
        throw Error(show_.name + ": texel_stride is " + std::to_string(params.texel_stride) +
                    ", at least " + std::to_string(params.texel_count) + " needed");
    need(show_, "planes", points.planes, gbuffer_bytes(storage_, params.stride));
    need(show_, "ids", points.ids, GBUFFER_ID_PLANES * word * params.stride);
    need(show_, "corners", map.corners, 3 * triangles * 2 * word);
    need(show_, "charts", map.charts, triangles * 2 * word);
    need(show_, "map", map.map, std::size_t{params.pages} * params.size * params.size * word);
    need(show_, "chart_of", map.chart_of, params.texel_count * word);
    need(show_, "light", light, 3 * word * params.texel_stride);
    need(show_, "irradiance", irradiance, irradiance_bytes(storage_, params.stride));
    return launch(show_, queue, params.point_count, wait, params, scene.triangles(),
                  scene.positions(), points.planes, points.ids, map.corners, map.charts, map.map,
                  map.chart_of, light, irradiance);
}

}  // namespace clgi
