// What the second-order solver needs in memory and time, and its buffers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "opencl/error_text.hpp"
#include "solvers/ranges.hpp"
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
    std::size_t vertices, polygons, runs, source_visibility, emitters, views, camera_visibility, planes,
        ids, mask, accepted, lights, negative, low_points, low_irradiance, flags, counts, listed,
        listed_points, listed_irradiance, irradiance, radiance, helper;
};

// One buffer, and what lowers it.
struct Need {
    const char* name;
    const char* lower;
    std::size_t bytes;
};

constexpr std::size_t least = 16;  // bytes: no buffer is empty
constexpr std::size_t words = 5;   // counters of one uint

std::vector<Need> needs(const Sizes& size, std::size_t helpers) {
    const char* scene = "the scene's triangles";
    const char* sources = "sources.shadow_size, face_size or area_samples";
    const char* picture = "width and height";
    const char* lights = "sources.lights";
    std::vector<Need> out = {{"vertices", scene, size.vertices},
                             {"polygons", scene, size.polygons},
                             {"runs", scene, size.runs},
                             {"the sources' visibility", sources, size.source_visibility},
                             {"emitters", sources, size.emitters},
                             {"views", sources, size.views},
                             {"the camera's visibility", picture, size.camera_visibility},
                             {"planes", picture, size.planes},
                             {"ids", picture, size.ids},
                             {"the candidates' mask", lights, size.mask},
                             {"accepted candidates", lights, size.accepted},
                             {"indirect lights", lights, size.lights},
                             {"negative lights", "negative_lights", size.negative},
                             {"low-resolution points", picture, size.low_points},
                             {"low-resolution irradiance", picture, size.low_irradiance},
                             {"flags", picture, size.flags},
                             {"counts", picture, size.counts},
                             {"listed pixels", picture, size.listed},
                             {"listed points", picture, size.listed_points},
                             {"listed irradiance", picture, size.listed_irradiance},
                             {"irradiance", picture, size.irradiance},
                             {"radiance", picture, size.radiance}};
    out.insert(out.end(), helpers, {"a helper's irradiance", picture, size.helper});
    out.insert(out.end(), words, {"counters", picture, least});
    for (Need& need : out) need.bytes = std::max(need.bytes, least);
    return out;
}

std::size_t sum(const std::vector<Need>& needs) {
    std::size_t out = 0;
    for (const Need& need : needs) out += need.bytes;
    return out;
}

std::string megabytes(std::size_t bytes) {
    char text[32];
    std::snprintf(text, sizeof text, "%.1f MB", 1e-6 * static_cast<double>(bytes));
    return text;
}

// Throws DeviceError where the device or the budget cannot hold it, before anything is allocated.
void check_room(const std::vector<Need>& needs, const SecondOrderOptions& options,
                const cl::Device& device, std::size_t scene_bytes) {
    const std::size_t most = device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>();
    std::map<std::string, std::size_t> by_option;
    for (const Need& need : needs) {
        if (need.bytes > most)
            throw DeviceError(std::string("second-order: ") + need.name + " need " +
                              megabytes(need.bytes) + " in one buffer, the device allows " +
                              megabytes(most) + "; lower " + need.lower);
        by_option[need.lower] += need.bytes;
    }
    const std::size_t device_bytes = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    const std::size_t beside = device_bytes - std::min(scene_bytes, device_bytes);
    const bool asked = options.memory_budget > 0;
    const std::size_t room = asked ? options.memory_budget : beside;
    if (sum(needs) <= room) return;
    const auto largest =
        std::max_element(by_option.begin(), by_option.end(),
                         [](const auto& a, const auto& b) { return a.second < b.second; });
    throw DeviceError("second-order: " + megabytes(sum(needs)) + " are needed, " +
                      (asked ? "memory_budget allows " : "the device has beside the scene ") +
                      megabytes(room) + "; " + megabytes(largest->second) + " of it depend on " +
                      largest->first + ", to be lowered");
}

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
    out.emitters = set.emitters.size() * sizeof(Emitter);
    out.views = set.views.size() * sizeof(View);
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
    out.helper = out.irradiance;
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
                  const SecondOrderOptions& options, std::size_t devices) {
    check(options);
    const EmitterSet set = make_emitters(scene, options.sources);
    Estimate out;
    out.bytes = sum(needs(sizes(scene, options, set), std::max<std::size_t>(devices, 1) - 1));

    // In pairs of a point and a light, as measured on a CPU with packets of 8: a triangle drawn is
    // worth 45 of them, a pixel resolved, interpolated and combined 56.
    const double pixels = static_cast<double>(pixel_count(options));
    // The low-resolution points, and one pixel in eight again in full.
    const double step = options.low_resolution_step;
    const double points = pixels * (refines(options) ? 1.0 / (step * step) + 0.125 : 1.0);
    const double lights =
        options.indirect ? static_cast<double>(set.light_count) + options.negative_lights : 0.0;
    const double triangles = static_cast<double>(scene.info().triangle_count) *
                             static_cast<double>(set.views.size() + 1);
    const double pairs = points * lights + 45.0 * triangles + 56.0 * pixels;
    out.milliseconds = 1e3 * pairs / pairs_per_second(device);
    return out;
}

void SecondOrderSolver::allocate(const SecondOrderOptions& options, EmitterSet set) {
    const Sizes size = sizes(scene_, options, set);
    const cl::Context context = queue_.getInfo<CL_QUEUE_CONTEXT>();
    const std::vector<Need> all = needs(size, helpers_.size());
    check_room(all, options, queue_.getInfo<CL_QUEUE_DEVICE>(), scene_.bytes());
    for (const Helper& helper : helpers_)
        check_room(all, options, helper.queue.getInfo<CL_QUEUE_DEVICE>(), scene_.bytes());
    // What is refused up to here leaves everything as it was.
    usable_ = false;
    options_ = options;
    set_ = std::move(set);
    stride_ = padded(pixel_count(options_));
    low_stride_ = padded(low_pixel_count(options_));
    indirect_ = options_.indirect && set_.light_count > 0;
    refine_ = indirect_ && refines(options_);
    bytes_ = 0;
    const auto buffer = [&](std::size_t bytes) {
        bytes = std::max(bytes, least);
        bytes_ += bytes;
        try {
            return cl::Buffer(context, CL_MEM_READ_WRITE, bytes);
        } catch (const cl::Error& error) {
            throw DeviceError("second-order: no room for a buffer of " + megabytes(bytes) +
                              ", of " + megabytes(sum(all)) +
                              " in all: " + error_text(error.err()));
        }
    };
    const auto filled = [&](const void* data, std::size_t bytes) {
        cl::Buffer out = buffer(bytes);
        try {
            if (bytes > 0) queue_.enqueueWriteBuffer(out, CL_TRUE, 0, bytes, data);
        } catch (const cl::Error& error) {
            throw DeviceError("second-order: a buffer cannot be written: " +
                              error_text(error.err()));
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
    sources_.emitters = filled(set_.emitters.data(), size.emitters);
    sources_.views = filled(set_.views.data(), size.views);
    drawn_ = {buffer(size.planes), buffer(size.ids), stride_, options_.build.storage};
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
    for (Helper& helper : helpers_) helper.irradiance = buffer(size.helper);
    usable_ = true;
}

}  // namespace clgi
