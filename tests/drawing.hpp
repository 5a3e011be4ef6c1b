// A view drawn with every pass of the gbuffer room, and all that came out of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "device.hpp"

namespace clgi::test {

struct Drawing {
    View view{};
    std::uint32_t stride = 0;
    std::vector<std::uint64_t> visibility;  // [height][width]
    std::vector<ScreenVertex> vertices;     // [vertex_count] of the device
    std::vector<glm::uvec4> triangles;      // [triangle_count] of the device
    std::vector<std::uint32_t> order;       // [triangle_count] index in the scene
    std::vector<float> planes;              // [GBUFFER_PLANES][stride]
    std::vector<std::int32_t> ids;          // [GBUFFER_ID_PLANES][stride]

    // The scene's index, -1 where nothing is seen.
    int triangle(std::size_t pixel) const {
        const std::uint64_t word = visibility[pixel];
        return word == ~std::uint64_t{0} ? -1 : static_cast<int>(order[word & 0xffffffffu]);
    }
    glm::vec3 at(int plane, std::size_t pixel) const {
        return {planes[plane * stride + pixel], planes[(plane + 1) * stride + pixel],
                planes[(plane + 2) * stride + pixel]};
    }
    float depth(std::size_t pixel) const { return planes[GBUFFER_DEPTH * stride + pixel]; }
    std::size_t pixels() const { return visibility.size(); }
};

inline std::uint32_t padded(std::size_t count) {
    return static_cast<std::uint32_t>((count + 15) / 16 * 16);
}

// [GBUFFER_PLANES][stride] as floats, whichever way they are stored.
inline std::vector<float> read_planes(const GBuffer& from) {
    if (from.storage == Storage::full)
        return download<float>(from.planes, GBUFFER_PLANES * from.stride);
    const auto rows = download<std::uint16_t>(from.planes, GBUFFER_HALF_ROWS * from.stride);
    std::vector<float> out(GBUFFER_PLANES * from.stride);
    for (int plane = 0; plane < GBUFFER_PLANES; ++plane)
        for (std::size_t i = 0; i < from.stride; ++i) {
            const std::uint16_t* row = rows.data() + HALF_ROW(plane) * from.stride;
            float& value = out[plane * from.stride + i];
            if (HALF_PLANE(plane))
                value = glm::unpackHalf1x16(row[i]);
            else
                std::memcpy(&value, row + 2 * i, sizeof value);
        }
    return out;
}

inline RasterBuffers raster_buffers(const DeviceScene& scene, std::size_t pixels) {
    return {empty<std::uint64_t>(pixels),
            empty<ScreenVertex>(std::max(scene.info().vertex_count, 1u)),
            empty<RasterPolygon>(std::max(scene.info().triangle_count, 1u)),
            empty<RasterRun>(std::max<std::size_t>(raster_runs(scene.info().triangle_count), 1)),
            empty<cl_uint>(1)};
}

// Fills the view's part of buffers.visibility.
inline void draw_visibility(const GBufferPasses& passes, const DeviceScene& scene, const View& view,
                            const RasterBuffers& buffers) {
    const cl::CommandQueue& queue = device().queue;
    passes.clear(queue, view, buffers);
    passes.transform(queue, view, scene, buffers);
    if (passes.fused()) {
        passes.raster(queue, view, scene, RASTER_FUSED, buffers);
    } else {
        passes.raster(queue, view, scene, RASTER_DEPTH, buffers);
        passes.raster(queue, view, scene, RASTER_IDENTITY, buffers);
    }
    passes.raster_large(queue, view, scene, buffers);
}

inline const GBufferPasses& gbuffer_passes(Math math = Math::strict) {
    return shared_passes<GBufferPasses>(math);
}

inline Drawing draw(const DeviceScene& scene, const View& view,
                    const GBufferPasses& passes = gbuffer_passes()) {
    const cl::CommandQueue& queue = device().queue;
    const std::size_t pixels = std::size_t{view.width} * view.height;
    Drawing out;
    out.view = view;
    out.stride = padded(pixels);
    const RasterBuffers buffers = raster_buffers(scene, view.first_pixel + pixels);
    const cl::Buffer planes = empty<float>(GBUFFER_PLANES * out.stride);
    const cl::Buffer ids = empty<cl_int>(GBUFFER_ID_PLANES * out.stride);
    queue.enqueueFillBuffer(planes, 0.0f, 0, GBUFFER_PLANES * out.stride * sizeof(float));
    queue.enqueueFillBuffer(ids, cl_int{0}, 0, GBUFFER_ID_PLANES * out.stride * sizeof(cl_int));
    draw_visibility(passes, scene, view, buffers);
    const ResolveParams params{out.stride, RESOLVE_ALL, 0, 0};
    passes.resolve(queue, view, scene, params, buffers.visibility, planes, ids);
    out.visibility = download<std::uint64_t>(buffers.visibility, pixels, view.first_pixel);
    out.vertices = download<ScreenVertex>(buffers.vertices, scene.info().vertex_count);
    out.triangles = download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    out.order = scene.triangle_order();
    out.planes = download<float>(planes, GBUFFER_PLANES * out.stride);
    out.ids = download<std::int32_t>(ids, GBUFFER_ID_PLANES * out.stride);
    return out;
}

inline Drawing draw(const Scene& scene, const Camera& camera, int width, int height) {
    const DeviceScene placed = on_device(scene);
    return draw(placed, make_view(camera, placed.frame(), width, height));
}

}  // namespace clgi::test
