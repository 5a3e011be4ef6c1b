// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/atlas.hpp>
#include <cmath>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

// Planes of texels from the first to that of the triangles' normals.
void need_texels(const PassKernel& pass, std::uint32_t stride, std::uint32_t count) {
    need_stride(pass, "stride", stride, count);
    need_countable(pass.name, "texels", GBUFFER_GEOMETRIC + 3, stride);
}

void need_senders(const PassKernel& pass, const FillParams& params, const SiteBuffers& b) {
    need_texels(pass, params.stride, params.texel_count);
    need(pass, "sites", b.sites, b.site_count * sizeof(Site));
    need(pass, "planes", b.planes, SITE_PLANES * word * params.site_stride);
    need(pass, "site_power", b.site_power, 3 * word * params.site_stride);
    need(pass, "samples", b.samples, GBUFFER_PLANES * word * params.sample_stride);
    need(pass, "sample_power", b.sample_power, 3 * word * params.sample_stride);
}

std::size_t last_shooter(const FillParams& params) {
    return std::size_t{params.first_shooter} + params.shooter_count;
}

// planes: of the texels that are read.
void need_gather(const PassKernel& pass, const FillParams& params, const SiteBuffers& b,
                 const cl::Buffer& texels, std::size_t planes, const cl::Buffer& gathered,
                 const cl::Buffer& filled) {
    need_senders(pass, params, b);
    need(pass, "list", b.list, last_shooter(params) * word);
    need(pass, "listed", b.listed, word);
    need(pass, "texels", texels, planes * word * params.stride);
    need(pass, "gathered", gathered, 3 * word * params.stride);
    need(pass, "filled", filled, word * params.stride);
}

// How many texels there are from the first on.
template <typename Params>
std::uint32_t texels_left(const PassKernel& pass, const Params& params) {
    if (params.first_texel > params.texel_count)
        throw Error(pass.name + ": first_texel is " + std::to_string(params.first_texel) +
                    ", at most " + std::to_string(params.texel_count) + " needed");
    return params.texel_count - params.first_texel;
}

// Corners and triangles of M are counted in 32 bits; views and their mesh have to agree.
void need_mesh(const PassKernel& pass, const MeshParams& params) {
    if (params.squares < 2 || params.squares > 256 || params.squares % 2 != 0)
        throw Error(pass.name + ": squares is " + std::to_string(params.squares) +
                    ", an even number from 2 to 256 needed");
    if (params.shooter_count > 4096)
        throw Error(pass.name + ": shooter_count is " + std::to_string(params.shooter_count) +
                    ", at most 4096 needed");
}

std::size_t mesh_corners(const MeshParams& params) {
    return std::size_t{params.shooter_count} * MESH_CORNERS(params.squares);
}

std::size_t mesh_triangles(const MeshParams& params) {
    return std::size_t{params.shooter_count} * MESH_TRIANGLES(params.squares);
}

std::size_t hemicube_bytes(const MeshParams& params) {
    return 3 * sizeof(std::uint64_t) * params.shooter_count * params.size * params.size;
}

}  // namespace

AtlasPasses::AtlasPasses(const Programs& programs, const BuildOptions& options)
    : storage_(options.storage) {
    const std::vector<std::string> gathered = {"see_listed", "see_blocks", "gather", "nearest",
                                               "complete"},
                                   projected = {"geometry", "replicate", "project"};
    see_ = programs.kernel("atlas", "see", full(options));
    flat_ = programs.kernel("atlas", "flat", scalar(options));
    see_listed_ = programs.kernel("atlas", "see_listed", full(options), "", gathered);
    see_blocks_ = programs.kernel("atlas", "see_blocks", full(options), "", gathered);
    gather_ = programs.kernel("atlas", "gather", full(options), "", gathered);
    gather_open_ = programs.kernel("atlas", "gather", full(options), "-DCLGI_OPEN");
    gather_open_.name = "atlas.gather_open";
    geometry_ = programs.kernel("atlas", "geometry", scalar(options), "", projected);
    replicate_ = programs.kernel("atlas", "replicate", scalar(options), "", projected);
    project_ = programs.kernel("atlas", "project", scalar(options), "", projected);
    nearest_ = programs.kernel("atlas", "nearest", full(options), "", gathered);
    complete_ = programs.kernel("atlas", "complete", full(options), "", gathered);
    show_ = programs.kernel("atlas", "show", options);
    volume_ = programs.kernel("atlas", "volume", options);
}

