// What the second-order solver needs in memory and time, and its buffers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <string>

#include "solvers/second_order_sizes.hpp"

namespace clgi {

namespace second_order {

std::uint32_t padded(std::size_t count) {
    constexpr std::size_t line = 16, page = 1024, skew = 5 * line;  // floats
    const std::size_t whole = (count + line - 1) / line * line;
    if (whole < page) return static_cast<std::uint32_t>(whole);
    // The same pixel of all planes would fall into the same set of a CPU's cache.
    return static_cast<std::uint32_t>((whole + page - 1 - skew) / page * page + skew);
}

std::size_t pixel_count(const SecondOrderOptions& options) {
    return static_cast<std::size_t>(options.width) * options.height;
}

std::size_t low_pixel_count(const SecondOrderOptions& options) {
    const auto size = [&](int side) {
        return low_size(static_cast<std::uint32_t>(side),
                        static_cast<std::uint32_t>(options.low_resolution_step));
    };
    return size(options.width) * size(options.height);
}

void check(const SecondOrderOptions& options) {
    const auto in = [](const char* name, double value, double low, double high) {
        if (!(value >= low && value <= high))
            throw Error(std::string("second-order: ") + name + " is " + std::to_string(value) +
                        ", " + std::to_string(low) + " to " + std::to_string(high) + " needed");
    };
    in("width", options.width, 1, 16384);
    in("height", options.height, 1, 16384);
    in("negative_lights", options.negative_lights, 0, 1 << 20);
    in("footprint", options.footprint, 0, 1e6);
    const int step = options.low_resolution_step;
    if (step != 1 && step != 2 && step != 4)
        throw Error("second-order: low_resolution_step is " + std::to_string(step) +
                    ", 1, 2 or 4 needed");
    if (!(options.discontinuity_threshold >= 0.0f))
        throw Error("second-order: discontinuity_threshold is negative or not a number");
}

bool refines(const SecondOrderOptions& options) {
    return options.low_resolution_step > 1 && options.discontinuity_threshold > 0.0f;
}

}  // namespace second_order

using namespace second_order;

namespace {

// Sizes in bytes of every buffer that a frame works with; 0: not needed.
struct Sizes {
    std::size_t vertices, polygons, runs, source_visibility, camera_visibility, planes, ids, mask,
        accepted, lights, negative, low_points, low_irradiance, flags, counts, listed,
        listed_points, listed_irradiance, irradiance, radiance;

    std::size_t sum() const {
        return vertices + polygons + runs + source_visibility + camera_visibility + planes + ids + mask +
               accepted + lights + negative + low_points + low_irradiance + flags + counts +
               listed + listed_points + listed_irradiance + irradiance + radiance;
    }
};

Sizes sizes(const DeviceScene& scene, const SecondOrderOptions& options, const EmitterSet& set) {
    const std::size_t stride = padded(pixel_count(options));
    const std::size_t low_stride = padded(low_pixel_count(options));
    const bool lit = options.indirect && set.light_count > 0;
    const bool refine = lit && refines(options);
    const Storage storage = options.build.storage;
    const std::size_t negative = lit ? options.negative_lights : 0;
    std::uint32_t candidates = 0;
    for (const std::uint32_t count : set.candidates) candidates = std::max(candidates, count);
    Sizes out{};
    out.vertices = scene.info().vertex_count * sizeof(ScreenVertex);
    out.polygons = scene.info().triangle_count * sizeof(RasterPolygon);
    out.runs = raster_runs(scene.info().triangle_count) * sizeof(RasterRun);
    out.source_visibility = set.pixels * sizeof(std::uint64_t);
    out.camera_visibility = pixel_count(options) * sizeof(std::uint64_t);
    out.planes = gbuffer_bytes(storage, stride);
    out.ids = GBUFFER_ID_PLANES * stride * sizeof(std::int32_t);
    out.radiance = RADIANCE_PLANES * stride * sizeof(float);
    if (!lit) return out;
    out.mask = candidates / 8;
    out.accepted = set.light_count * sizeof(std::uint32_t);
    out.lights = set.light_count * sizeof(IndirectLight);
    out.negative = negative * sizeof(IndirectLight);
    out.irradiance = irradiance_bytes(storage, stride);
    if (!refine) return out;
    out.low_points = point_bytes(storage, low_stride);
    out.low_irradiance = irradiance_bytes(storage, low_stride);
    out.flags = pixel_count(options);
    out.counts = (pixel_count(options) / COMPACT_BLOCK + 1) * sizeof(std::uint32_t);
    out.listed = stride * sizeof(std::uint32_t);
    out.listed_points = point_bytes(storage, stride);
    out.listed_irradiance = irradiance_bytes(storage, stride);
    return out;
}

}  // namespace

Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                  const SecondOrderOptions& options) {
    check(options);
    const EmitterSet set = make_emitters(scene, options.sources);
    Estimate out;
    out.bytes = sizes(scene, options, set).sum();

    // Cycles of one compute unit, as measured on a CPU with packets of 8: a packet of points and a
    // light 16, a triangle drawn 90, a packet of pixels resolved, interpolated and combined 900.
    const double lanes = packet_width(device) > 1 ? packet_width(device) : 32.0;
    const double hertz = 1e6 * device.getInfo<CL_DEVICE_MAX_CLOCK_FREQUENCY>() *
                         device.getInfo<CL_DEVICE_MAX_COMPUTE_UNITS>();
    const double pixels = static_cast<double>(pixel_count(options));
    // The low-resolution points, and one pixel in eight again in full.
    const double step = options.low_resolution_step;
    const double points = pixels * (refines(options) ? 1.0 / (step * step) + 0.125 : 1.0);
    const double lights =
        options.indirect ? static_cast<double>(set.light_count) + options.negative_lights : 0.0;
    const double triangles = static_cast<double>(scene.info().triangle_count) *
                             static_cast<double>(set.views.size() + 1);
    const double cycles =
        16.0 * points / lanes * lights + 90.0 * triangles * 8.0 / lanes + 900.0 * pixels / lanes;
    out.milliseconds = 1e3 * cycles / hertz;
    return out;
}

