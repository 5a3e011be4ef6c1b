// What the second-order solver needs in memory and time: options in range, and the table of
// buffers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/kit/draw.hpp>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <string>

#include "core/kit/ranges.hpp"
#include "core/opencl/check.hpp"
#include "methods/second_order/solver_state.hpp"

namespace clgi {

namespace second_order {

std::size_t pixel_count(const SecondOrderOptions& options) {
    return static_cast<std::size_t>(options.width) * options.height;
}

std::size_t low_pixel_count(const SecondOrderOptions& options) {
    const auto step = static_cast<std::uint32_t>(options.low_resolution_step);
    return low_size(static_cast<std::uint32_t>(options.width), step) *
           low_size(static_cast<std::uint32_t>(options.height), step);
}

void check(const SecondOrderOptions& options) {
    need_range<double>("second-order", "width", options.width, 1, 16384);
    need_range<double>("second-order", "height", options.height, 1, 16384);
    need_range<double>("second-order", "negative_vpls", options.negative_vpls, 0, 1 << 20);
    need_range<double>("second-order", "footprint", options.footprint, 0, 1e6);
    const int step = options.low_resolution_step;
    if (step != 1 && step != 2 && step != 4)
        throw Error("second-order: low_resolution_step is " + std::to_string(step) +
                    ", 1, 2 or 4 needed");
    if (!(options.discontinuity_threshold >= 0.0f))
        throw Error("second-order: discontinuity_threshold is negative or not a number");
    if (options.indirect && options.emitters.vpls > 0 && !options.emitters.shadows)
        throw Error(
            "second-order: emitters.shadows is false, but indirect light places VPLs through the "
            "views of emitters; indirect false, or emitters.vpls 0, needed");
}

bool refines(const SecondOrderOptions& options) {
    return options.low_resolution_step > 1 && options.discontinuity_threshold > 0.0f;
}

BufferTable table(Buffers& b, Emitters& emitters, const DeviceScene& scene,
                  const SecondOrderOptions& options, std::size_t helpers) {
    const char* picture = "width and height";
    const char* vpls = "emitters.vpls";
    const std::size_t pixels = pixel_count(options), low_pixels = low_pixel_count(options);
    b.stride = plane_stride(pixels);
    b.low_stride = plane_stride(low_pixels);
    const Storage storage = options.build.storage;
    const bool lit = options.indirect && emitters.set().capacity.emitters > 0;
    const bool refine = lit && refines(options);
    const std::size_t n = lit ? options.emitters.vpls : 0;
    const std::size_t negative = lit ? options.negative_vpls : 0;
    const std::size_t full = lit ? b.stride : 0, listed = refine ? b.stride : 0;
    const std::size_t low = refine ? b.low_stride : 0, word = sizeof(std::uint32_t);

    BufferTable t("second-order");
    emitters.add_to(t);
    add_raster_lists(t, b.camera, scene);
    t.add(b.camera.pixels, "the camera's visibility", picture, pixels * sizeof(std::uint64_t));
    t.add(b.camera_view, "the camera's view", picture, sizeof(View));
    t.add(b.drawn.planes, "planes", picture, gbuffer_bytes(storage, b.stride));
    t.add(b.drawn.ids, "ids", picture, GBUFFER_ID_PLANES * b.stride * word);
    t.add(b.mask, "the candidates' mask", vpls, n > 0 ? most_candidates / 8 : 0);
    t.add(b.accepted, "accepted candidates", vpls, n * word);
    t.add(b.lights, "VPLs", vpls, n * sizeof(Vpl));
    t.add(b.negative, "negative VPLs", "negative_vpls", negative * sizeof(Vpl));
    t.add(b.low_points, "low-resolution points", picture, point_bytes(storage, low));
    t.add(b.low_irradiance, "low-resolution irradiance", picture, irradiance_bytes(storage, low));
    t.add(b.flags, "flags", picture, refine ? pixels : 0);
    t.add(b.counts, "counts", picture, refine ? (pixels / COMPACT_BLOCK + 1) * word : 0);
    t.add(b.listed, "listed pixels", picture, listed * word);
    t.add(b.listed_points, "listed points", picture, point_bytes(storage, listed));
    t.add(b.listed_irradiance, "listed irradiance", picture, irradiance_bytes(storage, listed));
    t.add(b.irradiance, "irradiance", picture, irradiance_bytes(storage, full));
    t.add(b.radiance, "radiance", picture, RADIANCE_PLANES * b.stride * sizeof(float));
    b.helpers.resize(helpers);
    for (cl::Buffer& helper : b.helpers)
        t.add(helper, "a helper's irradiance", picture, irradiance_bytes(storage, full));
    t.add_word(b.all_count, "counters", static_cast<std::uint32_t>(pixels));
    t.add_word(b.low_count, "counters", static_cast<std::uint32_t>(low_pixels));
    t.add_word(b.listed_count, "counters", 0);
    t.add_word(b.non_finite, "counters", 0);
    return t;
}

}  // namespace second_order

using namespace second_order;

Estimate estimate(const cl::Device& device, const DeviceScene& scene,
                  const SecondOrderOptions& options, std::size_t devices) {
    check(options);
    Emitters emitters(scene, options.emitters);
    Buffers none;
    Estimate out;
    out.bytes =
        table(none, emitters, scene, options, std::max<std::size_t>(devices, 1) - 1).bytes();

    // In pairs of a point and a VPL, as measured on a CPU with packets of 8: a triangle drawn is
    // worth 45 of them, a pixel resolved, interpolated and combined 56.
    const double pixels = static_cast<double>(pixel_count(options));
    // The low-resolution points, and one pixel in eight again in full.
    const double step = options.low_resolution_step;
    const double points = pixels * (refines(options) ? 1.0 / (step * step) + 0.125 : 1.0);
    const EmitterSet& set = emitters.set();
    const double vpls =
        options.indirect ? static_cast<double>(set.vpl_count) + options.negative_vpls : 0.0;
    const double triangles = static_cast<double>(scene.info().triangle_count) *
                             static_cast<double>(set.views.size() + 1);
    const double pairs = points * vpls + 45.0 * triangles + 56.0 * pixels;
    out.milliseconds = 1e3 * pairs / pairs_per_second(device);
    return out;
}

}  // namespace clgi
