// SPDX-License-Identifier: MIT
#include "methods/transfer/nearest_coarse.hpp"

#include <algorithm>
#include <limits>

namespace clgi {
namespace {

constexpr std::size_t run = 64;  // coarse triangles that share a box
constexpr double far_away = std::numeric_limits<double>::infinity();

double square(const glm::dvec3& v) { return glm::dot(v, v); }

double to_segment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
    const double length = square(b - a);
    const double t = length > 0.0 ? std::clamp(glm::dot(p - a, b - a) / length, 0.0, 1.0) : 0.0;
    return square(p - a - t * (b - a));
}

struct Coarse {
    glm::dvec3 corner[3];
    glm::dvec3 normal;  // of any length
    std::uint32_t piece;

    // Squared distance.
    double to(const glm::dvec3& p) const {
        const double along = glm::dot(p - corner[0], normal), length = square(normal);
        bool above = length > 0.0;  // the triangle, not its edges
        double least = far_away;
        for (int k = 0; k < 3; ++k) {
            const glm::dvec3 &a = corner[k], &b = corner[(k + 1) % 3];
            above = above && glm::dot(glm::cross(b - a, p - a), normal) >= 0.0;
            least = std::min(least, to_segment(p, a, b));
        }
        return above ? along * along / length : least;
    }
};

struct Box {
    glm::dvec3 low = glm::dvec3(far_away), high = glm::dvec3(-far_away);
    double to(const glm::dvec3& p) const {
        return square(glm::max(glm::max(low - p, p - high), glm::dvec3(0.0)));
    }
};

}  // namespace

std::vector<std::uint32_t> nearest_coarse(const std::vector<glm::dvec3>& positions,
                                          const std::vector<std::uint32_t>& pieces,
                                          const std::vector<glm::uvec3>& fine,
                                          const std::vector<glm::uvec3>& coarse) {
    std::vector<Coarse> all;
    std::vector<Box> boxes((coarse.size() + run - 1) / run);
    for (const glm::uvec3& t : coarse) {
        const glm::dvec3 &a = positions[t.x], &b = positions[t.y], &c = positions[t.z];
        Box& box = boxes[all.size() / run];
        box.low = glm::min(box.low, glm::min(a, glm::min(b, c)));
        box.high = glm::max(box.high, glm::max(a, glm::max(b, c)));
        all.push_back({{a, b, c}, glm::cross(b - a, c - a), pieces[t.x]});
    }
    std::vector<std::uint32_t> out;
    for (const glm::uvec3& t : fine) {
        const glm::dvec3 &a = positions[t.x], &b = positions[t.y], &c = positions[t.z];
        const glm::dvec3 centre = (a + b + c) / 3.0, normal = glm::cross(b - a, c - a);
        double facing = far_away, any = far_away;
        std::uint32_t best_facing = 0xffffffffu, best = 0xffffffffu;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            if (boxes[i].to(centre) >= facing) continue;
            for (std::size_t k = run * i; k < std::min(run * (i + 1), all.size()); ++k) {
                if (all[k].piece != pieces[t.x]) continue;
                const double distance = all[k].to(centre);
                if (distance < any) {
                    any = distance;
                    best = static_cast<std::uint32_t>(k);
                }
                if (distance < facing && glm::dot(normal, all[k].normal) > 0.0) {
                    facing = distance;
                    best_facing = static_cast<std::uint32_t>(k);
                }
            }
        }
        out.push_back(best_facing != 0xffffffffu ? best_facing : best);
    }
    return out;
}

}  // namespace clgi
