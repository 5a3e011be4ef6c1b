// SPDX-License-Identifier: MIT
#include "methods/antiradiance/solver_motion.hpp"

#include <algorithm>

#include "methods/antiradiance/element_places.hpp"

namespace clgi {

AntiradianceMotion::AntiradianceMotion(const Programs& programs, const BuildOptions& options,
                                       const ElementTree& tree,
                                       const std::vector<ElementTree>& poses,
                                       const DirectionBins& bins, const Scene& scene,
                                       const DeviceScene& device, const DeviceLinks& links,
                                       const std::vector<Element>& elements)
    : passes_(programs, bins.count(), options),
      places_(element_places(tree, poses, bins, scene, device)),
      links_(links.moving),
      senders_(links.moving_senders) {
    for (std::size_t i = 0; i < places_.size(); ++i)
        places_[i].row_exponent = elements[i].row_exponent;
    moving_.link_count = static_cast<std::uint32_t>(links_.size());
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        if (tree.moves(i) && tree.is_patch(i)) list_.push_back(i);
    patch_count_ = static_cast<std::uint32_t>(list_.size());
    for (std::uint32_t i = 0; i < tree.count(); ++i)
        if (tree.moves(i) && !tree.is_patch(i)) list_.push_back(i);
    element_count_ = static_cast<std::uint32_t>(list_.size());
    const auto clusters = list_.begin() + patch_count_;
    std::stable_sort(clusters, list_.end(), [&](std::uint32_t a, std::uint32_t b) {
        return tree.levels[a] > tree.levels[b];
    });
    for (auto first = clusters; first != list_.end();) {
        const auto last = std::find_if(first, list_.end(), [&](std::uint32_t i) {
            return tree.levels[i] != tree.levels[*first];
        });
        levels_.push_back({static_cast<std::uint32_t>(first - list_.begin()),
                           static_cast<std::uint32_t>(last - first), 0, 0});
        first = last;
    }
}

void add_moving(BufferTable& table, MovingElements& moving, const ElementTree& tree,
                std::size_t moving_links) {
    const char* size = "elements.wished";
    const auto listed = static_cast<std::size_t>(
        std::count(tree.moving.begin(), tree.moving.end(), std::uint8_t{1}));
    table.add(moving.places, "moving elements", size, tree.count() * sizeof(ElementPlace));
    table.add(moving.list, "moving elements", size, listed * sizeof(std::uint32_t));
    table.add(moving.links, "moving links", size, moving_links * sizeof(glm::uvec2));
    table.add(moving.senders, "moving links", size, moving_links * sizeof(std::uint32_t));
}

void AntiradianceMotion::add_to(BufferTable& table, const ElementTree& tree) {
    add_moving(table, moving_, tree, links_.size());
}

void AntiradianceMotion::build() const { passes_.build({"refit", "refit_clusters", "relink"}); }

void AntiradianceMotion::write(Recorder& record, const cl::Buffer& patches) {
    moving_.patches = patches;
    const auto put = [&](const cl::Buffer& buffer, auto& values) {
        if (!values.empty()) record.write(buffer, values.data(), values.size() * sizeof(values[0]));
        values = {};
    };
    put(moving_.places, places_);
    put(moving_.list, list_);
    put(moving_.links, links_);
    put(moving_.senders, senders_);
}

void AntiradianceMotion::follow(Recorder& record, const DeviceScene& scene,
                                const LinkBuffers& links, const cl::Buffer& directions) const {
    const cl::CommandQueue& queue = record.queue();
    record("antiradiance.refit", patch_count_, [&](const WaitList& wait) {
        return passes_.refit(queue, {0, patch_count_, 0, 0}, scene, moving_, links, directions,
                             wait);
    });
    for (const ElementParams& level : levels_)
        record("antiradiance.refit_clusters", level.count, [&](const WaitList& wait) {
            return passes_.refit_clusters(queue, level, moving_, links, wait);
        });
    record("antiradiance.relink", moving_.link_count, [&](const WaitList& wait) {
        return passes_.relink(queue, scene, moving_, links, directions, wait);
    });
}

}  // namespace clgi
