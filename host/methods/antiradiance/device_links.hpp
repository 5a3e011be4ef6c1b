// Links as kernels read them.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/antiradiance.h>
#include <clgi/advanced/direction_bins.hpp>
#include <clgi/advanced/elements.hpp>
#include <clgi/advanced/links.hpp>
#include <vector>

namespace clgi {

// Of each receiver first the links that read a power: those that bring what diffuse elements in one
// plane send before them. [derived: rows.clh] Senders of the others are rows.
struct DeviceLinks {
    std::vector<std::uint32_t> first;  // [elements][2], and the end; see LinkBuffers
    std::vector<std::uint32_t> senders;
    std::vector<std::uint16_t> bins;
    std::vector<float> form_factors;  // of the device's frame
    std::uint32_t rows = 0;           // 0: nothing can lie between any two elements

    std::vector<std::uint32_t> places;  // [links] as they were given: where each is now

    // Links of which an end moves; all of them read rows, whichever side they come from.
    std::vector<glm::uvec2> moving;             // MovingElements::links
    std::vector<std::uint32_t> moving_senders;  // their elements
};

// glossy: leaves with lobes, which send otherwise than evenly before them. elements: as the device
// has them; gives those a row whose row is read. scale: metres of a unit of the device's frame.
// rows_for_all: all elements get a row, and all links read one.
DeviceLinks device_links(const ElementTree& tree, const DirectionBins& bins, const Links& links,
                         double scale, const std::vector<GlossyLeaf>& glossy,
                         std::vector<Element>& elements, bool rows_for_all);

}  // namespace clgi
