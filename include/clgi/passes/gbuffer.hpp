// The rasteriser and the passes that follow it, one method per kernel. Buffers and layouts:
// clgi/shared/gbuffer.h.
//
// Every method checks sizes, enqueues one kernel on the caller's queue and returns its event. It
// allocates nothing and never waits for the device. Its first call builds the kernel, unless
// build() did so before. Several threads may use one object, or copies of it, at a time.
// Throws Error for a buffer that is too small or a value out of range.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <algorithm>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/pass.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/programs.hpp>
#include <initializer_list>
#include <vector>

namespace clgi {

// Views in a buffer of views that are drawn together. If they were made on the device, the host
// knows only their number and their largest size.
struct ViewSpan {
    std::uint32_t first = 0;  // in the buffer of views
    std::uint32_t count = 1;
    std::uint32_t width = 0;  // pixels, of the largest
    std::uint32_t height = 0;
    std::size_t pixels = 0;  // that the target must hold: the last view's last pixel, plus 1
};

// The span of views that are known to the host.
CLGI_API ViewSpan span_of(const std::vector<View>& views, std::size_t first, std::size_t count);

// What is drawn of a view: the nearest triangle of every pixel and its closeness, or the closeness
// alone (clgi/shared/gbuffer.h).
enum class Pixels { visibility, depth };

inline std::size_t pixel_bytes(Pixels kind) {
    return kind == Pixels::depth ? sizeof(std::uint32_t) : sizeof(std::uint64_t);
}

// What views are drawn into, and the lists of large triangles of the views drawn at a time.
struct RasterBuffers {
    cl::Buffer pixels;           // [pixels of all views] ulong (visibility) or uint (depth)
    cl::Buffer polygons;         // [views][capacity] RasterPolygon
    cl::Buffer runs;             // [views][capacity] RasterRun
    cl::Buffer late;             // [views][raster_batches(triangle_count)] uint
    cl::Buffer counts;           // [views] RasterCount
    std::uint32_t views = 1;     // drawn at a time
    std::uint32_t capacity = 0;  // polygons that a view's list holds; raster_late draws the rest
    Pixels kind = Pixels::visibility;
};

// The largest number of batches that drawing may leave for raster_late.
inline std::size_t raster_batches(std::size_t triangles) {
    return (triangles + RASTER_BATCH - 1) / RASTER_BATCH;
}

// A capacity that few views exceed: all triangles of a small scene, else 16,384 polygons (2 MB).
inline std::uint32_t raster_capacity(std::size_t triangles) {
    return static_cast<std::uint32_t>(
        std::min<std::size_t>(std::max<std::size_t>(triangles, 1), 16384));
}

// The planes of one picture. `resolve` or `surface` writes them, or they are imported from another
// renderer (passes/import.hpp).
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
    explicit GBufferPasses(const Programs& programs, const BuildOptions& options = {});
    GBufferPasses(const cl::Context& context, const cl::Device& device,
                  const BuildOptions& options = {})
        : GBufferPasses(Programs(context, device), options) {}

    // A view given by the host -> views[place].
    cl::Event put_view(const cl::CommandQueue& queue, const View& view, std::uint32_t place,
                       const cl::Buffer& views, const WaitList& wait = {}) const;

    // Hemicubes or cubes around chosen[first_chosen] .. of the points [POINT_PLANES][stride] float
    // -> views, from first_view on, in which textures are looked up over CUBE_FOOTPRINT of a pixel.
    cl::Event cubes(const cl::CommandQueue& queue, const CubeParams& params,
                    const cl::Buffer& points, const cl::Buffer& chosen, const cl::Buffer& views,
                    const WaitList& wait = {}) const;

    // The next four draw the views of a span, at most buffers.views of them, in this order. `draw`
    // in clgi/advanced/kit/draw.hpp calls them for any number of views.

    // Empties the pixels of the views, and their lists.
    cl::Event clear(const cl::CommandQueue& queue, const ViewSpan& span, const cl::Buffer& views,
                    const RasterBuffers& buffers, const WaitList& wait = {}) const;

    // Draws small triangles and lists the others. stage: one of stages().
    cl::Event raster(const cl::CommandQueue& queue, const ViewSpan& span, const cl::Buffer& views,
                     const DeviceScene& scene, std::uint32_t stage, const RasterBuffers& buffers,
                     const WaitList& wait = {}) const;

