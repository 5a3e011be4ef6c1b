// The nearest of many points, by a k-d tree.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

class Nearest {
public:
    explicit Nearest(const std::vector<glm::dvec3>& points);

    // The index of the nearest point, of equally near ones the smallest. Faster where `guess`, an
    // index, is near. There is at least one point.
    std::uint32_t operator()(const glm::dvec3& p, std::uint32_t guess = 0) const;

private:
    struct Best {
        double squared;
        std::uint32_t point;
    };
    void build(std::uint32_t first, std::uint32_t last);
    void search(std::uint32_t first, std::uint32_t last, const glm::dvec3& p, Best& best) const;

    const std::vector<glm::dvec3>& points_;
    std::vector<std::uint32_t> order_;  // the middle of a range cuts it
    std::vector<std::uint8_t> axis_;    // [order] along which it does
};

}  // namespace clgi
