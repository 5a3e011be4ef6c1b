// A view drawn with every pass of the gbuffer room, and all that came out of it.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "device.hpp"
#include "kernel_text.hpp"

namespace clgi::test {

// A vertex as the rasteriser projects it.
struct ScreenVertex {
    std::int32_t x, y;  // 24.8 fixed point
    float closeness;
    std::uint32_t outside;  // VERTEX_...
};

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

// What is left of a value that is stored.
inline float stored(float value, Storage storage = usual_build().storage) {
    return storage == Storage::half ? glm::unpackHalf1x16(glm::packHalf1x16(value)) : value;
}
inline glm::vec3 stored(const glm::vec3& v, Storage storage = usual_build().storage) {
    return {stored(v.x, storage), stored(v.y, storage), stored(v.z, storage)};
}

// Of rounding between 2^-14 and 65504 to what is stored, as a share.
inline double half_error() { return usual_build().storage == Storage::half ? 0x1p-11 : 0.0; }

// The first planes of a G-buffer, `stride` floats each, as they are stored.
inline cl::Buffer upload_planes(const std::vector<float>& planes, std::uint32_t stride,
                                Storage storage = usual_build().storage) {
    if (storage == Storage::full) return upload(planes);
    const int count = static_cast<int>(planes.size() / stride);
    std::vector<std::uint16_t> rows(std::size_t{GBUFFER_HALF_ROWS} * stride);
    for (int plane = 0; plane < count; ++plane)
        for (std::size_t i = 0; i < stride; ++i) {
            const float value = planes[plane * stride + i];
            std::uint16_t* row = rows.data() + HALF_ROW(plane) * stride;
            if (HALF_PLANE(plane))
                row[i] = glm::packHalf1x16(value);
            else
                std::memcpy(row + 2 * i, &value, sizeof value);
        }
    return upload(rows);
}

// Planes of irradiance as they are stored, and as floats again.
inline cl::Buffer upload_irradiance(const std::vector<float>& planes,
                                    Storage storage = usual_build().storage) {
    if (storage == Storage::full) return upload(planes);
    std::vector<std::uint16_t> halves;
    for (const float value : planes) halves.push_back(glm::packHalf1x16(value));
    return upload(halves);
}
inline std::vector<float> read_irradiance(const cl::Buffer& from, std::size_t stride,
                                          Storage storage = usual_build().storage) {
    if (storage == Storage::full) return download<float>(from, IRRADIANCE_PLANES * stride);
    std::vector<float> out;
    for (const std::uint16_t half : download<std::uint16_t>(from, IRRADIANCE_PLANES * stride))
        out.push_back(glm::unpackHalf1x16(half));
    return out;
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

inline RasterBuffers raster_buffers(const DeviceScene& scene, std::size_t pixels,
                                    Pixels kind = Pixels::visibility, std::uint32_t views = 1,
                                    std::uint32_t capacity = 0) {
    const std::size_t triangles = std::max(scene.info().triangle_count, 1u);
    RasterBuffers out;
    out.views = views;
    out.capacity = capacity > 0 ? capacity : raster_capacity(triangles);
    out.kind = kind;
    out.pixels = empty<std::uint8_t>(std::max<std::size_t>(pixels, 1) * pixel_bytes(kind));
    out.polygons = empty<RasterPolygon>(std::size_t{views} * out.capacity);
    out.runs = empty<RasterRun>(std::size_t{views} * out.capacity);
    out.late = empty<cl_uint>(views * raster_batches(triangles));
    out.counts = empty<RasterCount>(views);
    return out;
}

// Fills the view's part of buffers.pixels, by lists of large triangles or (whole) one view a
// work-item.
inline void draw_visibility(const GBufferPasses& passes, const DeviceScene& scene, const View& view,
                            const RasterBuffers& buffers, bool whole = false) {
    const cl::CommandQueue& queue = device().queue;
    const cl::Buffer views = upload(std::vector<View>{view});
    const ViewSpan span = span_of({view}, 0, 1);
    if (whole) {
        passes.raster_views(queue, span, views, scene, buffers.pixels, buffers.kind);
        queue.finish();
        return;
    }
    draw(queue, passes, scene, span, views, buffers);
    queue.finish();
}

inline std::vector<ScreenVertex> project(const DeviceScene& scene, const View& view) {
    static cl::Kernel kernel = [] {
        cl::Program program(device().context, kernel_text("tests/support/project.cl"));
        program.build(device().device,
                      compiler_options(device().device, {.packet_width = 1}).c_str());
        return cl::Kernel(program, "project");
    }();
    const cl::Buffer found = empty<ScreenVertex>(scene.info().vertex_count);
    kernel.setArg(0, view);
    kernel.setArg(1, scene.positions());
    kernel.setArg(2, found);
    device().queue.enqueueNDRangeKernel(kernel, cl::NullRange,
                                        cl::NDRange(scene.info().vertex_count));
    return download<ScreenVertex>(found, scene.info().vertex_count);
}

inline const GBufferPasses& gbuffer_passes(const Build& build = usual_build()) {
    return shared_passes<GBufferPasses>(build);
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
    passes.resolve(queue, view, scene, params, buffers.pixels, planes, ids);
    out.visibility = download<std::uint64_t>(buffers.pixels, pixels, view.first_pixel);
    if (scene.info().vertex_count > 0) out.vertices = project(scene, view);
    out.triangles = download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    out.order = scene.triangle_order();
    out.planes = read_planes({planes, ids, out.stride, usual_build().storage});
    out.ids = download<std::int32_t>(ids, GBUFFER_ID_PLANES * out.stride);
    return out;
}

inline Drawing draw(const Scene& scene, const Camera& camera, int width, int height) {
    const DeviceScene placed = on_device(scene);
    return draw(placed, make_view(camera, placed.frame(), width, height));
}

}  // namespace clgi::test
