// An element that holds s of S sampled leaves, and n of all N, stands for N s / (S n) elements: one
// on average over all samples, so the sum over links is right on average. [derived:
// Horvitz-Thompson]
// SPDX-License-Identifier: MIT
#include "antiradiance/link_sample.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <tuple>

#include "antiradiance/exchange.hpp"
#include "antiradiance/motion_refine.hpp"
#include "antiradiance/refine.hpp"

namespace clgi {
namespace {

constexpr double pi = 3.14159265358979323846;

// Leaves that elements hold, all of them and those of the sample.
struct Held {
    Held(const ElementTree& tree, std::size_t sampled)
        : all(tree.count(), 0), sample(tree.count(), 0) {
        std::size_t leaf = 0, next = 0;
        for (std::size_t i = 0; i < tree.count(); ++i) {
            if (!tree.is_leaf(i)) continue;
            all[i] = 1;
            // In the middle of its share of the leaves.
            if (leaf++ != (2 * next + 1) * tree.leaves / (2 * sampled)) continue;
            sample[i] = 1;
            ++next;
        }
        for (std::size_t i = tree.count(); i-- > 1;) {
            all[tree.parents[i]] += all[i];
            sample[tree.parents[i]] += sample[i];
        }
    }
    std::vector<std::uint32_t> all, sample;
};

}  // namespace

LinkSample sample_links(const ElementTree& tree, const DirectionBins& bins,
                        const LinkOptions& options, const std::vector<ElementTree>& poses,
                        std::size_t leaves) {
    check_linking(tree, bins, options, poses);
    LinkSample out;
    out.links.first.assign(tree.count() + 1, 0);
    const std::size_t sampled = std::min(leaves, tree.leaves);
    if (sampled == 0) return out;
    const Held held(tree, sampled);
    std::optional<MotionRefine> motion;
    if (!poses.empty()) motion.emplace(tree, poses);
    const Refine refine(tree, options.bin_share * 4.0 * pi / bins.count(),
                        motion ? &*motion : nullptr);
    const std::vector<double> scales = hemisphere_scales(tree, bins);
    std::shared_ptr<const SpreadTable> table;
    if (options.spread == Spread::gaussian) table = std::make_shared<SpreadTable>(bins);
    Exchange exchange(tree, bins, scales, options, table);

    std::vector<Link> found;
    const auto link = [&](std::uint32_t sender, std::uint32_t receiver) {
        if (held.sample[receiver] == 0) return;
        if (motion && motion->moves(sender, receiver))
            exchange.slots(sender, receiver, motion->solid_angle(sender, receiver), found);
        else
            exchange(sender, receiver, found);
    };
    std::vector<ElementPair> open{{0, 0, true, true}};
    while (!open.empty()) {
        ElementPair pair = open.back();
        open.pop_back();
        if (held.sample[pair.a] + held.sample[pair.b] == 0 || !refine(pair, open)) continue;
        ++out.links.pairs;
        if (pair.to_a) link(pair.b, pair.a);
        if (pair.to_b) link(pair.a, pair.b);
    }

    std::sort(found.begin(), found.end(), [](const Link& a, const Link& b) {
        return std::tie(a.receiver, a.sender, a.part, a.bin) <
               std::tie(b.receiver, b.sender, b.part, b.bin);
    });
    const double share = static_cast<double>(tree.leaves) / static_cast<double>(sampled);
    for (const Link& one : found) {
        const double stands_for = share * held.sample[one.receiver] / held.all[one.receiver];
        out.total += stands_for;
        if (one.part != still_part) {
            out.moving += stands_for;
            out.links.moving.push_back(
                {static_cast<std::uint32_t>(out.links.senders.size()), one.receiver, one.part});
        }
        ++out.links.first[one.receiver + 1];
        out.links.senders.push_back(one.sender);
        out.links.bins.push_back(one.bin);
        out.links.form_factors.push_back(one.form_factor);
    }
    for (std::size_t i = 0; i < tree.count(); ++i) out.links.first[i + 1] += out.links.first[i];
    return out;
}

}  // namespace clgi
