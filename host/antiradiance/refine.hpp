// Which pairs of elements are linked: the recursion over two trees. [Dachsbacher07, section 3.2]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/elements.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

// Two elements, neither of which holds the other, or one twice: everything within it.
struct ElementPair {
    std::uint32_t a, b;
    bool to_a, to_b;  // who may receive light of the other
};

class Refine {
public:
    // limit: sr that an element may have, seen from the other
    Refine(const ElementTree& tree, double limit) : tree_(tree), limit_(limit) {}

    // True: the pair is to be linked as it is. False: the pairs added to `children` stand for it;
    // there are none where no light is exchanged. Takes back to_a and to_b where the other element
    // lies behind.
    bool operator()(ElementPair& pair, std::vector<ElementPair>& children) const;

    // Solid angle of an element, about, from where the other one has it in view best: a flat one is
    // less foreshortened from other places within the other's sphere. Infinite where spheres touch.
    double seen(std::size_t element, std::size_t from) const;

private:
    bool hidden(std::size_t sender, std::size_t receiver) const;
    bool passes(std::size_t sender, std::size_t receiver) const;

    const ElementTree& tree_;
    const double limit_;
};

}  // namespace clgi
