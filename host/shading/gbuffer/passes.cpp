// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/passes/gbuffer.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"

namespace clgi {
namespace {

// Triangles up to this many pixels wide and high are drawn where they are set up.
constexpr std::uint32_t small_triangle = 12;

std::size_t last_pixel(const View& view) {
    return view.first_pixel + static_cast<std::size_t>(view.width) * view.height;
}

void need_views(const PassKernel& pass, const ViewSpan& span, const cl::Buffer& views,
                const cl::Buffer& pixels, Pixels kind) {
    need(pass, "views", views, (std::size_t{span.first} + span.count) * sizeof(View));
    need(pass, "pixels", pixels, span.pixels * pixel_bytes(kind));
}

// The lists of the views, for the scene's triangles.
void need_lists(const PassKernel& pass, const ViewSpan& span, const RasterBuffers& buffers,
                std::size_t triangles) {
    if (span.count > buffers.views)
        throw Error(pass.name + ": " + std::to_string(span.count) + " views were given, at most " +
                    std::to_string(buffers.views) + " (RasterBuffers::views) needed");
    if (buffers.capacity == 0)
        throw Error(pass.name + ": the capacity of the lists is 0, at least 1 needed");
    const std::size_t polygons = std::size_t{span.count} * buffers.capacity;
    need(pass, "polygons", buffers.polygons, polygons * sizeof(RasterPolygon));
    need(pass, "runs", buffers.runs, polygons * sizeof(RasterRun));
    need(pass, "late", buffers.late,
         span.count * raster_batches(triangles) * sizeof(std::uint32_t));
    need(pass, "counts", buffers.counts, span.count * sizeof(RasterCount));
}

void need_stage(const PassKernel& pass, std::uint32_t stage,
                const std::vector<std::uint32_t>& stages) {
    if (std::find(stages.begin(), stages.end(), stage) == stages.end())
        throw Error(pass.name + ": stage is " + std::to_string(stage) + ", " +
                    (stages.size() == 1 ? "0 (fused)" : "1 (depth) or 2 (identity)") + " needed");
}

RasterParams raster_params(const ViewSpan& span, const DeviceScene& scene, std::uint32_t stage,
                           const RasterBuffers& buffers) {
    RasterParams out{};
    out.triangle_count = scene.info().triangle_count;
    out.stage = stage;
    out.small_size = small_triangle;
    out.first_view = span.first;
    out.capacity = buffers.capacity;
    out.late_capacity = static_cast<std::uint32_t>(raster_batches(out.triangle_count));
    out.cull = 1;
    out.scene_flags = scene.info().flags;
    return out;
}

std::size_t batches(const PassKernel& pass, const DeviceScene& scene) {
    return raster_batches(packets(pass, scene.info().triangle_count));
}

void need_textures(const PassKernel& pass, const DeviceScene& scene, bool built) {
    if (scene.needs_textures() && !built)
        throw Error(
            pass.name +
            ": the scene has textures, alpha masks or blended surfaces, the kernels were built "
            "without (BuildOptions::textures)");
}

}  // namespace

ViewSpan span_of(const std::vector<View>& views, std::size_t first, std::size_t count) {
    ViewSpan out;
    out.first = static_cast<std::uint32_t>(first);
    out.count = static_cast<std::uint32_t>(count);
    for (std::size_t v = first; v < first + count; ++v) {
        out.width = std::max(out.width, views[v].width);
        out.height = std::max(out.height, views[v].height);
        out.pixels = std::max(out.pixels, last_pixel(views[v]));
    }
    return out;
}

GBufferPasses::GBufferPasses(const Programs& programs, const BuildOptions& options)
    : fused_(uses_atomics64(programs.device(), options)),
      textures_(options.textures),
      groups_(in_groups(programs.device(), options)),
      cores_(programs.device().getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>()) {
    const auto kernel = [&](const char* pass, const char* defines = "") {
        const std::vector<std::string> maps = {"clear", "raster", "raster_large", "raster_views"},
                                       pictures = {"clear",        "put_view",     "raster",
                                                   "raster_large", "raster_views", "cubes",
                                                   "resolve"};
        const std::vector<std::string>& together = *defines == '\0' ? pictures : maps;
        const bool in_it = std::find(together.begin(), together.end(), pass) != together.end();
        return programs.kernel("gbuffer", pass, options, defines,
                               in_it ? together : std::vector<std::string>{});
    };
    for (Drawing* kind : {&visibility_, &depth_}) {
        const char* defines = kind == &depth_ ? "-DCLGI_DEPTH_ONLY" : "";
        const auto few = [&](const char* pass) {
            return in_small_groups(kernel(pass, defines), programs.device(), options);
        };
        kind->clear = kernel("clear", defines);
        kind->raster = few("raster");
        kind->raster_late = few("raster_late");
        const auto grouped = [&](const char* pass, std::size_t lanes, std::size_t most) {
            return group_form(programs, "gbuffer", pass, options, defines, lanes, most);
        };
        kind->raster_large = groups_ ? grouped("raster_large", 32, 64) : few("raster_large");
        kind->raster_views =
            groups_ ? grouped("raster_views", 128, 256) : kernel("raster_views", defines);
        kind->trace_views = kernel("trace_views", defines);
        if (options.local_size != 0) continue;
        kind->trace_views.local_size = 1;
        if (!groups_) kind->raster_views.local_size = 1;
    }
    put_view_ = kernel("put_view");
    cubes_ = kernel("cubes");
    surface_ = kernel("surface");
    resolve_ = kernel("resolve");
    downsample_ = kernel("downsample");
}

void GBufferPasses::build(std::initializer_list<const char*> passes, Pixels kind) const {
    const Drawing& d = drawing(kind);
    build_named({d.clear, d.raster, d.raster_late, d.raster_large, d.raster_views, d.trace_views,
                 put_view_, cubes_, surface_, resolve_, downsample_},
                passes);
}

std::vector<std::uint32_t> GBufferPasses::stages(Pixels kind) const {
    if (fused_ || kind == Pixels::depth) return {RASTER_FUSED};
    return {RASTER_DEPTH, RASTER_IDENTITY};
}

bool GBufferPasses::prefers_raster_views(const ViewSpan& span, const DeviceScene&) const {
    // Views for all cores; a view and its depth should stay in the cache of one.
    const std::size_t enough = groups_ ? std::max<std::size_t>(16, cores_ / 2) : 2 * cores_;
    return span.count >= enough && span.width <= 512 && span.height <= 512;
}

bool GBufferPasses::prefers_trace_views(const ViewSpan& span, const DeviceScene& scene) const {
    // Both took as long at 190 to 270 triangles a pixel of a hemicube, which has three faces'
    // worth.
    constexpr std::size_t triangles_a_pixel = 600;
    return !groups_ && scene.info().triangle_count >=
                           triangles_a_pixel * std::size_t{span.width} * std::size_t{span.height};
}

cl::Event GBufferPasses::put_view(const cl::CommandQueue& queue, const View& view,
                                  std::uint32_t place, const cl::Buffer& views,
                                  const WaitList& wait) const {
    need(put_view_, "views", views, (std::size_t{place} + 1) * sizeof(View));
    return launch(put_view_, queue, Range(0, 1), wait, view, place, views);
}

cl::Event GBufferPasses::cubes(const cl::CommandQueue& queue, const CubeParams& params,
                               const cl::Buffer& points, const cl::Buffer& chosen,
                               const cl::Buffer& views, const WaitList& wait) const {
    if (params.faces != 5 && params.faces != 6)
        throw Error("gbuffer.cubes: faces is " + std::to_string(params.faces) +
                    ", 5 (hemicube) or 6 (cube) needed");
    if (params.size < 2 || params.size > 4096 || params.size % 2 != 0)
        throw Error("gbuffer.cubes: size is " + std::to_string(params.size) +
                    ", an even number from 2 to 4096 needed");
    if (!(params.near > 0.0f))
        throw Error("gbuffer.cubes: near is " + std::to_string(params.near) +
                    ", more than 0 needed");
    need(cubes_, "points", points, sizeof(float) * POINT_PLANES * params.stride);
    need(cubes_, "chosen", chosen,
         (std::size_t{params.first_chosen} + params.point_count) * sizeof(std::uint32_t));
    need(cubes_, "views", views,
         (params.first_view + std::size_t{params.point_count} * params.faces) * sizeof(View));
    return launch(cubes_, queue, params.point_count, wait, params, points, chosen, views);
}

cl::Event GBufferPasses::clear(const cl::CommandQueue& queue, const ViewSpan& span,
                               const cl::Buffer& views, const RasterBuffers& buffers,
                               const WaitList& wait) const {
    const PassKernel& pass = drawing(buffers.kind).clear;
    need_views(pass, span, views, buffers.pixels, buffers.kind);
    need(pass, "counts", buffers.counts, span.count * sizeof(RasterCount));
    RasterParams params{};
    params.first_view = span.first;
    const std::size_t most = std::size_t{span.width} * span.height;
    return launch_rows(pass, queue, (most + 15) / 16, span.count, wait, params, views,
                       buffers.pixels, buffers.counts);
}

cl::Event GBufferPasses::raster(const cl::CommandQueue& queue, const ViewSpan& span,
                                const cl::Buffer& views, const DeviceScene& scene,
                                std::uint32_t stage, const RasterBuffers& buffers,
                                const WaitList& wait) const {
    const PassKernel& pass = drawing(buffers.kind).raster;
    need_stage(pass, stage, stages(buffers.kind));
    need_views(pass, span, views, buffers.pixels, buffers.kind);
    need_lists(pass, span, buffers, scene.info().triangle_count);
    return launch_rows(pass, queue, batches(pass, scene), span.count, wait,
                       raster_params(span, scene, stage, buffers), views, scene.triangles(),
                       scene.positions(), scene.clusters(), scene.parts(), buffers.pixels,
                       buffers.polygons, buffers.runs, buffers.late, buffers.counts);
}

cl::Event GBufferPasses::raster_late(const cl::CommandQueue& queue, const ViewSpan& span,
                                     const cl::Buffer& views, const DeviceScene& scene,
                                     std::uint32_t stage, const RasterBuffers& buffers,
                                     const WaitList& wait) const {
    const PassKernel& pass = drawing(buffers.kind).raster_late;
    need_textures(pass, scene, textures_);
    need_stage(pass, stage, stages(buffers.kind));
    need_views(pass, span, views, buffers.pixels, buffers.kind);
    need_lists(pass, span, buffers, scene.info().triangle_count);
    return launch_rows(pass, queue, batches(pass, scene), span.count, wait,
                       raster_params(span, scene, stage, buffers), views, buffers.late,
                       buffers.counts, scene.parts(), scene, buffers.pixels);
}

cl::Event GBufferPasses::raster_large(const cl::CommandQueue& queue, const ViewSpan& span,
                                      const cl::Buffer& views, const DeviceScene& scene,
                                      const RasterBuffers& buffers, const WaitList& wait) const {
    const PassKernel& pass = drawing(buffers.kind).raster_large;
    need_textures(pass, scene, textures_);
    need_views(pass, span, views, buffers.pixels, buffers.kind);
    need_lists(pass, span, buffers, scene.info().triangle_count);
    const std::size_t across = (span.width + RASTER_TILE - 1) / RASTER_TILE;
    const std::size_t down = (span.height + RASTER_TILE - 1) / RASTER_TILE;
    return launch_rows(pass, queue, across * down * items_each(pass, groups_), span.count, wait,
                       raster_params(span, scene, RASTER_FUSED, buffers), views, buffers.polygons,
                       buffers.runs, buffers.counts, scene, buffers.pixels);
}

cl::Event GBufferPasses::raster_views(const cl::CommandQueue& queue, const ViewSpan& span,
                                      const cl::Buffer& views, const DeviceScene& scene,
                                      const cl::Buffer& pixels, Pixels kind,
                                      const WaitList& wait) const {
    const PassKernel& pass = drawing(kind).raster_views;
    return draw_whole(pass, span.count * items_each(pass, groups_), queue, span, views, scene,
                      pixels, kind, wait);
}

cl::Event GBufferPasses::trace_views(const cl::CommandQueue& queue, const ViewSpan& span,
                                     const cl::Buffer& views, const DeviceScene& scene,
                                     const cl::Buffer& pixels, Pixels kind,
                                     const WaitList& wait) const {
    return draw_whole(drawing(kind).trace_views, span.count, queue, span, views, scene, pixels,
                      kind, wait);
}

cl::Event GBufferPasses::draw_whole(const PassKernel& pass, std::size_t items,
                                    const cl::CommandQueue& queue, const ViewSpan& span,
                                    const cl::Buffer& views, const DeviceScene& scene,
                                    const cl::Buffer& pixels, Pixels kind,
                                    const WaitList& wait) const {
    need_textures(pass, scene, textures_);
    need_views(pass, span, views, pixels, kind);
    return launch(pass, queue, items, wait, raster_params(span, scene, RASTER_FUSED, {}),
                  span.count, views, scene.clusters(), scene.nodes(), scene.parts(), scene, pixels);
}

cl::Event GBufferPasses::resolve(const cl::CommandQueue& queue, const View& view,
                                 const DeviceScene& scene, const ResolveParams& params,
                                 const cl::Buffer& visibility, const cl::Buffer& planes,
                                 const cl::Buffer& ids, const WaitList& wait) const {
    const std::size_t pixels = static_cast<std::size_t>(view.width) * view.height;
    need_textures(resolve_, scene, textures_);
    need_stride(resolve_, "stride", params.stride, pixels);
    need(resolve_, "visibility", visibility, last_pixel(view) * sizeof(std::uint64_t));
    need(resolve_, "planes", planes, gbuffer_bytes(resolve_.storage, params.stride));
    need(resolve_, "ids", ids, sizeof(std::int32_t) * GBUFFER_ID_PLANES * params.stride);
    return launch(resolve_, queue, packets(resolve_, pixels), wait, view, params, scene.info(),
                  scene, visibility, planes, ids);
}

cl::Event GBufferPasses::surface(const cl::CommandQueue& queue, const DeviceScene& scene,
                                 const SurfaceParams& params, const cl::Buffer& samples,
                                 const GBuffer& out, const cl::Buffer& coords,
                                 const WaitList& wait) const {
    need_textures(surface_, scene, textures_);
    need_stride(surface_, "stride", params.stride, params.sample_count);
    need(surface_, "samples", samples, params.sample_count * sizeof(SurfaceSample));
    need(surface_, "planes", out.planes, gbuffer_bytes(surface_.storage, params.stride));
    need(surface_, "ids", out.ids, sizeof(std::int32_t) * GBUFFER_ID_PLANES * params.stride);
    if (params.write_uvs) need(surface_, "coords", coords, 4 * sizeof(float) * params.stride);
    return launch(surface_, queue, packets(surface_, params.sample_count), wait, params,
                  scene.info(), scene, samples, out.planes, out.ids,
                  params.write_uvs ? coords : out.planes);
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
