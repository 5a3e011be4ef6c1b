// What stands between two points: of a patch, or in space.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/adjacency.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <functional>
#include <vector>

namespace clgi {

// A tree of boxes over the triangles of a scene, which must outlive it.
class Walls {
public:
    explicit Walls(const Scene& scene);

    // Does a triangle that counts meet the segment? Metres. A triangle's edges belong to it, so
    // nothing passes between two that share one.
    bool between(const glm::dvec3& from, const glm::dvec3& to,
                 const std::function<bool(std::uint32_t triangle)>& counts) const {
        return first_met(from, to, counts, true).triangle != no_index;
    }

    struct Met {
        double share = 1.0;  // of the way from one end to the other, 0 to 1
        std::uint32_t triangle = no_index;
        bool back = false;  // its back was met
    };

    // The nearest triangle that counts; no_index: none meets the segment.
    Met nearest(const glm::dvec3& from, const glm::dvec3& to,
                const std::function<bool(std::uint32_t triangle)>& counts) const {
        return first_met(from, to, counts, false);
    }

private:
    struct Box {
        glm::vec3 low, high;  // metres from the middle of the scene, rounded outwards
    };
    struct Node {
        Box box;
        std::uint32_t
            first;  // in order_; or the second child, where the first one follows the node
        std::uint32_t count;  // 0: two children
    };

    Box box_of(std::uint32_t triangle) const;
    void build(std::vector<Box>& boxes, std::uint32_t first, std::uint32_t last, int depth);
    bool meets(const glm::dvec3& from, const glm::dvec3& way, std::uint32_t triangle,
               Met& met) const;
    Met first_met(const glm::dvec3& from, const glm::dvec3& to,
                  const std::function<bool(std::uint32_t)>& counts, bool any) const;

    const Scene& scene_;
    glm::dvec3 middle_ = glm::dvec3(0.0);
    std::vector<std::uint32_t> order_;  // triangles
    std::vector<Node> nodes_;
};

}  // namespace clgi
