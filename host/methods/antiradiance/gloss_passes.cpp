// SPDX-License-Identifier: MIT
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/antiradiance_gloss.hpp>

#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"
#include "methods/antiradiance/linked.hpp"
#include "shading/lights/emitter_buffers.hpp"

namespace clgi {
namespace {

std::size_t albedo_bytes(const DeviceScene& scene) {
    return scene.materials().getInfo<CL_MEM_SIZE>() / sizeof(MaterialRecord) * (ALBEDO_STEPS + 1) *
           sizeof(float);
}

}  // namespace

AntiradianceGlossPasses::AntiradianceGlossPasses(const Programs& programs, int bins,
                                                 const BuildOptions& options)
    : bins_(bins) {
    need_bins(bins);
    const std::string defines = "-DCLGI_BINS=" + std::to_string(bins);
    const auto kernel = [&](const char* pass, const BuildOptions& how) {
        return in_small_groups(programs.kernel("antiradiance", pass, how, defines),
                               programs.device(), options);
    };
    // A group keeps 34 bytes a bin, and 1.8 KB of links, in local memory; OpenCL 1.2 promises 32
    // KB.
    constexpr int most_local_bins = 512;
    grouped_ = in_groups(programs.device(), options) && bins <= most_local_bins;
    const auto of_leaves = [&](const char* pass, BuildOptions how) {
        if (!grouped_) return kernel(pass, how);
        how.packet_width = 1;
        return group_form(programs, "antiradiance", pass, how, defines, 64, 64);
    };
    lobes_ = of_leaves("lobes", full(options));
    sources_ = kernel("gloss_sources", full(options));
    gloss_ = of_leaves("gloss", options);
    vertices_ = kernel("gloss_vertices", full(options));
    show_ = kernel("show_gloss", options);
}

void AntiradianceGlossPasses::build(std::initializer_list<const char*> passes) const {
    build_named({lobes_, sources_, gloss_, vertices_, show_}, passes);
}

std::size_t AntiradianceGlossPasses::row_bytes() const { return gloss_row_bytes(bins_); }

cl::Event AntiradianceGlossPasses::lobes(const cl::CommandQueue& queue, const LinkBuffers& links,
                                         const GlossBuffers& gloss, const WaitList& wait) const {
    const auto m = static_cast<std::size_t>(bins_);
    need(lobes_, "leaves", gloss.leaves, gloss.count * sizeof(GlossyLeaf));
    need(lobes_, "elements", links.elements, links.element_count * sizeof(Element));
    need(lobes_, "bins", gloss.bins, row_bytes() / 3 * 4);
    need(lobes_, "albedos", gloss.albedos, (ALBEDO_STEPS + 1) * sizeof(float));
    need(lobes_, "factors", gloss.factors, gloss.count * m * sizeof(float));
    return launch(lobes_, queue, gloss.count * items_each(lobes_, grouped_), wait,
                  ElementParams{0, gloss.count, 0, 0}, gloss.leaves, links.elements, gloss.bins,
                  gloss.albedos, gloss.factors);
}

cl::Event AntiradianceGlossPasses::sources(const cl::CommandQueue& queue,
                                           const GlossSourceParams& params,
                                           const DeviceScene& scene, const GBuffer& points,
                                           const EmitterBuffers& lights, const LinkBuffers& links,
                                           const GlossBuffers& gloss, const WaitList& wait) const {
    if (params.samples == 0 || params.leaf_count != gloss.count)
        throw Error(sources_.name + ": " + std::to_string(params.samples) + " samples of " +
                    std::to_string(params.leaf_count) + " leaves; at least 1 of " +
                    std::to_string(gloss.count) + " needed");
    need_stride(sources_, "point_stride", params.point_stride,
                std::size_t{links.leaf_count} * params.samples);
    need_depth_words(sources_, params.depth_words, lights.kind);
    need_emitters(sources_, lights, params.emitter_count);
    need(sources_, "leaves", gloss.leaves, gloss.count * sizeof(GlossyLeaf));
    need(sources_, "elements", links.elements, links.element_count * sizeof(Element));
    need(sources_, "bins", gloss.bins, row_bytes() / 3 * 4);
    need(sources_, "albedos", gloss.albedos, albedo_bytes(scene));
    need(sources_, "planes", points.planes, gbuffer_bytes(sources_.storage, params.point_stride));
    need(sources_, "colors", gloss.colors, gloss.count * sizeof(glm::vec4));
    need(sources_, "sources", gloss.sources, gloss.count * row_bytes());
    const std::size_t together =
        std::max<std::size_t>(1, static_cast<std::size_t>(sources_.packet_width) / params.samples);
    return launch(sources_, queue, (gloss.count + together - 1) / together, wait, params,
                  gloss.leaves, links.elements, gloss.bins, gloss.albedos, scene.materials(),
                  points.planes, lights.emitters, lights.views, lights.visibility, gloss.colors,
                  gloss.sources);
}

cl::Event AntiradianceGlossPasses::gloss(const cl::CommandQueue& queue, std::uint32_t step,
                                         const LinkBuffers& links, const ElementRows& rows,
                                         const cl::Buffer& directions, const LeafBuffers& leaves,
                                         const GlossBuffers& gloss, const WaitList& wait) const {
    const auto m = static_cast<std::size_t>(bins_);
    need(gloss_, "leaves", gloss.leaves, gloss.count * sizeof(GlossyLeaf));
    need(gloss_, "elements", links.elements, links.element_count * sizeof(Element));
    need_linked(gloss_, bins_, links, rows);
    need_leaves(gloss_, bins_, links, rows, directions, leaves);
    need(gloss_, "bins", gloss.bins, row_bytes() / 3 * 4);
    need(gloss_, "factors", gloss.factors, gloss.count * m * sizeof(float));
    need(gloss_, "colors", gloss.colors, gloss.count * sizeof(glm::vec4));
    need(gloss_, "sources", gloss.sources, gloss.count * row_bytes());
    need(gloss_, "arriving", gloss.arriving, gloss.count * row_bytes());
    return launch(gloss_, queue, gloss.count * items_each(gloss_, grouped_), wait,
                  ElementParams{0, gloss.count, step, 0}, gloss.leaves, Linked{links, rows},
                  rows.incident, directions, Lit{leaves}, gloss.bins, gloss.factors, gloss.colors,
                  gloss.sources, gloss.arriving, rows.next_powers, rows.next);
}

cl::Event AntiradianceGlossPasses::vertices(const cl::CommandQueue& queue,
                                            const GlossBuffers& gloss, const WaitList& wait) const {
    need(vertices_, "first_leaves", gloss.first_leaves,
         (std::size_t{gloss.vertex_count} + 1) * word);
    need(vertices_, "vertex_leaves", gloss.vertex_leaves, 2 * word);
    need(vertices_, "arriving", gloss.arriving, gloss.count * row_bytes());
    need(vertices_, "light", gloss.light, gloss.vertex_count * row_bytes());
    return launch(vertices_, queue, gloss.vertex_count, wait,
                  ElementParams{0, gloss.vertex_count, 0, 0}, gloss.first_leaves,
                  gloss.vertex_leaves, gloss.arriving, gloss.light);
}

cl::Event AntiradianceGlossPasses::show(const cl::CommandQueue& queue,
                                        const ShowGlossParams& params, const DeviceScene& scene,
                                        const LinkBuffers& links, const LeafSurface& surface,
                                        const GlossBuffers& gloss, const GBuffer& seen,
                                        const cl::Buffer& radiance, const cl::Buffer& non_finite,
                                        const WaitList& wait) const {
    need_stride(show_, "pixel_stride", params.pixel_stride, params.pixel_count);
    need_shown(show_, params.triangle_count, params.element_count, scene, links, surface);
    need(show_, "rows", gloss.rows, surface.vertex_count * word);
    need(show_, "bins", gloss.bins, row_bytes() / 3 * 4);
    need(show_, "albedos", gloss.albedos, albedo_bytes(scene));
    need(show_, "light", gloss.light, gloss.vertex_count * row_bytes());
    need(show_, "planes", seen.planes, gbuffer_bytes(show_.storage, params.pixel_stride));
    need(show_, "ids", seen.ids, GBUFFER_ID_PLANES * word * params.pixel_stride);
    need(show_, "radiance", radiance, 3 * sizeof(float) * params.pixel_stride);
    need(show_, "non_finite", non_finite, word);
    return launch(show_, queue, params.pixel_count, wait, params, scene.triangles(),
                  scene.positions(), scene.materials(), surface.roots, links.elements,
                  surface.patches, gloss.rows, gloss.bins, gloss.albedos, gloss.light, seen.planes,
                  seen.ids, radiance, non_finite);
}

std::vector<float> direction_planes(const std::vector<glm::vec4>& rows) {
    const std::size_t stride = GLOSS_STRIDE(rows.size());
    std::vector<float> out(4 * stride, 0.0f);
    for (std::size_t bin = 0; bin < rows.size(); ++bin)
        for (int c = 0; c < 4; ++c) out[static_cast<std::size_t>(c) * stride + bin] = rows[bin][c];
    return out;
}

}  // namespace clgi
