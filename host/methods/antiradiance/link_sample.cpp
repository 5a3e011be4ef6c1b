// An element that holds s of S sampled leaves, and n of all N, stands for N s / (S n) elements: one
// on average over all samples, so the sum over links is right on average. [derived:
// Horvitz-Thompson]
// SPDX-License-Identifier: MIT
#include "methods/antiradiance/link_sample.hpp"

#include <algorithm>

#include "methods/antiradiance/linking.hpp"

namespace clgi {
namespace {

// Leaves that elements hold, all of them and those of the sample.
struct LeafCounts {
    LeafCounts(const ElementTree& tree, std::size_t sampled)
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
    const Linking linking(tree, bins, options, poses);
    LinkSample out;
    out.links.first.assign(tree.count() + 1, 0);
    const std::size_t sampled = std::min(leaves, tree.leaves);
    if (sampled == 0) return out;
    const LeafCounts held(tree, sampled);
    Exchange exchange = linking.exchange();
    std::vector<Link> found;
    std::vector<ElementPair> open{{0, 0, true, true}};
    out.links.pairs = linking(
        open, [&](std::uint32_t i) { return held.sample[i] > 0; }, exchange, found);

    std::sort(found.begin(), found.end(), [](const Link& a, const Link& b) {
        return a.receiver != b.receiver ? a.receiver < b.receiver : by_sender(a, b);
    });
    const double share = static_cast<double>(tree.leaves) / static_cast<double>(sampled);
    resize_links(out.links, found.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
        const Link& one = found[k];
        const double stands_for = share * held.sample[one.receiver] / held.all[one.receiver];
        out.total += stands_for;
        if (one.part != static_part) out.moving += stands_for;
        ++out.links.first[one.receiver + 1];
        set_link(out.links, k, one);
        list_moving(out.links, k, one);
    }
    for (std::size_t i = 0; i < tree.count(); ++i) out.links.first[i + 1] += out.links.first[i];
    return out;
}

}  // namespace clgi
