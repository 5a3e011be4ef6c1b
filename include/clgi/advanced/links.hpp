// Which elements exchange light, through which bins of directions. [Dachsbacher07,
// sections 3.1, 3.2]
//
// A link adds form_factor * intensity of the sender in a bin to the incident radiance of the
// receiver in the same bin: bins are directions in which light travels, on both sides. Nothing is
// asked about what lies between. Every two leaves exchange light through one pair of elements that
// hold them, or through none where neither faces the other. Where the receiver lies in front of a
// sender its light arrives, where it lies behind its antiradiance.
//
// With cosine c = normal . direction of the bin, times hemisphere_scale, the intensity of a patch
// is area * |c| * radiance. The form factor of a flat sender is the solid angle it has from the
// receiver's position, divided by area * |c| * solid angle of the bin, so that the receiver gets
// radiance times solid angle, however near it is. [derived: from Eq. 16 and 18] That of other
// clusters is 1 / (distance^2 * solid angle of the bin) [Eq. 17].
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/direction_bins.hpp>
#include <clgi/advanced/elements.hpp>
#include <clgi/advanced/export.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clgi {

// What becomes of light from a leaf that is larger than a bin.
enum class Spread {
    none,     // it arrives through one bin
    precise,  // through each bin its share, found by cutting the leaf into parts
    // Through the bins in the cone that it fills, weighted by a Gaussian around its middle, as wide
    // as bins are apart: the heuristic of section 3.1, quicker to find.
    gaussian,
};

struct LinkOptions {
    // Two elements are refined while one of them, seen from the other, has more than this share of
    // a bin's solid angle. Above 0. With half of it there are 2.3 times as many links,
    // and the error from receivers that are no points is lower by a third.
    double bin_share = 0.5;
    Spread spread = Spread::precise;
    int threads = 0;  // up to 1024; 0: all
};

// A link of which an end moves: its bin and form factor change with it.
struct LinkOfMotion {
    std::uint32_t link;  // in the arrays of Links
    std::uint32_t receiver;
    std::uint32_t part;  // of the sender: 0: all of it; else of its quarters and their quarters,
                         // see clgi/shared/moving_elements.h
};

// By receiver, then by sender, then by bin; links of which an end moves by part of the sender.
struct Links {
    std::vector<std::uint32_t> first{0};  // [elements + 1] of the receiver, in the arrays below
    std::vector<std::uint32_t> senders;
    std::vector<std::uint16_t> bins;
    std::vector<float> form_factors;  // 1/m^2/sr

    std::vector<LinkOfMotion> moving;  // in the order of links

    std::size_t pairs = 0;      // of elements, each for one direction or both: the paper's links
    std::size_t unrefined = 0;  // pairs, counted per receiver, whose sender is larger than a bin

    std::size_t count() const { return senders.size(); }
    std::size_t bytes() const { return 4 * first.size() + (4 + 2 + 4) * senders.size(); }
};

// The same links for any number of threads.
//
// poses: of what moves, the tree at times of its motion, in their order (posed_elements() of
// clgi/advanced/moving_elements.hpp); empty: nothing moves. Two elements of which one moves are
// refined as the worst of the poses wants it, where both go straight from each pose to the next.
// Between poses a surface that turns may show parts that no pose shows: more poses make that less.
// Where a sender's triangle exceeds bin_share of a bin in some pose it is cut into 4 or 16 parts
// with a link each, which may give nothing as long as the elements do not face each other. In the
// links made here they are as the tree has them.
//
// Throws Error for options out of range, for poses of another number of elements and for more than
// 2^32 - 1 links, InputError for elements so small that floats cannot hold a form factor.
CLGI_API Links make_links(const ElementTree& tree, const DirectionBins& bins,
                          const LinkOptions& options = {},
                          const std::vector<ElementTree>& poses = {});

}  // namespace clgi
