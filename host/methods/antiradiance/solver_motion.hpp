// What AntiradianceSolver has for geometry that moves: lists of the elements and links that follow
// it, and the passes that bring them there.                    [Dachsbacher07, section 3.3]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/buffer_table.hpp>
#include <clgi/advanced/kit/recorder.hpp>
#include <clgi/advanced/links.hpp>
#include <clgi/passes/moving_elements.hpp>
#include <vector>

#include "methods/antiradiance/device_links.hpp"
#include "methods/antiradiance/element_surface.hpp"

namespace clgi {

// Rows for these buffers, of a tree with elements that move and so many links that do.
void add_moving(BufferTable& table, MovingElements& moving, const ElementTree& tree,
                std::size_t moving_links);

class AntiradianceMotion {
public:
    // poses: the tree in each, at least one. elements: of the device.
    AntiradianceMotion(const Programs& programs, const BuildOptions& options,
                       const ElementTree& tree, const std::vector<ElementTree>& poses,
                       const DirectionBins& bins, const Scene& scene, const DeviceScene& device,
                       const DeviceLinks& links, const std::vector<Element>& elements);

    void add_to(BufferTable& table, const ElementTree& tree);
    void build() const;
    // patches: of LeafSurface.
    void write(Recorder& record, const cl::Buffer& patches);

    // Enqueues what brings elements and links to where the scene's vertices are.
    void follow(Recorder& record, const DeviceScene& scene, const LinkBuffers& links,
                const cl::Buffer& directions) const;

    std::size_t element_count() const { return element_count_; }
    std::size_t link_count() const { return moving_.link_count; }

private:
    MovingElementPasses passes_;
    MovingElements moving_;
    std::vector<ElementPlace> places_;  // on the host, until they are written
    std::vector<std::uint32_t> list_;
    std::vector<glm::uvec2> links_;
    std::vector<std::uint32_t> senders_;  // of these
    std::uint32_t patch_count_ = 0, element_count_ = 0;
    std::vector<ElementParams> levels_;  // of clusters in the list, the lowest first
};

}  // namespace clgi