void AtlasPasses::build(std::initializer_list<const char*> passes) const {
    build_named({see_, flat_, see_listed_, see_blocks_, gather_, gather_open_, geometry_,
                 replicate_, project_, nearest_, complete_, show_, volume_},
                passes);
}

cl::Event AtlasPasses::see(const cl::CommandQueue& queue, const SeeParams& params,
                           const cl::Buffer& views, const cl::Buffer& depth,
                           const cl::Buffer& texels, const cl::Buffer& seen,
                           const WaitList& wait) const {
    need_texels(see_, params.stride, params.texel_count);
    const std::size_t shooters = params.shooter_count;
    need(see_, "views", views, 5 * shooters * sizeof(View));
    need(see_, "depth", depth, 3 * word * shooters * params.size * params.size);
    need(see_, "texels", texels, (GBUFFER_GEOMETRIC + 3) * word * params.stride);
    need(see_, "seen", seen, (params.first_row + seen_rows(shooters)) * params.stride);
    return launch(see_, queue, packets(see_, texels_left(see_, params)), wait, params, views, depth,
                  texels, seen);
}

cl::Event AtlasPasses::gather(const cl::CommandQueue& queue, const FillParams& params,
                              const SiteBuffers& b, const cl::Buffer& texels,
                              const cl::Buffer& seen, const cl::Buffer& gathered,
                              const cl::Buffer& filled, const WaitList& wait) const {
    need_gather(gather_, params, b, texels, GBUFFER_NORMAL + 3, gathered, filled);
    need(gather_, "seen", seen,
         seen_rows(params.flags & FILL_KEPT ? b.site_count : params.shooter_count) * params.stride);
    return launch(gather_, queue, packets(gather_, texels_left(gather_, params)), wait, params,
                  b.list, b.listed, b.sites, b.planes, b.site_power, b.samples, b.sample_power,
                  texels, seen, gathered, filled);
}

cl::Event AtlasPasses::gather_open(const cl::CommandQueue& queue, const FillParams& params,
                                   const SiteBuffers& b, const cl::Buffer& texels,
                                   const cl::Buffer& gathered, const cl::Buffer& filled,
                                   const WaitList& wait) const {
    need_gather(gather_open_, params, b, texels, GBUFFER_GEOMETRIC + 3, gathered, filled);
    return launch(gather_open_, queue, packets(gather_open_, texels_left(gather_open_, params)),
                  wait, params, b.list, b.listed, b.sites, b.planes, b.site_power, b.samples,
                  b.sample_power, texels, gathered, filled);
}

cl::Event AtlasPasses::geometry(const cl::CommandQueue& queue, const MeshParams& params,
                                const DeviceScene& scene, const cl::Buffer& views,
                                const cl::Buffer& visibility, const MeshBuffers& mesh,
                                const WaitList& wait) const {
    need_mesh(geometry_, params);
    const std::size_t triangles = scene.info().triangle_count;
    need(geometry_, "views", views, 5 * std::size_t{params.shooter_count} * sizeof(View));
    need(geometry_, "visibility", visibility, hemicube_bytes(params));
    need(geometry_, "uvs", mesh.uvs, 3 * triangles * 2 * word);
    need(geometry_, "charts", mesh.charts, triangles * word);
    need(geometry_, "corners", mesh.corners, mesh_corners(params) * sizeof(MeshCorner));
    return launch(geometry_, queue, mesh_corners(params), wait, params, views, visibility,
                  scene.triangles(), scene.positions(), mesh.uvs, mesh.charts, mesh.corners);
}

