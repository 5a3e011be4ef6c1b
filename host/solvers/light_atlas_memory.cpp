// What the light atlas solver needs in memory: options in range, and the table of buffers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/planes.hpp>
#include <string>

#include "opencl/check.hpp"
#include "solvers/light_atlas_state.hpp"

namespace clgi {

namespace light_atlas {

void check(const LightAtlasOptions& options) {
    need_range<double>("light-atlas", "bounces", options.bounces, 0, 1000);
    need_range<double>("light-atlas", "exchange_samples", options.exchange_samples, 1, 4096);
    need_range<double>("light-atlas", "threshold", options.threshold, 1e-7, 1);
    for (const auto& [name, size] : {std::pair{"exchange_size", options.exchange_size},
                                     std::pair{"filling_size", options.filling_size}}) {
        need_range<double>("light-atlas", name, size, 32, 1024);
        if (size % 2 != 0)
            throw Error(std::string("light-atlas: ") + name + " is " + std::to_string(size) +
                        ", an even number needed");
    }
}

BufferTable table(Buffers& b, Emitters& emitters, const DeviceScene& scene, std::size_t samples,
                  std::size_t sites, std::size_t texels, const LightAtlasOptions& options,
                  std::size_t budget, std::size_t largest) {
    const char* vpls = "the number of VPLs";
    const char* points = "the number of VPLs or of samples for each";
    const char* size = "the size of the atlas";
    const std::size_t word = sizeof(float);
    SiteBuffers& s = b.sites;
    s.site_count = static_cast<std::uint32_t>(sites);
    s.stride = plane_stride(sites);
    s.sample_count = static_cast<std::uint32_t>(samples);
    s.sample_stride = plane_stride(samples + sites);
    b.texel_count = static_cast<std::uint32_t>(texels);
    b.texel_stride = plane_stride(texels);
    b.samples.stride = s.sample_stride;
    b.texels.stride = b.texel_stride;
    // Maps of a batch should stay in a core's cache, and every core have views to draw.
    b.exchange_batch = 16;
    b.filling_batch = 8;

    BufferTable t("light-atlas");
    emitters.add_to(t);
    add_raster_lists(t, b.lists, scene);
    t.add(s.sites, "sites", vpls, sites * sizeof(Site));
    t.add(s.planes, "VPLs", vpls, SITE_PLANES * word * s.stride);
    t.add(s.light, "irradiance of VPLs", vpls, SITE_LIGHT_PLANES * word * s.stride);
    t.add(s.balance, "balance factors", vpls, BALANCE_PLANES * word * s.stride);
    t.add(s.power, "powers", vpls, word * s.stride);
    t.add(s.shot, "shot powers", vpls, 3 * word * s.stride);
    t.add(s.chosen, "lists of VPLs", vpls, word * (sites + 1));
    t.add(b.sample_list, "sample points", points, (samples + sites) * sizeof(SurfaceSample));
    t.add(s.samples, "planes of sample points", points,
          gbuffer_bytes(Storage::full, s.sample_stride) + 64);
    t.add(b.samples.ids, "ids of sample points", points,
          GBUFFER_ID_PLANES * word * s.sample_stride);
    t.add(b.sample_irradiance, "irradiance of sample points", points,
          irradiance_bytes(Storage::full, s.sample_stride));
    t.add(s.weights, "weights of sample points", points, word * s.sample_stride);
    t.add(b.texel_list, "texels", size, texels * sizeof(SurfaceSample));
    t.add(b.texels.planes, "planes of texels", size, gbuffer_bytes(Storage::full, b.texel_stride));
    t.add(b.texels.ids, "ids of texels", size, GBUFFER_ID_PLANES * word * b.texel_stride);
    t.add(b.irradiance, "irradiance of texels", size,
          irradiance_bytes(Storage::full, b.texel_stride));
    t.add(b.reach, "reach of texels", size, word * b.texel_stride);
    t.add(b.filled, "form factors of texels", size, word * b.texel_stride);
    t.add(b.strongest, "maxima", vpls, sizeof(ArgMax));
    t.add(b.arg_max_scratch, "maxima of tiles", vpls, arg_max_scratch_bytes(sites));
    const std::size_t batch = std::max(b.exchange_batch, b.filling_batch);
    t.add(b.views, "views", vpls, 5 * batch * sizeof(View));
    const auto pixels = [](int side, std::size_t count) {
        return 3 * count * static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
    };
    t.add(b.pixels, "hemicubes", "exchange_size or filling_size",
          std::max(pixels(options.exchange_size, b.exchange_batch) * pixel_bytes(Pixels::visibility),
                   pixels(options.filling_size, b.filling_batch) * pixel_bytes(Pixels::depth)));
    t.add_word(b.non_finite, "counters", 0);
    const std::size_t row = s.stride * sizeof(cl_half), all = sites * row;
    b.kept = all <= largest && t.bytes() + all <= budget;
    t.add(b.rows, "rows of transport", vpls, b.kept ? all : b.exchange_batch * row);
    return t;
}

}  // namespace light_atlas

std::size_t light_atlas_least_bytes(std::size_t vpls, std::size_t samples) {
    const std::size_t word = sizeof(float), light_and_weight = 4;
    std::size_t of_point = light_and_weight, of_site = 5;  // lists and powers
    for (const std::size_t planes : {std::size_t{GBUFFER_PLANES}, std::size_t{GBUFFER_ID_PLANES}})
        of_point += planes;
    for (const std::size_t planes : {std::size_t{SITE_PLANES}, std::size_t{SITE_LIGHT_PLANES},
                                     std::size_t{BALANCE_PLANES}})
        of_site += planes;
    return (vpls + samples) * (sizeof(SurfaceSample) + of_point * word) +
           vpls * (sizeof(Site) + of_site * word);
}

}  // namespace clgi
