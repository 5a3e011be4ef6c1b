// SPDX-License-Identifier: MIT
#include "methods/light_atlas/regions.hpp"

#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <queue>
#include <utility>

#include "methods/light_atlas/clusters_of_islands.hpp"
#include "scene/disjoint_sets.hpp"

namespace clgi {
namespace {

using std::numbers::pi;
constexpr double narrow_cone = 0.25 * pi, widest_cone = 0.5 * pi;  // half angles
constexpr double largest_excess = 0.25;                            // share of the VPLs

double angle_between(const glm::dvec3& a, const glm::dvec3& b) {
    if (a == glm::dvec3(0.0) || b == glm::dvec3(0.0)) return pi;  // as when opposite normals cancel
    // Not acos of the scalar product, which loses half the digits at small angles.
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

// Regions while they grow. A region is known by its smallest patch.
class Merger {
public:
    Merger(const Patches& patches, double vpl_area)
        : patches_(patches), vpl_area_(vpl_area), sets_(patches.patches.size()) {
        const std::size_t count = patches.patches.size();
        next_.resize(count);
        for (std::size_t p = 0; p < count; ++p) {
            const Patch& patch = patches.patches[p];
            area_.push_back(patch.area);
            sum_.push_back(patch.area * patch.normal);
            spread_.push_back(patch.spread);
            note(static_cast<std::uint32_t>(p), 1);
        }
        for (std::size_t t = 0; t < patches.neighbours.size(); ++t)
            for (const std::uint32_t other : patches.neighbours[t]) {
                if (other == no_index) continue;
                const std::uint32_t a = patches.triangle_patch[t],
                                    b = patches.triangle_patch[other];
                if (a != b && patches.patches[a].double_sided == patches.patches[b].double_sided)
                    next_[a].push_back(b);
            }
        for (auto& list : next_) {
            std::sort(list.begin(), list.end());
            list.erase(std::unique(list.begin(), list.end()), list.end());
        }
    }

    // VPLs that regions would take beyond their share of the area, with one VPL for each small one.
    double excess() const { return excess_; }
    // VPLs with one for each region.
    std::int64_t fewest() const { return fewest_; }

    // The smallest region first, while wanted(its area), within cones of this half angle.
    void merge(double cone, const std::function<bool(double)>& wanted) {
        using Entry = std::pair<double, std::uint32_t>;
        std::priority_queue<Entry, std::vector<Entry>, std::greater<>> smallest;
        for (std::uint32_t p = 0; p < area_.size(); ++p)
            if (sets_.find(p) == p) smallest.push({area_[p], p});
        while (!smallest.empty()) {
            const auto [area, small] = smallest.top();
            smallest.pop();
            if (sets_.find(small) != small || area != area_[small]) continue;  // has grown since
            if (!wanted(area)) return;
            const std::uint32_t other = best_neighbour(small, cone);
            if (other == no_index) continue;
            const std::uint32_t both = join(small, other);
            smallest.push({area_[both], both});
        }
    }

    void join_unlike(std::uint32_t a, std::uint32_t b) { join(sets_.find(a), sets_.find(b)); }

    std::vector<Region> regions() {
        std::vector<Region> out;
        std::vector<std::uint32_t> number(area_.size(), no_index);
        for (std::uint32_t p = 0; p < area_.size(); ++p) {
            const std::uint32_t root = sets_.find(p);
            if (number[root] == no_index) {
                number[root] = static_cast<std::uint32_t>(out.size());
                Region region;
                region.area = area_[root];
                const double length = glm::length(sum_[root]);
                region.normal = length > 0.0 ? sum_[root] / length : patches_.patches[root].normal;
                region.double_sided = patches_.patches[root].double_sided;
                out.push_back(region);
            }
            out[number[root]].patches.push_back(p);
        }
        return out;
    }

    // Regions below an area, as islands to be clustered.
    std::vector<Island> smaller_than(double area) {
        std::vector<Island> out;
        std::vector<glm::dvec3> centre(area_.size(), glm::dvec3(0.0));
        for (std::uint32_t p = 0; p < area_.size(); ++p) {
            const Patch& patch = patches_.patches[p];
            centre[sets_.find(p)] +=
                patch.area / area_[sets_.find(p)] * (patch.centre - patches_.patches[0].centre);
        }
        for (std::uint32_t p = 0; p < area_.size(); ++p)
            if (sets_.find(p) == p && area_[p] < area)
                out.push_back({p, area_[p], centre[p], sum_[p], patches_.patches[p].double_sided});
        return out;
    }

private:
    void note(std::uint32_t region, int sign) {
        const int sites = patches_.patches[region].double_sided ? 2 : 1;
        fewest_ += sign * sites;
        excess_ += sign * sites * std::max(0.0, 1.0 - area_[region] / vpl_area_);
    }

    // The half angle of the cone around two regions' normals, as far as their own cones tell.
    double cone_of(std::uint32_t a, std::uint32_t b) const {
        const glm::dvec3 axis = sum_[a] + sum_[b];
        return std::max(angle_between(axis, sum_[a]) + spread_[a],
                        angle_between(axis, sum_[b]) + spread_[b]);
    }

    std::uint32_t best_neighbour(std::uint32_t region, double cone) {
        std::vector<std::uint32_t>& list = next_[region];
        for (std::uint32_t& other : list) other = sets_.find(other);
        std::sort(list.begin(), list.end());
        list.erase(std::unique(list.begin(), list.end()), list.end());
        list.erase(std::remove(list.begin(), list.end(), region), list.end());
        std::uint32_t best = no_index;
        double best_angle = 0.0;
        for (const std::uint32_t other : list) {
            const double angle = angle_between(sum_[region], sum_[other]);
            if (best != no_index && !(angle < best_angle)) continue;
            if (!(cone_of(region, other) <= cone)) continue;
            best = other;
            best_angle = angle;
        }
        return best;
    }

    std::uint32_t join(std::uint32_t a, std::uint32_t b) {
        if (a == b) return a;
        note(a, -1);
        note(b, -1);
        const double spread = cone_of(a, b), area = area_[a] + area_[b];
        const glm::dvec3 sum = sum_[a] + sum_[b];
        if (next_[a].size() < next_[b].size()) next_[a].swap(next_[b]);
        next_[a].insert(next_[a].end(), next_[b].begin(), next_[b].end());
        std::vector<std::uint32_t> list = std::move(next_[a]);
        next_[a].clear();
        next_[b].clear();
        sets_.join(a, b);
        const std::uint32_t both = sets_.find(a);
        next_[both] = std::move(list);
        area_[both] = area;
        sum_[both] = sum;
        spread_[both] = spread;
        note(both, 1);
        return both;
    }

    const Patches& patches_;
    const double vpl_area_;
    DisjointSets sets_;
    std::vector<double> area_;                      // m^2
    std::vector<glm::dvec3> sum_;                   // of area times normal
    std::vector<double> spread_;                    // radians
    std::vector<std::vector<std::uint32_t>> next_;  // regions beside it, some merged since
    double excess_ = 0.0;
    std::int64_t fewest_ = 0;
};

}  // namespace

// One VPL each, then always to the region that has the least for its area.
void share_out(std::vector<Region>& regions, std::uint32_t count) {
    struct Claim {
        double urgency;
        std::uint32_t region;
        bool operator<(const Claim& o) const {
            return urgency != o.urgency ? urgency < o.urgency : region > o.region;
        }
    };
    std::int64_t left = count;
    std::priority_queue<Claim> claims;
    const auto claim = [&](std::uint32_t r) {
        claims.push({regions[r].density * regions[r].area / (2.0 * regions[r].vpls + 1.0), r});
    };
    for (std::uint32_t r = 0; r < regions.size(); ++r) {
        regions[r].vpls = 1;
        left -= regions[r].double_sided ? 2 : 1;
        claim(r);
    }
    while (left > 0 && !claims.empty()) {
        const std::uint32_t r = claims.top().region;
        claims.pop();
        const int cost = regions[r].double_sided ? 2 : 1;
        if (cost > left) continue;
        left -= cost;
        ++regions[r].vpls;
        claim(r);
    }
}

std::vector<Region> make_regions(const Patches& patches, std::uint32_t count) {
    if (patches.patches.empty()) return {};
    double area = 0.0;
    for (const Patch& patch : patches.patches)
        area += (patch.double_sided ? 2.0 : 1.0) * patch.area;
    const double vpl_area = area / count;
    const std::int64_t most = count;
    const double most_excess = largest_excess * count;

    Merger merger(patches, vpl_area);
    merger.merge(narrow_cone, [&](double smallest) { return smallest < 0.5 * vpl_area; });
    const auto too_many = [&] { return merger.fewest() > most || merger.excess() > most_excess; };
    merger.merge(widest_cone, [&](double smallest) { return smallest < vpl_area && too_many(); });
    if (too_many()) {
        const std::vector<Island> islands = merger.smaller_than(vpl_area);
        double share = 0.0;
        std::int64_t others = merger.fewest();
        for (const Island& island : islands) {
            const int sites = island.double_sided ? 2 : 1;
            share += sites * island.area / vpl_area;
            others -= sites;
        }
        const auto room = std::min(most - others, static_cast<std::int64_t>(share + most_excess));
        for (const std::vector<std::uint32_t>& cluster : cluster_islands(islands, room))
            for (const std::uint32_t region : cluster) merger.join_unlike(cluster[0], region);
    }
    std::vector<Region> regions = merger.regions();
    share_out(regions, count);
    return regions;
}

}  // namespace clgi