cl::Event AtlasPasses::replicate(const cl::CommandQueue& queue, const MeshParams& params,
                                 const MeshBuffers& mesh, const WaitList& wait) const {
    need_mesh(replicate_, params);
    need(replicate_, "corners", mesh.corners, mesh_corners(params) * sizeof(MeshCorner));
    need(replicate_, "boxes", mesh.boxes, mesh.chart_count * 4 * word);
    need(replicate_, "copies", mesh.copies,
         MESH_COPIES * mesh_triangles(params) * sizeof(MeshCopy));
    return launch(replicate_, queue, mesh_triangles(params), wait, params, mesh.corners, mesh.boxes,
                  mesh.copies);
}

cl::Event AtlasPasses::project(const cl::CommandQueue& queue, const FillParams& params,
                               const MeshParams& mesh_params, const SiteBuffers& b,
                               const cl::Buffer& views, const cl::Buffer& visibility,
                               const MeshBuffers& mesh, const cl::Buffer& texels,
                               const cl::Buffer& gathered, const cl::Buffer& filled,
                               const WaitList& wait) const {
    need_mesh(project_, mesh_params);
    need_senders(project_, params, b);
    need(project_, "chosen", b.chosen, last_shooter(params) * word);
    need(project_, "views", views, 5 * std::size_t{params.shooter_count} * sizeof(View));
    if (mesh_params.shooter_count < params.shooter_count)
        throw Error(project_.name + ": the mesh has " + std::to_string(mesh_params.shooter_count) +
                    " hemicubes, " + std::to_string(params.shooter_count) + " needed");
    if (mesh_params.reach < 0)
        throw Error(project_.name + ": reach is " + std::to_string(mesh_params.reach) +
                    ", 0 or more needed");
    need(project_, "visibility", visibility, hemicube_bytes(mesh_params));
    need(project_, "copies", mesh.copies,
         MESH_COPIES * mesh_triangles(mesh_params) * sizeof(MeshCopy));
    need(project_, "texels", texels, (GBUFFER_GEOMETRIC + 3) * word * params.stride);
    need(project_, "places", mesh.places, PLACE_PLANES * word * params.stride);
    need(project_, "gathered", gathered, 3 * word * params.stride);
    need(project_, "filled", filled, word * params.stride);
    return launch(project_, queue, texels_left(project_, params), wait, params, mesh_params,
                  b.chosen, views, visibility, mesh.copies, b.sites, b.planes, b.site_power,
                  b.samples, b.sample_power, texels, mesh.places, gathered, filled);
}

cl::Event AtlasPasses::nearest(const cl::CommandQueue& queue, const FillParams& params,
                               const SiteBuffers& b, const cl::Buffer& texels,
                               const cl::Buffer& reach, const WaitList& wait) const {
    need_texels(nearest_, params.stride, params.texel_count);
    need(nearest_, "planes", b.planes, SITE_PLANES * word * params.site_stride);
    need(nearest_, "balance", b.balance, BALANCE_PLANES * word * params.site_stride);
    need(nearest_, "texels", texels, (GBUFFER_GEOMETRIC + 3) * word * params.stride);
    need(nearest_, "reach", reach, word * params.stride);
    return launch(nearest_, queue, packets(nearest_, texels_left(nearest_, params)), wait, params,
                  b.planes, b.balance, texels, reach);
}

cl::Event AtlasPasses::complete(const cl::CommandQueue& queue, const FillParams& params,
                                const cl::Buffer& reach, const cl::Buffer& filled,
                                const cl::Buffer& gathered, const cl::Buffer& irradiance,
                                const cl::Buffer& non_finite, const WaitList& wait) const {
    need_texels(complete_, params.stride, params.texel_count);
    need(complete_, "reach", reach, word * params.stride);
    need(complete_, "filled", filled, word * params.stride);
    need(complete_, "gathered", gathered, 3 * word * params.stride);
    need(complete_, "irradiance", irradiance, 3 * word * params.stride);
    need(complete_, "non_finite", non_finite, word);
    return launch(complete_, queue, packets(complete_, texels_left(complete_, params)), wait,
                  params, reach, filled, gathered, irradiance, non_finite);
}

