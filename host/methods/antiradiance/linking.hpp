// From pairs of elements to links: of all of them, and of those that end at some elements.
// [Dachsbacher07, section 3.2]
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "methods/antiradiance/exchange.hpp"
#include "methods/antiradiance/motion_refine.hpp"
#include "methods/antiradiance/refine.hpp"

namespace clgi {

class Linking {
public:
    // All of it must outlive this object. Throws Error for what cannot be linked.
    Linking(const ElementTree& tree, const DirectionBins& bins, const LinkOptions& options,
            const std::vector<ElementTree>& poses)
        : tree_(checked(tree, bins, options, poses)),
          bins_(bins),
          options_(options),
          groups_(tree, options.threads),
          refine_(tree, groups_, options.bin_share * 4.0 * pi / bins.count(), motion_of(poses)),
          scales_(hemisphere_scales(tree, bins)),
          choose_(bins) {
        if (options.spread == Spread::gaussian) table_ = std::make_shared<SpreadTable>(bins);
    }
    Linking(const Linking&) = delete;
    Linking& operator=(const Linking&) = delete;

    const Refine& refine() const { return refine_; }

    // One for each thread.
    Exchange exchange() const {
        return Exchange(tree_, bins_, choose_, scales_, options_, table_, groups_);
    }

    // Appends the links of these pairs, and of all that stand for them, to `out`; `open` is empty
    // then. wanted: whether links that end at an element, or at one of those below it, are wanted.
    // Returns how many pairs are linked.
    template <typename Wanted>
    std::size_t operator()(std::vector<ElementPair>& open, const Wanted& wanted, Exchange& exchange,
                           std::vector<Link>& out) const {
        const auto link = [&](std::uint32_t sender, std::uint32_t receiver) {
            if (!wanted(receiver)) return;
            if (motion_ && motion_->moves(sender, receiver))
                exchange.slots(sender, receiver, motion_->solid_angle(sender, receiver), out);
            else
                exchange(sender, receiver, out);
        };
        std::size_t pairs = 0;
        while (!open.empty()) {
            ElementPair pair = open.back();
            open.pop_back();
            if (!(wanted(pair.a) || wanted(pair.b)) || !refine_(pair, open)) continue;
            ++pairs;
            if (pair.to_a) link(pair.b, pair.a);
            if (pair.to_b) link(pair.a, pair.b);
        }
        return pairs;
    }

private:
    static constexpr double pi = 3.14159265358979323846;

    static const ElementTree& checked(const ElementTree& tree, const DirectionBins& bins,
                                      const LinkOptions& options,
                                      const std::vector<ElementTree>& poses) {
        check_linking(tree, bins, options, poses);
        return tree;
    }
    const MotionRefine* motion_of(const std::vector<ElementTree>& poses) {
        return poses.empty() || tree_.moving.empty() ? nullptr : &motion_.emplace(tree_, poses);
    }

    const ElementTree& tree_;
    const DirectionBins& bins_;
    const LinkOptions& options_;
    const PatchGroups groups_;
    std::optional<MotionRefine> motion_;  // where something moves
    const Refine refine_;
    const std::vector<double> scales_;
    const BinChoice choose_;
    std::shared_ptr<const SpreadTable> table_;
};

// make_links() that throws Error as soon as there are more than so many links.
Links make_links_up_to(std::size_t most, const ElementTree& tree, const DirectionBins& bins,
                       const LinkOptions& options = {}, const std::vector<ElementTree>& poses = {});

// The order of the links of one receiver.
inline bool by_sender(const Link& a, const Link& b) {
    return std::tie(a.sender, a.part, a.bin) < std::tie(b.sender, b.part, b.bin);
}

inline void set_link(Links& links, std::size_t place, const Link& link) {
    links.senders[place] = link.sender;
    links.bins[place] = link.bin;
    links.form_factors[place] = link.form_factor;
}

inline void resize_links(Links& links, std::size_t count) {
    links.senders.resize(count);
    links.bins.resize(count);
    links.form_factors.resize(count);
}

// Lists a link of which an end moves.
inline void list_moving(Links& links, std::size_t place, const Link& link) {
    if (link.part != static_part)
        links.moving.push_back({static_cast<std::uint32_t>(place), link.receiver, link.part});
}

}  // namespace clgi
