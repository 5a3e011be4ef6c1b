// Where light comes from, learnt from paths, so that others look there: rare ways to light, such as
// through a window or a slit, are followed more often.
//                     [Müller17, here with a binary tree of places and directions in fixed bins]
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "reference/random.hpp"

namespace clgi::reference {

// Light that a path met at a place.
struct Met {
    glm::vec3 place;      // local
    glm::vec3 direction;  // it came from, unit
    float light;          // luminance over the density of having looked there
};

class Guide {
public:
    // Of light that arrives in a part of the scene, by bins of equal solid angle.
    class Cell {
    public:
        // Per steradian, of sample().
        float density(const glm::vec3& direction) const;
        glm::vec3 sample(Random& random) const;

    private:
        friend class Guide;
        static constexpr std::size_t rings = 16, sectors = 32, bins = rings * sectors;
        static std::size_t bin_of(const glm::vec3& direction);
        std::array<float, bins> sums{};  // shares up to a bin and with it, of 1
    };

    explicit Guide(std::vector<Met> met);

    // Null where nothing was learnt.
    const Cell* at(const glm::vec3& place) const;

private:
    struct Node {
        int axis = -1;          // -1: a cell
        float middle = 0.0f;    // below it lies the next node, above it node `above`
        std::size_t above = 0;  // or the number of the cell
    };

    using Part = std::vector<Met>::iterator;
    void divide(Part first, Part last);

    std::vector<Node> nodes_;
    std::vector<Cell> cells_;
};

}  // namespace clgi::reference
