// The rasteriser and what follows it, one method a kernel. Buffers and layouts:
// clgi/shared/gbuffer.h.
//
// Every method checks sizes, enqueues one kernel on the caller's queue and returns its event. It
// allocates nothing and never waits. Throws Error for a buffer too small or a value out of range.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <clgi/pass.hpp>
#include <clgi/planes.hpp>

namespace clgi {

// What drawing a view works with besides the scene. visibility may hold several views.
struct RasterBuffers {
    cl::Buffer visibility;  // [pixels of all views] ulong
    cl::Buffer vertices;    // [vertex_count] ScreenVertex
    cl::Buffer polygons;    // [triangle_count] RasterPolygon
    cl::Buffer runs;        // [raster_runs(triangle_count)] RasterRun
    cl::Buffer run_count;   // [1] uint
};

// Runs of polygons that drawing may list, at most.
inline std::size_t raster_runs(std::size_t triangles) {
    return (triangles + RASTER_BATCH - 1) / RASTER_BATCH;
}

// One picture's planes, wherever they come from: `resolve`, or another renderer
// (passes/import.hpp).
struct GBuffer {
    cl::Buffer planes;                // [GBUFFER_PLANES][stride], see clgi/shared/planes.h
    cl::Buffer ids;                   // [GBUFFER_ID_PLANES][stride] int
    std::uint32_t stride = 0;         // values between planes
    Storage storage = Storage::full;  // how the planes are stored
};

// Low-resolution points along a side of `size` pixels, one for every `step`.
inline std::size_t low_size(std::uint32_t size, std::uint32_t step) {
    return (static_cast<std::size_t>(size) + step - 1) / step;
}

class CLGI_API GBufferPasses {
public:
    GBufferPasses(const cl::Context& context, const cl::Device& device,
                  const BuildOptions& options = {});

    // Empties the view's part of visibility, and the list of runs.
    cl::Event clear(const cl::CommandQueue& queue, const View& view, const RasterBuffers& buffers,
                    const WaitList& wait = {}) const;

    // Projects every vertex.
    cl::Event transform(const cl::CommandQueue& queue, const View& view, const DeviceScene& scene,
                        const RasterBuffers& buffers, const WaitList& wait = {}) const;

    // Draws small triangles and lists the others in runs. stage: RASTER_FUSED where fused() says
    // so, else once with RASTER_DEPTH and once with RASTER_IDENTITY.
    cl::Event raster(const cl::CommandQueue& queue, const View& view, const DeviceScene& scene,
                     std::uint32_t stage, const RasterBuffers& buffers,
                     const WaitList& wait = {}) const;

    // Draws the listed runs of polygons.
    cl::Event raster_large(const cl::CommandQueue& queue, const View& view,
                           const DeviceScene& scene, const RasterBuffers& buffers,
                           const WaitList& wait = {}) const;

    // visibility -> planes [GBUFFER_PLANES][stride] float, ids [GBUFFER_ID_PLANES][stride] int.
    cl::Event resolve(const cl::CommandQueue& queue, const View& view, const DeviceScene& scene,
                      const ResolveParams& params, const cl::Buffer& visibility,
                      const cl::Buffer& planes, const cl::Buffer& ids,
                      const WaitList& wait = {}) const;

    // planes [>= POINT_PLANES][stride] -> points [POINT_PLANES][low_stride] float.
    cl::Event downsample(const cl::CommandQueue& queue, const DownsampleParams& params,
                         const cl::Buffer& planes, const cl::Buffer& points,
                         const WaitList& wait = {}) const;

    bool fused() const { return fused_; }
    int packet_width() const { return resolve_.packet_width; }

private:
    PassKernel clear_, transform_, raster_, raster_large_, resolve_, downsample_;
    bool fused_;
    bool textures_;
};

}  // namespace clgi
