// SPDX-License-Identifier: MIT
#include <clgi/passes/gbuffer.hpp>

#include "opencl/launch.hpp"
#include "opencl/planes.hpp"
#include "opencl/program.hpp"

namespace clgi {
namespace {

// Triangles up to this many pixels wide and high are drawn where they are set up.
constexpr std::uint32_t small_triangle = 12;

std::size_t last_pixel(const View& view) {
    return view.first_pixel + static_cast<std::size_t>(view.width) * view.height;
}

void need_visibility(const PassKernel& pass, const View& view, const cl::Buffer& visibility) {
    need(pass, "visibility", visibility, last_pixel(view) * sizeof(std::uint64_t));
}

void need_textures(const PassKernel& pass, const DeviceScene& scene, bool built) {
    if (scene.needs_textures() && !built)
        throw Error(pass.name +
                    ": the scene has textures or alpha masks, the kernels were built "
                    "without (BuildOptions::textures)");
}

}  // namespace

GBufferPasses::GBufferPasses(const cl::Context& context, const cl::Device& device,
                             const BuildOptions& options) {
    auto kernels = build_room(
        context, device, "gbuffer",
        {"clear", "transform", "raster", "raster_large", "resolve", "downsample"}, options);
    clear_ = kernels[0];
    transform_ = kernels[1];
    raster_ = kernels[2];
    prefer_small_groups(raster_, device, options);
    raster_large_ = kernels[3];
    prefer_small_groups(raster_large_, device, options);
    resolve_ = kernels[4];
    downsample_ = kernels[5];
    fused_ = uses_atomics64(device, options);
    textures_ = options.textures;
}

cl::Event GBufferPasses::clear(const cl::CommandQueue& queue, const View& view,
                               const RasterBuffers& buffers, const WaitList& wait) const {
    need_visibility(clear_, view, buffers.visibility);
    need(clear_, "run_count", buffers.run_count, sizeof(std::uint32_t));
    const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
    return launch(clear_, queue, (pixels + 7) / 8, wait, view, buffers.visibility,
                  buffers.run_count);
}

cl::Event GBufferPasses::transform(const cl::CommandQueue& queue, const View& view,
                                   const DeviceScene& scene, const RasterBuffers& buffers,
                                   const WaitList& wait) const {
    const std::uint32_t vertices = scene.info().vertex_count;
    need(transform_, "vertices", buffers.vertices, vertices * sizeof(ScreenVertex));
    return launch(transform_, queue, vertices, wait, view, vertices, scene.positions(),
                  buffers.vertices);
}

cl::Event GBufferPasses::raster(const cl::CommandQueue& queue, const View& view,
                                const DeviceScene& scene, std::uint32_t stage,
                                const RasterBuffers& buffers, const WaitList& wait) const {
    if (fused_ != (stage == RASTER_FUSED) || stage > RASTER_IDENTITY)
        throw Error("gbuffer.raster: stage is " + std::to_string(stage) + ", " +
                    (fused_ ? "0 (fused)" : "1 (depth) or 2 (identity)") + " needed");
    const SceneInfo& info = scene.info();
    need_visibility(raster_, view, buffers.visibility);
    need(raster_, "vertices", buffers.vertices, info.vertex_count * sizeof(ScreenVertex));
    need(raster_, "polygons", buffers.polygons, info.triangle_count * sizeof(RasterPolygon));
    need(raster_, "runs", buffers.runs, raster_runs(info.triangle_count) * sizeof(RasterRun));
    need(raster_, "run_count", buffers.run_count, sizeof(std::uint32_t));
    const RasterParams params{info.triangle_count, stage, small_triangle, 0};
    const std::size_t batches =
        (packets(raster_, info.triangle_count) + RASTER_BATCH - 1) / RASTER_BATCH;
    return launch(raster_, queue, batches, wait, view, params, scene.triangles(), buffers.vertices,
                  scene.positions(), buffers.visibility, buffers.polygons, buffers.runs,
                  buffers.run_count);
}

cl::Event GBufferPasses::raster_large(const cl::CommandQueue& queue, const View& view,
                                      const DeviceScene& scene, const RasterBuffers& buffers,
                                      const WaitList& wait) const {
    need_textures(raster_large_, scene, textures_);
    need_visibility(raster_large_, view, buffers.visibility);
    need(raster_large_, "polygons", buffers.polygons,
         scene.info().triangle_count * sizeof(RasterPolygon));
    need(raster_large_, "runs", buffers.runs,
         raster_runs(scene.info().triangle_count) * sizeof(RasterRun));
    need(raster_large_, "run_count", buffers.run_count, sizeof(std::uint32_t));
    const std::size_t across = (view.width + RASTER_TILE - 1) / RASTER_TILE;
    const std::size_t down = (view.height + RASTER_TILE - 1) / RASTER_TILE;
    return launch(raster_large_, queue, across * down, wait, view, scene.info().flags,
                  buffers.polygons, buffers.runs, buffers.run_count, scene, buffers.visibility);
}

cl::Event GBufferPasses::resolve(const cl::CommandQueue& queue, const View& view,
                                 const DeviceScene& scene, const ResolveParams& params,
                                 const cl::Buffer& visibility, const cl::Buffer& planes,
                                 const cl::Buffer& ids, const WaitList& wait) const {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
    need_textures(resolve_, scene, textures_);
    need_stride(resolve_, "stride", params.stride, pixels);
    need_visibility(resolve_, view, visibility);
    need(resolve_, "planes", planes, gbuffer_bytes(resolve_.storage, params.stride));
    need(resolve_, "ids", ids, sizeof(std::int32_t) * GBUFFER_ID_PLANES * params.stride);
    return launch(resolve_, queue, packets(resolve_, pixels), wait, view, params, scene.info(),
                  scene, visibility, planes, ids);
}

cl::Event GBufferPasses::downsample(const cl::CommandQueue& queue, const DownsampleParams& params,
                                    const cl::Buffer& planes, const cl::Buffer& points,
                                    const WaitList& wait) const {
    need_step(downsample_, params.step);
    const std::size_t low_width = low_size(params.width, params.step);
    const std::size_t low_height = low_size(params.height, params.step);
    need_stride(downsample_, "stride", params.stride,
                static_cast<std::size_t>(params.width) * params.height);
    need_stride(downsample_, "low_stride", params.low_stride, low_width * low_height);
    need(downsample_, "planes", planes, point_bytes(downsample_.storage, params.stride));
    need(downsample_, "points", points, point_bytes(downsample_.storage, params.low_stride));
    return launch(downsample_, queue, packets(downsample_, low_width) * low_height, wait, params,
                  planes, points);
}

}  // namespace clgi