void SecondOrderSolver::allocate() {
    stride_ = padded(pixel_count(options_));
    low_stride_ = padded(low_pixel_count(options_));
    set_ = make_emitters(scene_, options_.sources);
    indirect_ = options_.indirect && set_.light_count > 0;
    refine_ = indirect_ && refines(options_);
    const Sizes size = sizes(scene_, options_, set_);
    const cl::Context context = queue_.getInfo<CL_QUEUE_CONTEXT>();
    const std::size_t most =
        cl::Device(queue_.getInfo<CL_QUEUE_DEVICE>()).getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    bytes_ = 0;
    const auto buffer = [&](std::size_t bytes) {
        bytes = std::max<std::size_t>(bytes, 16);
        bytes_ += bytes;
        if (bytes > most)
            throw DeviceError("second-order: a buffer of " + std::to_string(bytes) +
                              " bytes is needed, the device allows " + std::to_string(most));
        try {
            return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
        } catch (const cl::Error& error) {
            throw DeviceError("second-order: no room for a buffer of " + std::to_string(bytes) +
                              " bytes (OpenCL error " + std::to_string(error.err()) + ")");
        }
    };
    const auto filled = [&](const void* data, std::size_t bytes) {
        cl::Buffer out = buffer(bytes);
        try {
            if (bytes > 0) queue_.enqueueWriteBuffer(out, CL_TRUE, 0, bytes, data);
        } catch (const cl::Error& error) {
            throw DeviceError("second-order: a buffer cannot be written (OpenCL error " +
                              std::to_string(error.err()) + ")");
        }
        return out;
    };
    const auto word = [&](std::size_t value) {
        const std::uint32_t number = static_cast<std::uint32_t>(value);
        return filled(&number, sizeof number);
    };
    raster_.vertices = buffer(size.vertices);
    raster_.polygons = buffer(size.polygons);
    raster_.runs = buffer(size.runs);
    raster_.run_count = word(0);
    camera_visibility_ = buffer(size.camera_visibility);
    sources_.visibility = buffer(size.source_visibility);
    sources_.view_count = set_.views.size();
    sources_.pixels = set_.pixels;
    sources_.emitters = filled(set_.emitters.data(), set_.emitters.size() * sizeof(Emitter));
    sources_.views = filled(set_.views.data(), set_.views.size() * sizeof(View));
    drawn_ = {buffer(size.planes), buffer(size.ids), stride_};
    seen_ = drawn_;
    radiance_ = buffer(size.radiance);
    non_finite_ = word(0);
    irradiance_ = buffer(size.irradiance);
    mask_ = buffer(size.mask);
    accepted_ = buffer(size.accepted);
    lights_ = buffer(size.lights);
    negative_ = buffer(size.negative);
    all_count_ = word(pixel_count(options_));
    low_count_ = word(low_pixel_count(options_));
    listed_count_ = word(0);
    low_points_ = buffer(size.low_points);
    low_irradiance_ = buffer(size.low_irradiance);
    flags_ = buffer(size.flags);
    counts_ = buffer(size.counts);
    listed_ = buffer(size.listed);
    listed_points_ = buffer(size.listed_points);
    listed_irradiance_ = buffer(size.listed_irradiance);
}

}  // namespace clgi
