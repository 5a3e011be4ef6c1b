// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/antiradiance.hpp>

#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"
#include "methods/antiradiance/linked.hpp"

namespace clgi {
namespace {

// A group keeps 20 bytes a bin, and 1.6 KB of links, in local memory; OpenCL 1.2 promises 32 KB.
constexpr int most_local_bins = 1024;

void need_list(const PassKernel& pass, const ElementParams& params, const cl::Buffer& list,
               const LinkBuffers& links) {
    need(pass, "list", list, (std::size_t{params.first} + params.count) * word);
    need(pass, "elements", links.elements, links.element_count * sizeof(Element));
}

void need_points(const PassKernel& pass, const LeafPointParams& params) {
    if (params.samples == 0 || params.first_back > params.leaf_count)
        throw Error(pass.name + ": " + std::to_string(params.samples) + " samples a leaf and " +
                    std::to_string(params.first_back) + " of " + std::to_string(params.leaf_count) +
                    " leaves in front; at least 1 and at most all needed");
    need_stride(pass, "stride", params.stride, std::size_t{params.leaf_count} * params.samples);
}

}  // namespace

AntiradiancePasses::AntiradiancePasses(const Programs& programs, int bins,
                                       const BuildOptions& options)
    : bins_(bins) {
    need_bins(bins);
    BuildOptions one = options;
    one.packet_width = 1;
    const std::string defines = "-DCLGI_BINS=" + std::to_string(bins);
    const auto kernel = [&](const char* pass) {
        return in_small_groups(
            programs.kernel("antiradiance", pass, one, defines, {"global", "local", "pull"}),
            programs.device(), options);
    };
    const bool groups = in_groups(programs.device(), options);
    rows_in_groups_ = groups && bins <= most_local_bins;
    const auto with_rows = [&](const char* pass) {
        return rows_in_groups_ ? group_form(programs, "antiradiance", pass, one, defines, 32, 64)
                               : kernel(pass);
    };
    global_ = with_rows("global");
    local_ = with_rows("local");
    items_ = groups ? static_cast<std::size_t>(bins) / 4 : 1;
    pull_ = groups ? programs.kernel("antiradiance", "pull", one, defines + " -DCLGI_GROUPS")
                   : kernel("pull");
    const auto plain = [&](const char* pass, const BuildOptions& how) {
        return programs.kernel("antiradiance", pass, how);
    };
    turn_ = plain("turn", scalar(options));
    sources_ = plain("sources", scalar(options));
    vertices_ = plain("vertices", scalar(options));
    show_ = plain("show", one);
}

void AntiradiancePasses::build(std::initializer_list<const char*> passes) const {
    build_named({global_, local_, pull_, turn_, sources_, vertices_, show_}, passes);
}

std::size_t AntiradiancePasses::intensity_bytes(std::size_t rows) const {
    return bytes_of_rows(local_.storage, bins_, rows);
}

cl::Event AntiradiancePasses::global(const cl::CommandQueue& queue, const ElementParams& params,
                                     const cl::Buffer& list, const LinkBuffers& links,
                                     const ElementRows& rows, const WaitList& wait) const {
    need_list(global_, params, list, links);
    need_linked(global_, bins_, links, rows);
    need(global_, "exitant", rows.exitant, intensity_bytes(links.row_count));
    return launch(global_, queue, params.count * items_each(global_, rows_in_groups_), wait, params,
                  list, Linked{links, rows}, rows.incident);
}

cl::Event AntiradiancePasses::local(const cl::CommandQueue& queue, const ElementParams& params,
                                    const cl::Buffer& list, const LinkBuffers& links,
                                    const ElementRows& rows, const cl::Buffer& directions,
                                    const LeafBuffers& leaves, const WaitList& wait) const {
    need_list(local_, params, list, links);
    need_linked(local_, bins_, links, rows);
    need_leaves(local_, bins_, links, rows, directions, leaves);
    return launch(local_, queue, params.count * items_each(local_, rows_in_groups_), wait, params,
                  list, Linked{links, rows}, rows.incident, directions, Lit{leaves},
                  rows.next_powers, rows.next);
}

cl::Event AntiradiancePasses::pull(const cl::CommandQueue& queue, const ElementParams& params,
                                   const cl::Buffer& list, const LinkBuffers& links,
                                   const ElementRows& rows, const WaitList& wait) const {
    need_list(pull_, params, list, links);
    need(pull_, "next_powers", rows.next_powers, links.element_count * sizeof(glm::vec4));
    need(pull_, "next", rows.next, intensity_bytes(links.row_count));
    return launch(pull_, queue, std::size_t{params.count} * items_, wait, params, list,
                  links.elements, rows.next_powers, rows.next);
}

cl::Event AntiradiancePasses::turn(const cl::CommandQueue& queue, const LeafPointParams& params,
                                   const cl::Buffer& planes, const WaitList& wait) const {
    need_points(turn_, params);
    need(turn_, "planes", planes, gbuffer_bytes(turn_.storage, params.stride, GBUFFER_BASE));
    return launch(turn_, queue, std::size_t{params.leaf_count - params.first_back} * params.samples,
                  wait, params, planes);
}

cl::Event AntiradiancePasses::sources(const cl::CommandQueue& queue, const LeafPointParams& params,
                                      const DeviceScene& scene, const GBuffer& points,
                                      const cl::Buffer& irradiance, const LeafBuffers& leaves,
                                      const WaitList& wait) const {
    need_points(sources_, params);
    need(sources_, "planes", points.planes, gbuffer_bytes(sources_.storage, params.stride));
    need(sources_, "ids", points.ids, GBUFFER_ID_PLANES * word * params.stride);
    need(sources_, "irradiance", irradiance, irradiance_bytes(sources_.storage, params.stride));
    need(sources_, "sources", leaves.sources, params.leaf_count * sizeof(glm::vec4));
    need(sources_, "reflectances", leaves.reflectances, params.leaf_count * sizeof(glm::vec4));
    return launch(sources_, queue, params.leaf_count, wait, params, points.planes, points.ids,
                  irradiance, scene.materials(), leaves.sources, leaves.reflectances);
}

cl::Event AntiradiancePasses::vertices(const cl::CommandQueue& queue, const LeafSurface& surface,
                                       const LeafBuffers& leaves, const WaitList& wait) const {
    const std::size_t count = surface.vertex_count;
    need(vertices_, "first_leaves", surface.first_leaves, (count + 1) * word);
    need(vertices_, "vertex_leaves", surface.vertex_leaves, 2 * word);
    need(vertices_, "irradiances", leaves.irradiances, sizeof(glm::vec4));
    need(vertices_, "light", surface.light, count * sizeof(glm::vec4));
    const ElementParams params{0, surface.vertex_count, 0, 0};
    return launch(vertices_, queue, count, wait, params, surface.first_leaves,
                  surface.vertex_leaves, leaves.irradiances, surface.light);
}

cl::Event AntiradiancePasses::show(const cl::CommandQueue& queue, const ShowElementsParams& params,
                                   const DeviceScene& scene, const LinkBuffers& links,
                                   const LeafSurface& surface, const GBuffer& seen,
                                   const cl::Buffer& shown, const WaitList& wait) const {
    need_stride(show_, "pixel_stride", params.pixel_stride, params.pixel_count);
    need_shown(show_, params.triangle_count, params.element_count, scene, links, surface);
    need(show_, "planes", seen.planes,
         gbuffer_bytes(show_.storage, params.pixel_stride, GBUFFER_BASE));
    need(show_, "ids", seen.ids, GBUFFER_ID_PLANES * word * params.pixel_stride);
    need(show_, "light", surface.light, surface.vertex_count * sizeof(glm::vec4));
    need(show_, "shown", shown, irradiance_bytes(show_.storage, params.pixel_stride));
    return launch(show_, queue, params.pixel_count, wait, params, scene.triangles(),
                  scene.positions(), surface.roots, links.elements, surface.patches, seen.planes,
                  seen.ids, surface.light, shown);
}

std::vector<glm::vec4> direction_rows(const DirectionBins& bins) {
    std::vector<glm::vec4> out;
    for (std::size_t i = 0; i < bins.directions.size(); ++i)
        out.emplace_back(glm::vec3(bins.directions[i]), static_cast<float>(bins.solid_angles[i]));
    return out;
}

}  // namespace clgi