cl::Event AtlasPasses::show(const cl::CommandQueue& queue, const ShowParams& params,
                            const DeviceScene& scene, const GBuffer& points, const AtlasMap& map,
                            const cl::Buffer& light, const cl::Buffer& irradiance,
                            const WaitList& wait) const {
    const std::size_t triangles = params.triangle_count;
    need_stride(show_, "stride", params.stride, params.point_count);
    if (triangles > scene.info().triangle_count)
        throw Error(show_.name + ": triangle_count is " + std::to_string(triangles) +
                    ", the scene has " + std::to_string(scene.info().triangle_count));
    if (params.texel_stride < params.texel_count)
        throw Error(show_.name + ": texel_stride is " + std::to_string(params.texel_stride) +
                    ", at least " + std::to_string(params.texel_count) + " needed");
    need_countable(show_.name, "planes", GBUFFER_PLANES, params.stride);
    need_countable(show_.name, "map", std::max(params.pages, 1u),
                   std::size_t{params.size} * params.size);
    need_countable(show_.name, "light", 3, params.texel_stride);
    need(show_, "planes", points.planes, gbuffer_bytes(storage_, params.stride));
    need(show_, "ids", points.ids, GBUFFER_ID_PLANES * word * params.stride);
    need(show_, "corners", map.corners, 3 * triangles * 2 * word);
    need(show_, "charts", map.charts, triangles * 2 * word);
    need(show_, "map", map.map, std::size_t{params.pages} * params.size * params.size * word);
    need(show_, "chart_of", map.chart_of, params.texel_count * word);
    need(show_, "light", light, 3 * word * params.texel_stride);
    need(show_, "irradiance", irradiance, irradiance_bytes(storage_, params.stride));
    return launch(show_, queue, params.point_count, wait, params, scene.triangles(),
                  scene.positions(), points.planes, points.ids, map.corners, map.charts, map.map,
                  map.chart_of, light, irradiance);
}

cl::Event AtlasPasses::volume(const cl::CommandQueue& queue, const VolumeParams& params,
                              const GBuffer& points, const cl::Buffer& charts,
                              const VolumeBuffers& grid, const cl::Buffer& light,
                              const cl::Buffer& irradiance, const WaitList& wait) const {
    need_stride(volume_, "stride", params.stride, params.point_count);
    const std::size_t places = std::size_t{params.columns} * params.rows * params.layers;
    if (places == 0) throw Error(volume_.name + ": the grid has no point");
    const float4& origin = params.origin;
    if (!std::isfinite(origin.x + origin.y + origin.z + origin.w))
        throw Error(volume_.name + ": the grid's origin or spacing is not finite");
    const std::size_t lit = VOLUME_DIRECTIONS * std::size_t{params.open_count};
    if (params.light_stride < params.first + lit)
        throw Error(volume_.name + ": light_stride is " + std::to_string(params.light_stride) +
                    ", at least " + std::to_string(params.first + lit) + " needed");
    need(volume_, "planes", points.planes, gbuffer_bytes(storage_, params.stride));
    need(volume_, "ids", points.ids, GBUFFER_ID_PLANES * word * params.stride);
    need(volume_, "charts", charts, std::size_t{params.triangle_count} * 2 * word);
    need(volume_, "places", grid.places, places * sizeof(float4));
    need(volume_, "distances", grid.distances,
         2 * word * VOLUME_TEXELS * std::size_t{params.open_count});
    need(volume_, "light", light, 3 * word * params.light_stride);
    need(volume_, "irradiance", irradiance, irradiance_bytes(storage_, params.stride));
    return launch(volume_, queue, params.point_count, wait, params, points.planes, points.ids,
                  charts, grid.places, grid.distances, light, irradiance);
}

}  // namespace clgi
