// Drawing of any number of views, with all passes that it takes, in the form that suits the device
// and the number of views.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/passes/gbuffer.hpp>

namespace clgi {

// Draws the views of a span into buffers.pixels, by lists or by raster_views; lists take
// buffers.views of them at a time. Nothing is read back, so the views may be made on the device.
CLGI_API void draw(Recorder& record, const GBufferPasses& gbuffer, const DeviceScene& scene,
                   const ViewSpan& span, const cl::Buffer& views, const RasterBuffers& buffers);

// The same always in the form with lists of large triangles, which suits few or large views and
// devices with many cores.
CLGI_API void draw_by_lists(Recorder& record, const GBufferPasses& gbuffer,
                            const DeviceScene& scene, const ViewSpan& span, const cl::Buffer& views,
                            const RasterBuffers& buffers);

// draw() without a recorder: it begins after `wait`; the event completes when all views are drawn.
CLGI_API cl::Event draw(const cl::CommandQueue& queue, const GBufferPasses& gbuffer,
                        const DeviceScene& scene, const ViewSpan& span, const cl::Buffer& views,
                        const RasterBuffers& buffers, const WaitList& wait = {});

// Rows for the lists of large triangles; buffers.pixels is the caller's. views: drawn at a time.
CLGI_API void add_raster_lists(BufferTable& table, RasterBuffers& buffers, const DeviceScene& scene,
                               std::uint32_t views = 1);

// Builds the kernels that draw() takes for such a span and such pixels, with lists for one view at
// a time.
CLGI_API void build_draw(const GBufferPasses& gbuffer, const DeviceScene& scene,
                         const ViewSpan& span, Pixels kind = Pixels::visibility);

// The G-buffer of a view that the host knows: puts the view into `views`, draws it into
// buffers.pixels and resolves it. Emission is written if the scene has some. more: RESOLVE_DEPTH,
// RESOLVE_TRIANGLE, if they are needed too.
CLGI_API void draw_gbuffer(Recorder& record, const GBufferPasses& gbuffer, const DeviceScene& scene,
                           const View& view, const cl::Buffer& views, const RasterBuffers& buffers,
                           const GBuffer& out, std::uint32_t more = 0);

// Builds the kernels that draw_gbuffer() takes.
CLGI_API void build_draw_gbuffer(const GBufferPasses& gbuffer, const DeviceScene& scene);

// Throws Error unless a G-buffer has this stride and storage and is large enough. The message
// begins with `owner`.
CLGI_API void check_gbuffer(const char* owner, const GBuffer& given, std::uint32_t stride,
                            Storage storage);

}  // namespace clgi
