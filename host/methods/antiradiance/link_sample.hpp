// How many links a scene gets, about, from those that end at a few of its leaves.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/links.hpp>
#include <cstddef>
#include <vector>

namespace clgi {

struct LinkSample {
    Links links;          // those that end at leaves of the sample, or at elements that hold them
    double total = 0.0;   // of all links, estimated
    double moving = 0.0;  // of those of which an end moves
};

// leaves: how many the sample has, spread evenly over the tree. The more, the better; all of them
// give every link. Throws as make_links() does, which gets the same arguments.
LinkSample sample_links(const ElementTree& tree, const DirectionBins& bins,
                        const LinkOptions& options, const std::vector<ElementTree>& poses,
                        std::size_t leaves);

}  // namespace clgi
