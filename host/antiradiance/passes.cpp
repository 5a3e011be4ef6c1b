// SPDX-License-Identifier: MIT
#include <clgi/passes/antiradiance.hpp>

#include "opencl/launch.hpp"
#include "opencl/program.hpp"

namespace clgi {
namespace {

constexpr std::size_t word = sizeof(std::uint32_t);
constexpr std::size_t color = sizeof(glm::vec4);

// LINK_ARGUMENTS of kernels/antiradiance/rows.clh.
struct Linked {
    const LinkBuffers& links;
    const ElementRows& rows;
};
void set_argument(cl::Kernel& kernel, cl_uint& index, const Linked& from) {
    const LinkBuffers& l = from.links;
    for (const cl::Buffer* buffer : {&l.elements, &l.first_links, &l.senders, &l.bins,
                                     &l.form_factors, &from.rows.sky, &from.rows.exitant})
        kernel.setArg(index++, *buffer);
}

void need_list(const PassKernel& pass, const ElementParams& params, const cl::Buffer& list,
               const LinkBuffers& links) {
    need(pass, "list", list, (std::size_t{params.first} + params.count) * word);
    need(pass, "elements", links.elements, links.element_count * sizeof(Element));
}

void need_linked(const PassKernel& pass, int bins, const LinkBuffers& l, const ElementRows& rows) {
    const auto row = static_cast<std::size_t>(bins) * color;
    need(pass, "first_links", l.first_links, (std::size_t{l.element_count} + 1) * word);
    const std::size_t count = std::max<std::size_t>(l.link_count, 1);
    need(pass, "senders", l.senders, count * word);
    need(pass, "bins", l.bins, count * word / 2);
    need(pass, "form_factors", l.form_factors, count * word);
    need(pass, "sky", rows.sky, row);
    need(pass, "incident", rows.incident, std::max<std::size_t>(l.inner_count, 1) * row);
}

}  // namespace

AntiradiancePasses::AntiradiancePasses(const Programs& programs, int bins,
                                       const BuildOptions& options)
    : bins_(bins) {
    if (bins < 32 || bins > 4096 || bins % 2 != 0)
        throw Error("antiradiance: bins is " + std::to_string(bins) +
                    ", an even number from 32 to 4096 needed");
    BuildOptions one = options;
    one.packet_width = 1;
    const std::string defines = "-DCLGI_BINS=" + std::to_string(bins);
    const auto kernel = [&](const char* pass) {
        return in_small_groups(programs.kernel("antiradiance", pass, one, defines),
                               programs.device(), options);
    };
    global_ = kernel("global");
    local_ = kernel("local");
    pull_ = kernel("pull");
}

void AntiradiancePasses::build(std::initializer_list<const char*> passes) const {
    build_named({global_, local_, pull_}, passes);
}

std::size_t AntiradiancePasses::intensity_bytes(std::size_t elements) const {
    return elements * static_cast<std::size_t>(bins_) *
           (local_.storage == Storage::half ? color / 2 : color);
}

cl::Event AntiradiancePasses::global(const cl::CommandQueue& queue, const ElementParams& params,
                                     const cl::Buffer& list, const LinkBuffers& links,
                                     const ElementRows& rows, const WaitList& wait) const {
    need_list(global_, params, list, links);
    need_linked(global_, bins_, links, rows);
    need(global_, "exitant", rows.exitant, intensity_bytes(links.element_count));
    return launch(global_, queue, params.count, wait, params, list, Linked{links, rows},
                  rows.incident);
}

cl::Event AntiradiancePasses::local(const cl::CommandQueue& queue, const ElementParams& params,
                                    const cl::Buffer& list, const LinkBuffers& links,
                                    const ElementRows& rows, const cl::Buffer& directions,
                                    const LeafBuffers& leaves, const WaitList& wait) const {
    need_list(local_, params, list, links);
    need_linked(local_, bins_, links, rows);
    need(local_, "exitant", rows.exitant, intensity_bytes(links.element_count));
    need(local_, "next", rows.next, intensity_bytes(links.element_count));
    need(local_, "directions", directions, static_cast<std::size_t>(bins_) * color);
    need(local_, "sources", leaves.sources, links.leaf_count * color);
    need(local_, "reflectances", leaves.reflectances, links.leaf_count * color);
    need(local_, "radiances", leaves.radiances, links.leaf_count * color);
    need(local_, "irradiances", leaves.irradiances, links.leaf_count * color);
    need(local_, "changes", leaves.changes, links.leaf_count * color);
    need(local_, "non_finite", leaves.non_finite, word);
    return launch(local_, queue, params.count, wait, params, list, Linked{links, rows},
                  rows.incident, directions, leaves.sources, leaves.reflectances, leaves.radiances,
                  leaves.irradiances, leaves.changes, leaves.non_finite, rows.next);
}

cl::Event AntiradiancePasses::pull(const cl::CommandQueue& queue, const ElementParams& params,
                                   const cl::Buffer& list, const LinkBuffers& links,
                                   const ElementRows& rows, const WaitList& wait) const {
    need_list(pull_, params, list, links);
    need(pull_, "next", rows.next, intensity_bytes(links.element_count));
    return launch(pull_, queue, params.count, wait, params, list, links.elements, rows.next);
}

std::vector<glm::vec4> direction_rows(const DirectionBins& bins) {
    std::vector<glm::vec4> out;
    for (std::size_t i = 0; i < bins.directions.size(); ++i)
        out.emplace_back(glm::vec3(bins.directions[i]), static_cast<float>(bins.solid_angles[i]));
    return out;
}

}  // namespace clgi
