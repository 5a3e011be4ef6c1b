// What the light atlas solver needs in memory: options in range, and the table of buffers.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <string>

#include "core/opencl/check.hpp"
#include "methods/light_atlas/solver_state.hpp"
#include "shading/lights/single_view.hpp"

namespace clgi {

namespace light_atlas {

void check(const LightAtlasOptions& options) {
    if (options.build.storage != Storage::full)
        throw Error(
            "light-atlas: storage is half, full needed: texels are sums of thousands of "
            "VPLs; views of the atlas may be half");
    need_range<double>("light-atlas", "bounces", options.bounces, 0, 1000);
    need_range<double>("light-atlas", "exchange_samples", options.exchange_samples, 0, 4096);
    need_range<double>("light-atlas", "threshold", options.threshold, 1e-7, 1);
    need_range<double>("light-atlas", "hemicube_size", options.hemicube_size, 32, 1024);
    if (options.hemicube_size % 2 != 0)
        throw Error("light-atlas: hemicube_size is " + std::to_string(options.hemicube_size) +
                    ", an even number needed");
    if (options.refine != 1 && options.refine != 2 && options.refine != 4)
        throw Error("light-atlas: refine is " + std::to_string(options.refine) +
                    ", 1, 2 or 4 needed");
    if (!occludes(options.occlusion) && options.filling == Filling::project)
        throw Error("light-atlas: occlusion is off, which Filling::project needs");
    need_range<double>("light-atlas", "kernel", options.kernel, 0, 64);
    need_range<double>("light-atlas", "mesh", options.mesh, 8, 131072);
    const int squares = static_cast<int>(mesh_squares(options.mesh));
    if (2 * squares * squares != options.mesh || squares % 2 != 0)
        throw Error("light-atlas: mesh is " + std::to_string(options.mesh) +
                    ", twice the square of an even number needed, such as 128, 512 or 2048");
    if (squares > options.hemicube_size)
        throw Error("light-atlas: mesh is " + std::to_string(options.mesh) +
                    ", at most 2 hemicube_size^2 = " +
                    std::to_string(2 * options.hemicube_size * options.hemicube_size) + " needed");
}

void check_sizes(std::size_t vpls, std::size_t samples, std::size_t texels, std::size_t points) {
    constexpr std::size_t skew = 1024;  // of plane_stride()
    const auto check = [](const char* name, std::size_t count) {
        if (count > (std::size_t{1} << 32) / GBUFFER_PLANES - skew)
            throw Error(std::string("light-atlas: there are ") + std::to_string(count) + " " +
                        name + ", at most 2^28 - 1024 needed");
    };
    static_assert(GBUFFER_PLANES == 16 && int{SITE_PLANES} < int{GBUFFER_PLANES} &&
                  int{SITE_POINT_PLANES} < int{GBUFFER_PLANES});
    check("VPLs and sample points", vpls + samples);
    check("texels and points", (texels + 15) / 16 * 16 + points);  // as first_bake_point()
}

// Light through the openings of a building is too much by a fifth with maps of 512 pixels, by 1 %
// with 2048 (docs/results/accuracy.md).
int usual_shadow_size(const DeviceScene& scene, const EmitterOptions& emitters) {
    constexpr std::size_t most_pixels = std::size_t{1} << 24;  // of all maps
    constexpr int most = 2048, least = 512;
    std::size_t maps = 0;
    for (const Light& light : scene.lights()) maps += has_single_view(light);
    if (scene.environment()) maps += static_cast<std::size_t>(emitters.environment_lights);
    int size = most;
    while (size > least && maps * size * size > most_pixels) size /= 2;
    return size;
}

std::uint32_t mesh_squares(int triangles) {
    std::uint32_t out = 0;
    while (2 * (out + 1) * (out + 1) <= static_cast<std::uint32_t>(triangles)) ++out;
    return out;
}

namespace {

constexpr std::uint32_t unseen_vpls = 256;    // a batch where none has a hemicube
constexpr std::uint32_t grouped_vpls = 128;   // and where groups draw them
constexpr std::size_t points_of_all = 25600;  // that a shooter looks at

// Sample points of a receiving VPL. The more VPLs, the fewer of each: a packet holds more of them.
std::uint32_t looked_at(const LightAtlasOptions& options, const VplLayout& layout) {
    std::uint32_t most = 1;
    for (const VplSite& vpl : layout.vpls) most = std::max(most, vpl.sample_count);
    if (options.exchange_samples > 0) return std::min(options.exchange_samples, most);
    const std::size_t share = points_of_all / layout.vpls.size();
    return std::min(static_cast<std::uint32_t>(std::clamp<std::size_t>(share, 4, 16)), most);
}

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
          b.batch * MESH_CORNERS(squares) * sizeof(MeshCorner));
    t.add(b.mesh.copies, "triangles of meshes", mesh,
          b.batch * MESH_TRIANGLES(squares) * MESH_COPIES * sizeof(MeshCopy));
}

// Nothing unless texels are refined.
void add_blocks(BufferTable& t, Buffers& b, const AtlasBlocks& made) {
    const char* size = "the size of the atlas";
    b.block_count = static_cast<std::uint32_t>(made.blocks.size());
    if (b.block_count == 0) return;
    b.listed_count = static_cast<std::uint32_t>(made.list.size());
    b.listed_stride = plane_stride(made.list.size());
    b.unblocked = made.unblocked;
    b.listed.stride = b.listed_stride;
    const std::size_t word = sizeof(std::uint32_t);
    t.add(b.listed_texels, "texels that are looked up first", size,
          made.list.size() * sizeof(SurfaceSample));
    t.add(b.blocks.planes, "their planes", size, gbuffer_bytes(Storage::full, b.listed_stride));
    t.add(b.listed.ids, "their ids", size, GBUFFER_ID_PLANES * word * b.listed_stride);
    t.add(b.blocks.places, "texels in no block", size, (made.unblocked + 1) * word);
    t.add(b.blocks.seen, "VPLs that see them", size, seen_rows(b.batch) * b.listed_stride);
    t.add(b.blocks.blocks, "blocks of texels", size, made.blocks.size() * sizeof(AtlasBlock));
}

}  // namespace

