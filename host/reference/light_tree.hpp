// Which of many emissive triangles is asked for light at a point: by power over squared distance,
// so that the lamp of a room is found among those of a house.
//                                                            [ContyEstevez18, without orientations]
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "reference/random.hpp"

namespace clgi::reference {

class LightTree {
public:
    struct Item {
        glm::vec3 centre;  // local
        float radius;      // of a sphere that holds it
        double power;      // above 0
    };

    explicit LightTree(const std::vector<Item>& items);

    // An item by its number, with probability() at the point.
    std::uint32_t sample(const glm::vec3& point, Random& random) const;
    float probability(std::uint32_t item, const glm::vec3& point) const;

private:
    struct Node {
        Item all;
        std::uint32_t parent = 0;
        std::uint32_t second = 0;  // child; the first one follows the node. 0: an item
        std::uint32_t item = 0;
    };

    void divide(const std::vector<Item>& items, std::uint32_t* first, std::uint32_t* last,
                std::uint32_t parent);
    double share_of_first(const Node& node, std::uint32_t first, const glm::vec3& point) const;

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaves_;  // node of each item
};

}  // namespace clgi::reference
