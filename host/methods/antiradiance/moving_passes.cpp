// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/passes/moving_elements.hpp>
#include <cmath>

#include "core/opencl/launch.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/variants.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

void need_places(const PassKernel& pass, const MovingElements& moving, const LinkBuffers& links) {
    need(pass, "places", moving.places, links.element_count * sizeof(ElementPlace));
    need(pass, "elements", links.elements, links.element_count * sizeof(Element));
}

void need_list(const PassKernel& pass, const ElementParams& params, const MovingElements& moving) {
    need(pass, "list", moving.list, (std::size_t{params.first} + params.count) * word);
}

}  // namespace

MovingElementPasses::MovingElementPasses(const Programs& programs, int bins,
                                         const BuildOptions& options)
    : bins_(bins) {
    if (bins < 32 || bins > 4096 || bins % 4 != 0)
        throw Error("antiradiance: bins is " + std::to_string(bins) +
                    ", a multiple of 4 from 32 to 4096 needed");
    const std::string defines = "-DCLGI_BINS=" + std::to_string(bins);
    refit_ = programs.kernel("antiradiance", "refit", scalar(options), defines);
    refit_clusters_ = programs.kernel("antiradiance", "refit_clusters", scalar(options));
    relink_ = programs.kernel("antiradiance", "relink", full(options), defines);
}

void MovingElementPasses::build(std::initializer_list<const char*> passes) const {
    build_named({refit_, refit_clusters_, relink_}, passes);
}

cl::Event MovingElementPasses::refit(const cl::CommandQueue& queue, const ElementParams& params,
                                     const DeviceScene& scene, const MovingElements& moving,
                                     const LinkBuffers& links, const cl::Buffer& directions,
                                     const WaitList& wait) const {
    need_list(refit_, params, moving);
    need_places(refit_, moving, links);
    need(refit_, "patches", moving.patches, links.element_count * sizeof(PatchCorners));
    need(refit_, "directions", directions, static_cast<std::size_t>(bins_) * sizeof(glm::vec4));
    return launch(refit_, queue, params.count, wait, params, moving.list, moving.patches,
                  scene.triangles(), scene.positions(), directions, moving.places, links.elements);
}

cl::Event MovingElementPasses::refit_clusters(const cl::CommandQueue& queue,
                                              const ElementParams& params,
                                              const MovingElements& moving,
                                              const LinkBuffers& links,
                                              const WaitList& wait) const {
    need_list(refit_clusters_, params, moving);
    need_places(refit_clusters_, moving, links);
    return launch(refit_clusters_, queue, params.count, wait, params, moving.list, links.elements,
                  moving.places);
}

cl::Event MovingElementPasses::relink(const cl::CommandQueue& queue, const DeviceScene& scene,
                                      const MovingElements& moving, const LinkBuffers& links,
                                      const cl::Buffer& directions, const WaitList& wait) const {
    const std::size_t all = std::max<std::size_t>(links.link_count, 1);
    need(relink_, "links", moving.links, std::max<std::size_t>(moving.link_count, 1) * 2 * word);
    need_places(relink_, moving, links);
    need(relink_, "patches", moving.patches, links.element_count * sizeof(PatchCorners));
    need(relink_, "directions", directions, static_cast<std::size_t>(bins_) * sizeof(glm::vec4));
    need(relink_, "senders", moving.senders, std::max<std::size_t>(moving.link_count, 1) * word);
    need(relink_, "bins", links.bins, all * word / 2);
    need(relink_, "form_factors", links.form_factors, all * word);
    // Twice the mean spacing of bins, as links of what stands still have it.
    const double farthest = std::cos(2.0 * std::sqrt(4.0 * 3.14159265358979323846 / bins_));
    const RelinkParams params{moving.link_count, static_cast<float>(farthest), 0, 0};
    return launch(relink_, queue, packets(relink_, moving.link_count), wait, params, moving.links,
                  moving.places, moving.patches, scene.triangles(), scene.positions(), directions,
                  moving.senders, links.bins, links.form_factors);
}

}  // namespace clgi
