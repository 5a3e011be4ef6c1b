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
    need_range<double>("light-atlas", "kernel", options.kernel, 0, 64);
    need_range<double>("light-atlas", "mesh", options.mesh, 8, 131072);
    const int squares = static_cast<int>(mesh_squares(options.mesh));
    if (2 * squares * squares != options.mesh || squares % 2 != 0)
        throw Error("light-atlas: mesh is " + std::to_string(options.mesh) +
                    ", twice the square of an even number needed, such as 128, 512 or 2048");
    if (squares > options.filling_size)
        throw Error("light-atlas: mesh is " + std::to_string(options.mesh) +
                    ", at most 2 filling_size^2 = " +
                    std::to_string(2 * options.filling_size * options.filling_size) + " needed");
}

std::uint32_t mesh_squares(int triangles) {
    std::uint32_t out = 0;
    while (2 * (out + 1) * (out + 1) <= static_cast<std::uint32_t>(triangles)) ++out;
    return out;
}

namespace {

// Nothing unless the atlas is filled by projection.
void add_mesh(BufferTable& t, Buffers& b, const DeviceScene& scene, std::size_t charts,
              const LightAtlasOptions& options) {
    if (options.filling != Filling::project) return;
    const char* mesh = "mesh";
    const std::size_t word = sizeof(float);
    const std::size_t triangles = scene.info().triangle_count;
    const std::size_t squares = mesh_squares(options.mesh);
    b.mesh.chart_count = static_cast<std::uint32_t>(charts);
    t.add(b.mesh.uvs, "atlas coordinates", "the scene", triangles * 3 * 2 * word);
    t.add(b.mesh.charts, "charts of triangles", "the scene", triangles * word);
    t.add(b.mesh.boxes, "boxes of charts", "the scene", charts * 4 * word);
    t.add(b.mesh.places, "places of texels", "the size of the atlas",
          PLACE_PLANES * word * b.texel_stride);
    t.add(b.mesh.corners, "corners of meshes", mesh,
          b.filling_batch * MESH_CORNERS(squares) * sizeof(MeshCorner));
    t.add(b.mesh.copies, "triangles of meshes", mesh,
          b.filling_batch * MESH_TRIANGLES(squares) * MESH_COPIES * sizeof(MeshCopy));
}

}  // namespace

BufferTable table(Buffers& b, Emitters& emitters, const DeviceScene& scene, std::size_t samples,
                  std::size_t sites, const AtlasLayout& atlas, const LightAtlasOptions& options,
                  std::size_t budget, std::size_t largest) {
    const std::size_t texels = atlas.texels.size();
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
                   pixels(options.filling_size, b.filling_batch) *
                       pixel_bytes(filling_pixels(options))));
    add_mesh(t, b, scene, atlas.charts.size(), options);
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
