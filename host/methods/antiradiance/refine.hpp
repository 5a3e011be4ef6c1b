// Which pairs of elements are linked: the recursion over two trees. [Dachsbacher07, section 3.2]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/elements.hpp>
#include <cstdint>
#include <limits>
#include <vector>

#include "methods/antiradiance/patch_groups.hpp"

namespace clgi {

// Two elements, neither of which holds the other, or one twice: everything within it.
struct ElementPair {
    std::uint32_t a, b;
    bool to_a, to_b;  // who may receive light of the other
};

// What rises less than this above a receiver's plane, as a share of its distance, lies in it: it
// would give less than 1e-6 of the light of a whole hemisphere.
constexpr double least_rise = 1e-6;

// A link's bin may lie two spacings off its direction, so light gains at least this share of the
// distance along the bin. Elements further apart than that are ordered along it, all leaves of one
// before all leaves of the other.
constexpr double least_ahead = 0.8;

class MotionRefine;

class Refine {
public:
    // groups: of the tree. limit: sr that an element may have, seen from the other. motion: it
    // answers for pairs of which an end moves; null: none does.
    Refine(const ElementTree& tree, const PatchGroups& groups, double limit,
           const MotionRefine* motion = nullptr)
        : tree_(tree), groups_(groups), limit_(limit), motion_(motion) {}

    // True: the pair is to be linked as it is. False: the pairs added to `children` stand for it;
    // there are none where no light is exchanged. Takes back to_a and to_b where the other element
    // lies behind.
    bool operator()(ElementPair& pair, std::vector<ElementPair>& children) const;

    // Solid angle of an element, about, from where the other one has it in view best: a flat one is
    // less foreshortened from other places within the other's sphere. Infinite where spheres touch.
    double seen(std::size_t element, std::size_t from) const;

    // The sender has no part in front of the receiver's plane. So have its parts for those of the
    // receiver.
    bool hidden(std::size_t sender, std::size_t receiver) const;

    // Whether light may come through the sender to the receiver.
    bool passes(std::size_t sender, std::size_t receiver) const;

private:
    bool far_apart(std::size_t a, std::size_t b) const;
    double radius(std::size_t i) const;

    // Whether all vertex patches of a leaf at a vertex lie below this height above the plane.
    bool below(std::size_t leaf, const glm::dvec3& normal, const glm::dvec3& position,
               double height) const;

    const ElementTree& tree_;
    const PatchGroups& groups_;
    const double limit_;
    const MotionRefine* const motion_;
};

}  // namespace clgi
