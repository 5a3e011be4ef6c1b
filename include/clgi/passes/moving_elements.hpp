// Elements and links that follow geometry that moved; one method per kernel. Structs and words:
// clgi/shared/moving_elements.h. Rules for all methods: clgi/passes/gbuffer.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/moving_elements.h>
#include <clgi/passes/antiradiance.hpp>
#include <initializer_list>

namespace clgi {

// What moves, and where all elements are.
struct MovingElements {
    cl::Buffer places;   // [element_count] ElementPlace
    cl::Buffer patches;  // [element_count] PatchCorners, as of LeafSurface
    cl::Buffer list;   // uint: elements that move; patches, then clusters from the lowest level up
    cl::Buffer links;  // [link_count] uint2: moving links, none of which reads powers; one at least
    cl::Buffer senders;  // [link_count] uint: the elements that they begin at; one at least
    std::uint32_t link_count = 0;
};

class CLGI_API MovingElementPasses {
public:
    // bins: DirectionBins::count().
    MovingElementPasses(const Programs& programs, int bins, const BuildOptions& options = {});

    void build(std::initializer_list<const char*> passes) const;

    // Patches of moving.list -> their places and elements. directions: of direction_rows().
    cl::Event refit(const cl::CommandQueue& queue, const ElementParams& params,
                    const DeviceScene& scene, const MovingElements& moving,
                    const LinkBuffers& links, const cl::Buffer& directions,
                    const WaitList& wait = {}) const;

    // Clusters of one level of moving.list, whose children are done -> their places.
    cl::Event refit_clusters(const cl::CommandQueue& queue, const ElementParams& params,
                             const MovingElements& moving, const LinkBuffers& links,
                             const WaitList& wait = {}) const;

    // All moving.links -> links.bins and links.form_factors of these.
    cl::Event relink(const cl::CommandQueue& queue, const DeviceScene& scene,
                     const MovingElements& moving, const LinkBuffers& links,
                     const cl::Buffer& directions, const WaitList& wait = {}) const;

private:
    int bins_;
    PassKernel refit_, refit_clusters_, relink_;
};

}  // namespace clgi
