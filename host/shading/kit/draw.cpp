// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/error.hpp>
#include <string>

namespace clgi {
namespace {

// Of one view's list: a shadow map of 8192 pixels shows some 150,000 triangles of a large scene as
// large ones, and drawing them late takes three times as long.
constexpr std::size_t most_polygons = 262144;

// Polygons that the list of each view holds.
std::uint32_t list_capacity(std::size_t triangles, std::uint32_t views) {
    const std::uint32_t few = raster_capacity(triangles);
    if (views > 1) return few;
    return std::max(few, static_cast<std::uint32_t>(std::min(triangles, most_polygons)));
}

}  // namespace

void draw(Recorder& record, const GBufferPasses& gbuffer, const DeviceScene& scene,
          const ViewSpan& span, const cl::Buffer& views, const RasterBuffers& buffers) {
    const cl::CommandQueue& queue = record.queue();
    const std::size_t triangles = scene.info().triangle_count;
    if (gbuffer.prefers_raster_views(span, scene)) {
        record("gbuffer.raster_views", triangles * span.count, [&](const WaitList& wait) {
            return gbuffer.raster_views(queue, span, views, scene, buffers.pixels, buffers.kind,
                                        wait);
        });
        return;
    }
    draw_by_lists(record, gbuffer, scene, span, views, buffers);
}

void draw_by_lists(Recorder& record, const GBufferPasses& gbuffer, const DeviceScene& scene,
                   const ViewSpan& span, const cl::Buffer& views, const RasterBuffers& buffers) {
    const cl::CommandQueue& queue = record.queue();
    const std::size_t triangles = scene.info().triangle_count;
    ViewSpan part = span;
    for (std::uint32_t done = 0; done < span.count; done += part.count) {
        part.first = span.first + done;
        part.count = std::min(span.count - done, buffers.views);
        record(
            "gbuffer.clear", std::size_t{part.count} * part.width * part.height,
            [&](const WaitList& wait) { return gbuffer.clear(queue, part, views, buffers, wait); });
        for (const std::uint32_t stage : gbuffer.stages(buffers.kind)) {
            record("gbuffer.raster", triangles * part.count, [&](const WaitList& wait) {
                return gbuffer.raster(queue, part, views, scene, stage, buffers, wait);
            });
            if (buffers.capacity >= triangles) continue;
            record("gbuffer.raster_late", triangles * part.count, [&](const WaitList& wait) {
                return gbuffer.raster_late(queue, part, views, scene, stage, buffers, wait);
            });
        }
        record("gbuffer.raster_large", triangles * part.count, [&](const WaitList& wait) {
            return gbuffer.raster_large(queue, part, views, scene, buffers, wait);
        });
    }
}

cl::Event draw(const cl::CommandQueue& queue, const GBufferPasses& gbuffer,
               const DeviceScene& scene, const ViewSpan& span, const cl::Buffer& views,
               const RasterBuffers& buffers, const WaitList& wait) {
    Recorder record(queue, "draw");
    record.begin(wait);
    draw(record, gbuffer, scene, span, views, buffers);
    return record.last();
}

void add_raster_lists(BufferTable& table, RasterBuffers& buffers, const DeviceScene& scene,
                      std::uint32_t views) {
    const char* lower = "the scene's triangles";
    const std::size_t triangles = scene.info().triangle_count;
    buffers.views = views;
    buffers.capacity = list_capacity(triangles, views);
    const std::size_t places = std::size_t{views} * buffers.capacity;
    table.add(buffers.polygons, "polygons", lower, places * sizeof(RasterPolygon));
    table.add(buffers.runs, "runs of polygons", lower, places * sizeof(RasterRun));
    table.add(buffers.late, "late batches", lower,
              views * raster_batches(triangles) * sizeof(std::uint32_t));
    table.add(buffers.counts, "counts of polygons", lower, views * sizeof(RasterCount));
}

void build_draw(const GBufferPasses& gbuffer, const DeviceScene& scene, const ViewSpan& span,
                Pixels kind) {
    if (gbuffer.prefers_raster_views(span, scene)) return gbuffer.build({"raster_views"}, kind);
    const std::size_t triangles = scene.info().triangle_count;
    gbuffer.build({"clear", "raster", "raster_large"}, kind);
    if (list_capacity(triangles, 1) < triangles) gbuffer.build({"raster_late"}, kind);
}

void draw_gbuffer(Recorder& record, const GBufferPasses& gbuffer, const DeviceScene& scene,
                  const View& view, const cl::Buffer& views, const RasterBuffers& buffers,
                  const GBuffer& out, std::uint32_t more) {
    const cl::CommandQueue& queue = record.queue();
    record("gbuffer.put_view", 1,
           [&](const WaitList& wait) { return gbuffer.put_view(queue, view, 0, views, wait); });
    draw(record, gbuffer, scene, span_of({view}, 0, 1), views, buffers);
    ResolveParams params{out.stride, RESOLVE_GEOMETRIC | more, 0, 0};
    if (scene.info().flags & SCENE_HAS_EMISSION) params.write |= RESOLVE_EMISSION;
    record("gbuffer.resolve", std::size_t{view.width} * view.height, [&](const WaitList& wait) {
        return gbuffer.resolve(queue, view, scene, params, buffers.pixels, out.planes, out.ids,
                               wait);
    });
}

void build_draw_gbuffer(const GBufferPasses& gbuffer, const DeviceScene& scene) {
    build_draw(gbuffer, scene, {});
    gbuffer.build({"put_view", "resolve"});
}

void check_gbuffer(const char* owner, const GBuffer& given, std::uint32_t stride, Storage storage) {
    const std::string begin = owner + std::string(": the G-buffer's ");
    if (given.stride != stride)
        throw Error(begin + "stride is " + std::to_string(given.stride) + ", " +
                    std::to_string(stride) + " needed");
    if (given.storage != storage)
        throw Error(begin + "planes are " + (given.storage == Storage::half ? "half" : "full") +
                    " storage, the solver's own (BuildOptions::storage) needed");
    const auto holds = [&](const char* what, const cl::Buffer& buffer, std::size_t needed) {
        const std::size_t held = buffer() ? buffer.getInfo<CL_MEM_SIZE>() : 0;
        if (held < needed)
            throw Error(begin + what + " hold " + std::to_string(held) + " bytes, " +
                        std::to_string(needed) + " needed");
    };
    holds("planes", given.planes, gbuffer_bytes(storage, stride));
    holds("ids", given.ids, sizeof(std::int32_t) * GBUFFER_ID_PLANES * stride);
}

}  // namespace clgi
