// SPDX-License-Identifier: MIT
#include "methods/antiradiance/device_links.hpp"

#include <algorithm>
#include <cmath>

#include <clgi/shared/moving_elements.h>

namespace clgi {
namespace {

// Elements in one plane that send as diffuse ones do, without a lobe among them.
std::vector<std::uint8_t> even_elements(const ElementTree& tree,
                                        const std::vector<GlossyLeaf>& glossy) {
    std::vector<std::uint8_t> out(tree.count());
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = tree.is_flat(i) ? 1 : 0;
    for (const GlossyLeaf& leaf : glossy)
        for (std::uint32_t i = leaf.element; i != no_index; i = tree.parents[i]) out[i] = 0;
    return out;
}

// Of the front of each link's sender with its bin; 0 where it sends nothing before it, or not as a
// diffuse plane does.
std::vector<float> cosines_before(const std::vector<std::uint8_t>& even, const DirectionBins& bins,
                                  const Links& links, const std::vector<Element>& elements) {
    std::vector<glm::vec3> directions;  // as the kernels have them
    for (const glm::dvec3& direction : bins.directions) directions.emplace_back(direction);
    std::vector<float> out(links.count(), 0.0f);
    for (std::size_t k = 0; k < out.size(); ++k)
        if (const std::uint32_t sender = links.senders[k]; even[sender])
            out[k] = std::max(
                0.0f, glm::dot(glm::vec3(elements[sender].normal), directions[links.bins[k]]));
    // Where what moves goes is not known.
    for (const LinkOfMotion& link : links.moving) out[link.link] = 0.0f;
    return out;
}

// A row is the sum of those below, so all below a row that is read have one. Returns their number.
std::uint32_t number_rows(const std::vector<std::uint8_t>& read, std::vector<Element>& elements) {
    std::uint32_t rows = 0;
    for (std::uint32_t i = 0; i < elements.size(); ++i) {
        const std::uint32_t parent = elements[i].parent;
        const bool above = parent != ELEMENT_NONE && elements[parent].sends != ELEMENT_NONE;
        elements[i].sends = read[i] || above ? rows++ : ELEMENT_NONE;
    }
    return rows;
}

}  // namespace

DeviceLinks device_links(const ElementTree& tree, const DirectionBins& bins, const Links& links,
                         double scale, const std::vector<GlossyLeaf>& glossy,
                         std::vector<Element>& elements, bool rows_for_all) {
    const std::vector<float> before =
        rows_for_all ? std::vector<float>(links.count(), 0.0f)
                     : cosines_before(even_elements(tree, glossy), bins, links, elements);
    std::vector<std::uint8_t> read(elements.size(), rows_for_all ? 1 : 0);
    for (std::size_t k = 0; k < links.count(); ++k)
        if (!(before[k] > 0.0f)) read[links.senders[k]] = 1;
    DeviceLinks out;
    out.places.resize(links.count());
    out.rows = number_rows(read, elements);
    std::size_t next = 0;  // moving link
    const auto add = [&](std::size_t k, std::uint32_t sender, double factor) {
        if (next < links.moving.size() && links.moving[next].link == k) {
            const LinkOfMotion& link = links.moving[next++];
            out.moving.emplace_back(static_cast<std::uint32_t>(out.senders.size()),
                                    link.receiver | link.part << PART_SHIFT);
            out.moving_senders.push_back(links.senders[k]);
        }
        out.places[k] = static_cast<std::uint32_t>(out.senders.size());
        out.senders.push_back(sender);
        out.bins.push_back(links.bins[k]);
        out.form_factors.push_back(static_cast<float>(factor / (scale * scale)));
    };
    for (std::size_t i = 0; i < tree.count(); ++i) {
        out.first.push_back(static_cast<std::uint32_t>(out.senders.size()));
        for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k)
            if (before[k] > 0.0f)
                add(k, links.senders[k], double{links.form_factors[k]} * before[k]);
        out.first.push_back(static_cast<std::uint32_t>(out.senders.size()));
        for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k)
            if (!(before[k] > 0.0f))
                add(k, elements[links.senders[k]].sends,
                    std::ldexp(double{links.form_factors[k]},
                               elements[links.senders[k]].row_exponent));
    }
    out.first.push_back(static_cast<std::uint32_t>(out.senders.size()));
    return out;
}

}  // namespace clgi
