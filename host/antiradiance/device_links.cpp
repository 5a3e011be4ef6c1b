// SPDX-License-Identifier: MIT
#include "antiradiance/device_links.hpp"

namespace clgi {

DeviceLinks device_links(const ElementTree& tree, const std::vector<Element>& elements,
                         const DirectionBins& bins, const Links& links, double scale) {
    std::vector<glm::vec3> directions;  // as the kernels have them
    for (const glm::dvec3& direction : bins.directions) directions.emplace_back(direction);
    // Of the sender's front with the bin; 0 where there is none before it.
    const auto cosine = [&](std::size_t k) {
        const std::uint32_t sender = links.senders[k];
        if (!tree.is_flat(sender)) return 0.0f;
        return std::max(0.0f, glm::dot(glm::vec3(elements[sender].normal),
                                       directions[links.bins[k]]));
    };
    DeviceLinks out;
    const auto add = [&](std::size_t k, double factor) {
        out.senders.push_back(links.senders[k]);
        out.bins.push_back(links.bins[k]);
        out.form_factors.push_back(static_cast<float>(factor / (scale * scale)));
    };
    for (std::size_t i = 0; i < tree.count(); ++i) {
        out.first.push_back(static_cast<std::uint32_t>(out.senders.size()));
        for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k)
            if (cosine(k) > 0.0f) add(k, double{links.form_factors[k]} * cosine(k));
        out.first.push_back(static_cast<std::uint32_t>(out.senders.size()));
        for (std::size_t k = links.first[i]; k < links.first[i + 1]; ++k)
            if (!(cosine(k) > 0.0f)) add(k, links.form_factors[k]);
    }
    out.first.push_back(static_cast<std::uint32_t>(out.senders.size()));
    return out;
}

}  // namespace clgi