    // Draws the triangles for which raster found no room in the lists. Call it after each raster,
    // with the same stage; not needed if capacity is at least the number of triangles.
    cl::Event raster_late(const cl::CommandQueue& queue, const ViewSpan& span,
                          const cl::Buffer& views, const DeviceScene& scene, std::uint32_t stage,
                          const RasterBuffers& buffers, const WaitList& wait = {}) const;

    // Draws the listed polygons.
    cl::Event raster_large(const cl::CommandQueue& queue, const ViewSpan& span,
                           const cl::Buffer& views, const DeviceScene& scene,
                           const RasterBuffers& buffers, const WaitList& wait = {}) const;

    // Replaces these four: clears and draws any number of views, each by one work-item (or group of
    // them, clgi::Form), without lists.
    // Writes the same bits.
    cl::Event raster_views(const cl::CommandQueue& queue, const ViewSpan& span,
                           const cl::Buffer& views, const DeviceScene& scene,
                           const cl::Buffer& pixels, Pixels kind, const WaitList& wait = {}) const;

    // As raster_views, by a ray through every pixel's centre: what shows is the same but for edges
    // within a 256th of a pixel of it, and for the last bits of depth. Each view by one work-item.
    cl::Event trace_views(const cl::CommandQueue& queue, const ViewSpan& span,
                          const cl::Buffer& views, const DeviceScene& scene,
                          const cl::Buffer& pixels, Pixels kind, const WaitList& wait = {}) const;

    // The stages in which views of this kind are drawn, one after the other: one for depth alone or
    // with 64-bit atomics, else two.
    std::vector<std::uint32_t> stages(Pixels kind) const;

    // Whether `draw` takes raster_views: for many small views.
    bool prefers_raster_views(const ViewSpan& span, const DeviceScene& scene) const;

    // Whether trace_views takes less time than raster_views: for views of few pixels of finely
    // modelled scenes. Never in groups, which a view has too few pixels for.
    bool prefers_trace_views(const ViewSpan& span, const DeviceScene& scene) const;

    // visibility -> planes [GBUFFER_PLANES][stride] float, ids [GBUFFER_ID_PLANES][stride] int.
    cl::Event resolve(const cl::CommandQueue& queue, const View& view, const DeviceScene& scene,
                      const ResolveParams& params, const cl::Buffer& visibility,
                      const cl::Buffer& planes, const cl::Buffer& ids,
                      const WaitList& wait = {}) const;

    // samples [sample_count] SurfaceSample -> all planes and ids of out: front side, depth 0. With
    // write_uvs also coords [4][stride] float: u and v of both texture coordinate sets. A triangle
    // that does not exist gives planes of 0 and ids of -1.
    cl::Event surface(const cl::CommandQueue& queue, const DeviceScene& scene,
                      const SurfaceParams& params, const cl::Buffer& samples, const GBuffer& out,
                      const cl::Buffer& coords = {}, const WaitList& wait = {}) const;

    // planes [>= POINT_PLANES][stride] -> points [POINT_PLANES][low_stride] float.
    cl::Event downsample(const cl::CommandQueue& queue, const DownsampleParams& params,
                         const cl::Buffer& planes, const cl::Buffer& points,
                         const WaitList& wait = {}) const;

    // Builds these kernels now, several at a time, by the names of the methods. Those that draw are
    // built for visibility. Kernels that are not built here are built when first enqueued.
    // kind: which variant of those that draw.
    void build(std::initializer_list<const char*> passes, Pixels kind = Pixels::visibility) const;

    int packet_width() const { return resolve_.packet_width; }

private:
    struct Drawing {
        PassKernel clear, raster, raster_late, raster_large, raster_views, trace_views;
    };
    const Drawing& drawing(Pixels kind) const {
        return kind == Pixels::depth ? depth_ : visibility_;
    }
    cl::Event draw_whole(const PassKernel& pass, std::size_t items, const cl::CommandQueue& queue,
                         const ViewSpan& span, const cl::Buffer& views, const DeviceScene& scene,
                         const cl::Buffer& pixels, Pixels kind, const WaitList& wait) const;
    Drawing visibility_, depth_;
    PassKernel put_view_, cubes_, surface_, resolve_, downsample_;
    bool fused_;
    bool textures_;
    bool groups_;        // a view or a tile by a group of work-items, not by one
    std::size_t cores_;  // compute units
};

}  // namespace clgi
