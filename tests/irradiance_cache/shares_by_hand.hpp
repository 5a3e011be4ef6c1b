// Shares of records in the light of a point, as kernels/cache/lookup.clh has them, in double
// precision.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// By distance and facing; the sum is 1, or 0 where none faces the way that the point does.
inline std::vector<double> shares_by_hand(const std::vector<glm::dvec3>& places,
                                          const std::vector<glm::dvec3>& normals,
                                          const glm::dvec3& point, const glm::dvec3& normal) {
    std::vector<double> apart, share;
    double mean = 0.0, last = 0.0, facing_ones = 0.0, sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec3 d = places[i] - point;
        const double facing = std::max(glm::dot(normals[i], normal) - 0.3, 0.0);
        const double off =
            4.0 * (std::abs(glm::dot(normals[i], d)) + std::abs(glm::dot(normal, d)));
        apart.push_back(glm::dot(d, d) + off * off);
        share.push_back(facing * facing);
        if (!(facing > 0.0)) continue;
        mean += 0.1 * apart.back();
        last = std::max(last, apart.back());
        facing_ones += 1.0;
    }
    if (facing_ones == 0.0) return share;
    mean /= facing_ones;
    for (std::size_t i = 0; i < places.size(); ++i) {
        share[i] *= std::pow(1.0 - 0.999 * apart[i] / last, 2.0) / (1.0 + apart[i] / mean);
        sum += share[i];
    }
    for (double& one : share) one /= sum;
    return share;
}

// And by moving least squares of degree 1.
inline std::vector<double> carried_by_hand(std::vector<double> share,
                                           const std::vector<glm::dvec3>& places,
                                           const glm::dvec3& point) {
    glm::dvec3 middle(0.0);
    for (std::size_t i = 0; i < places.size(); ++i) middle += share[i] * (places[i] - point);
    glm::dmat3 spread(0.0);
    double trace = glm::dot(middle, middle), sum = 0.0;
    for (std::size_t i = 0; i < places.size(); ++i) {
        const glm::dvec3 d = places[i] - point - middle;
        spread += share[i] * glm::outerProduct(d, d);
        trace += share[i] * glm::dot(d, d);
    }
    if (!(trace > 0.0)) return share;
    const glm::dvec3 slope = glm::inverse(spread + glm::dmat3(0.05 * trace)) * middle;
    for (std::size_t i = 0; i < places.size(); ++i) {
        share[i] *= std::clamp(1.0 - glm::dot(slope, places[i] - point - middle), 0.0, 3.0);
        sum += share[i];
    }
    for (double& one : share) one /= sum;
    return share;
}

}  // namespace clgi