BufferTable table(Buffers& b, Emitters& emitters, const DeviceScene& scene, const VplLayout& layout,
                  const AtlasLayout& atlas, std::size_t points, const AtlasBlocks& blocks,
                  const LightAtlasOptions& options, bool grouped, std::size_t budget,
                  std::size_t largest) {
    const std::size_t samples = layout.samples.size(), sites = layout.vpls.size();
    const std::size_t texels = atlas.texels.size();
    check_sizes(sites, samples, texels, points);
    const char* vpls = "the number of VPLs";
    const char* per_vpl = "the number of VPLs or of samples for each";
    const char* size = "the size of the atlas";
    const std::size_t word = sizeof(float);
    SiteBuffers& s = b.sites;
    s.site_count = static_cast<std::uint32_t>(sites);
    s.stride = plane_stride(sites);
    s.sample_count = static_cast<std::uint32_t>(samples);
    s.sample_stride = plane_stride(samples + sites);
    s.most_samples = looked_at(options, layout);
    s.per_site = points_per_site(s.most_samples);
    s.point_stride = plane_stride(sites * s.per_site);
    b.texel_count = static_cast<std::uint32_t>(texels);
    b.first_point = first_bake_point(texels);
    b.receiver_count =
        points > 0 ? b.first_point + static_cast<std::uint32_t>(points) : b.texel_count;
    b.texel_stride = plane_stride(b.receiver_count);
    b.samples.stride = s.sample_stride;
    b.texels.stride = b.texel_stride;
    // Maps of a batch should stay in the cache, and every core have views to draw. A row of bits
    // each. Groups are many: they need more views, where a quarter of the memory holds them.
    // Without maps a batch is what a report may wait for.
    const auto side = static_cast<std::size_t>(options.hemicube_size);
    const std::size_t cube = 3 * side * side * pixel_bytes(filling_pixels(options));
    b.batch = occludes(options.occlusion) ? std::uint32_t{SEEN_VPLS} : unseen_vpls;
    const std::size_t of_batch = grouped_vpls * (cube + s.stride * sizeof(cl_half)) +
                                 2 * seen_rows(grouped_vpls) * b.texel_stride;
    grouped = grouped && occludes(options.occlusion) && options.filling == Filling::gather &&
              of_batch <= std::min(budget / 4, largest);
    if (grouped) b.batch = std::min<std::uint32_t>(grouped_vpls, SEEN_VPLS * seen_rows(sites));

    BufferTable t("light-atlas");
    emitters.add_to(t);
    if (emitters.casts_shadows()) add_raster_lists(t, b.lists, scene);
    t.add(s.sites, "sites", vpls, sites * sizeof(Site));
    t.add(s.planes, "VPLs", vpls, SITE_PLANES * word * s.stride);
    t.add(s.light, "irradiance of VPLs", vpls, SITE_LIGHT_PLANES * word * s.stride);
    t.add(s.balance, "balance factors", vpls, BALANCE_PLANES * word * s.stride);
    t.add(s.power, "powers", vpls, word * s.stride);
    t.add(s.shot, "shot powers", vpls, 3 * word * s.stride);
    t.add(s.chosen, "lists of VPLs", vpls, word * (sites + 1));
    t.add(b.sample_list, "sample points", per_vpl, (samples + sites) * sizeof(SurfaceSample));
    t.add(s.samples, "planes of sample points", per_vpl,
          gbuffer_bytes(Storage::full, s.sample_stride) + 64);
    t.add(s.points, "points of VPLs", per_vpl, SITE_POINT_PLANES * word * s.point_stride);
    t.add(b.samples.ids, "ids of sample points", per_vpl,
          GBUFFER_ID_PLANES * word * s.sample_stride);
    t.add(b.sample_irradiance, "irradiance of sample points", per_vpl,
          irradiance_bytes(Storage::full, s.sample_stride));
    t.add(s.sent, "light that was sent", per_vpl, 3 * word * s.sample_stride);
    t.add(s.sample_power, "light that is sent", per_vpl, 3 * word * s.sample_stride);
    t.add(s.site_power, "light that VPLs send", vpls, 3 * word * s.stride);
    t.add(s.sends, "flags of VPLs", vpls, s.stride);
    t.add(s.list, "lists of VPLs that send", vpls, word * sites);
    t.add(s.listed, "their number", vpls, word);
    t.add(b.list_scratch, "sums of tiles", vpls, scan_scratch_bytes(sites));
    t.add(b.texel_list, "texels", size, texels * sizeof(SurfaceSample));
    t.add(b.texels.planes, "planes of texels", size, gbuffer_bytes(Storage::full, b.texel_stride));
    t.add(b.texels.ids, "ids of texels", size, GBUFFER_ID_PLANES * word * b.texel_stride);
    for (cl::Buffer* buffer : {&b.gathered, &b.irradiance})
        t.add(*buffer, "irradiance of texels", size,
              irradiance_bytes(Storage::full, b.texel_stride));
    t.add(b.reach, "reach of texels", size, word * b.texel_stride);
    t.add(b.filled, "form factors of texels", size, word * b.texel_stride);
    t.add(b.strongest, "maxima", vpls, sizeof(ArgMax));
    t.add(b.arg_max_scratch, "maxima of tiles", vpls, arg_max_scratch_bytes(sites));
    if (occludes(options.occlusion)) {
        t.add(b.views, "views", vpls, 5 * b.batch * sizeof(View));
        t.add(b.pixels, "hemicubes", "hemicube_size", b.batch * cube);
    }
    add_mesh(t, b, scene, atlas.charts.size(), options);
    add_blocks(t, b, blocks);
    t.add_word(b.non_finite, "counters", 0);
    const auto fits = [&](std::size_t all, std::size_t others) {
        return all <= largest && t.bytes() + all + others <= budget;
    };
    const std::size_t row = s.stride * sizeof(cl_half);
    // What a batch sees has to fit beside the rows.
    const bool looked_up = occludes(options.occlusion) && options.filling == Filling::gather;
    b.kept = fits(sites * row, looked_up ? seen_rows(b.batch) * b.texel_stride : 0);
    t.add(b.rows, "rows of transport", vpls,
          (b.kept ? sites : std::min<std::size_t>(b.batch, sites)) * row);
    if (!looked_up) return t;
    const std::size_t seen = seen_rows(sites) * b.texel_stride;
    b.seen_kept = b.kept && fits(seen, 0);
    t.add(b.seen, "texels that VPLs see", "the number of VPLs or the size of the atlas",
          b.seen_kept ? seen : seen_rows(b.batch) * b.texel_stride);
    if (grouped && t.bytes() > budget)  // smaller batches may fit
        return table(b, emitters, scene, layout, atlas, points, blocks, options, false, budget,
                     largest);
    return t;
}

}  // namespace light_atlas

std::size_t light_atlas_least_bytes(std::size_t vpls, std::size_t samples) {
    const std::size_t word = sizeof(float), light_and_powers = 9;
    std::size_t of_point = light_and_powers, of_site = 9;  // lists and powers
    for (const std::size_t planes : {std::size_t{GBUFFER_PLANES}, std::size_t{GBUFFER_ID_PLANES}})
        of_point += planes;
    for (const std::size_t planes :
         {std::size_t{SITE_PLANES}, std::size_t{SITE_LIGHT_PLANES}, std::size_t{BALANCE_PLANES}})
        of_site += planes;
    return (vpls + samples) * (sizeof(SurfaceSample) + of_point * word) +
           vpls * (sizeof(Site) + of_site * word);
}

}  // namespace clgi
