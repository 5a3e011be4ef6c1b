// What the oracle asks about two elements of which one moves: the worst of all poses.
// [Dachsbacher07, section 3.3; derived: elements go straight from pose to pose]
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "methods/antiradiance/refine.hpp"

namespace clgi {

// [elements] the largest of all poses.
std::vector<double> largest_radii(const std::vector<ElementTree>& poses);

class MotionRefine {
public:
    // poses: in the order of time, at least one
    MotionRefine(const ElementTree& tree, const std::vector<ElementTree>& poses);

    bool moves(std::size_t a, std::size_t b) const { return tree_.moves(a) || tree_.moves(b); }

    // As those of Refine.
    double seen(std::size_t element, std::size_t from) const;
    bool hidden(std::size_t sender, std::size_t receiver) const;
    bool passes(std::size_t sender, std::size_t receiver) const;
    bool far_apart(std::size_t a, std::size_t b) const;

    // The largest of all poses.
    double radius(std::size_t i) const { return radii_[i]; }

    // The largest that a sender has in a pose, sr, of patches exact; 0 where it never faces the
    // receiver.
    double solid_angle(std::size_t sender, std::size_t receiver) const;

private:
    double least_distance(std::size_t a, std::size_t b) const;

    const ElementTree& tree_;
    const std::vector<ElementTree>& poses_;
    const PatchGroups no_groups_;  // no leaf of a tree with something that moves is at a vertex
    std::vector<Refine> at_;       // [poses]
    std::vector<double> radii_;
};

}  // namespace clgi
