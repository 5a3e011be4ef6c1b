// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/tree.hpp"

#include <algorithm>
#include <array>

namespace clgi {
namespace {

constexpr std::size_t most_in_leaf = 2;
constexpr int deepest = 20;
// A record is listed where it can stand in for a surface that faces a way: cosine with the axis.
// A surface whose main axis that is has a cosine of 0.577 at least.
constexpr float least_cosine = 0.1f;

class TreeMaker {
public:
    TreeMaker(const std::vector<CacheRecord>& records, RecordTree& out)
        : records_(records), out_(out) {
        for (std::uint32_t i = 0; i < records.size(); ++i)
            for (std::uint32_t way = 0; way < CACHE_WAYS; ++way)
                if (along(records[i].normal, way) > least_cosine) facing_[way].push_back(i);
    }

    std::uint32_t node(const glm::vec3& centre, float half_side,
                       const std::vector<std::uint32_t>& inside, int depth) {
        if (inside.size() <= most_in_leaf || depth == deepest) return leaf(centre, half_side);
        const auto place = static_cast<std::uint32_t>(out_.nodes.size());
        out_.nodes.resize(place + 8);
        for (std::uint32_t child = 0; child < 8; ++child) {
            std::vector<std::uint32_t> part;
            for (const std::uint32_t i : inside)
                if (octant(records_[i].position, centre) == child) part.push_back(i);
            const float half = 0.5f * half_side;
            const glm::vec3 side((child & 1u) ? half : -half, (child & 2u) ? half : -half,
                                 (child & 4u) ? half : -half);
            const std::uint32_t made = node(centre + side, half, part, depth + 1);
            out_.nodes[place + child] = made;
        }
        return place;
    }

private:
    static float along(const glm::vec3& normal, std::uint32_t way) {
        const float value = normal[static_cast<int>(way / 2)];
        return way % 2 == 0 ? value : -value;
    }

    static std::uint32_t octant(const glm::vec3& p, const glm::vec3& centre) {
        return (p.x > centre.x ? 1u : 0u) | (p.y > centre.y ? 2u : 0u) | (p.z > centre.z ? 4u : 0u);
    }

    // Farther off its own plane counts as farther away.
    std::uint32_t leaf(const glm::vec3& centre, float half_side) {
        const auto number = static_cast<std::uint32_t>(out_.lists.size() /
                                                       (std::size_t{CACHE_WAYS} * CACHE_LISTED));
        for (const std::vector<std::uint32_t>& candidates : facing_) {
            std::vector<std::pair<float, std::uint32_t>> near;
            for (const std::uint32_t i : candidates) {
                const glm::vec3 d = centre - records_[i].position;
                const float off =
                    std::max(std::abs(glm::dot(d, records_[i].normal)) - 1.7f * half_side, 0.0f);
                near.emplace_back(glm::dot(d, d) + 16.0f * off * off, i);
            }
            const std::size_t count = std::min<std::size_t>(near.size(), CACHE_LISTED);
            std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(count),
                              near.end());
            for (std::size_t k = 0; k < CACHE_LISTED; ++k)
                out_.lists.push_back(k < count ? near[k].second : CACHE_NONE);
        }
        return CACHE_LEAF | number;
    }

    const std::vector<CacheRecord>& records_;
    RecordTree& out_;
    std::array<std::vector<std::uint32_t>, CACHE_WAYS> facing_;
};

}  // namespace

RecordTree make_tree(const std::vector<CacheRecord>& records) {
    RecordTree out;
    std::vector<std::uint32_t> all;
    glm::vec3 low(0.0f), high(0.0f);
    for (std::uint32_t i = 0; i < records.size(); ++i) {
        const glm::vec3& p = records[i].position;
        low = i == 0 ? p : glm::min(low, p);
        high = i == 0 ? p : glm::max(high, p);
        all.push_back(i);
    }
    out.centre = 0.5f * (low + high);
    const glm::vec3 half = 0.5f * (high - low);
    out.half_side = std::max({half.x, half.y, half.z, 1e-6f});
    out.nodes.push_back(0);
    const std::uint32_t root = TreeMaker(records, out).node(out.centre, out.half_side, all, 0);
    out.nodes[0] = root;
    return out;
}

}  // namespace clgi
