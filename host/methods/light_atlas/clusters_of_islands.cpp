// SPDX-License-Identifier: MIT
#include "methods/light_atlas/clusters_of_islands.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

namespace clgi {
namespace {

int kind_of(const Island& island) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(island.normal[k]) > std::abs(island.normal[axis])) axis = k;
    return 4 * axis + (island.normal[axis] < 0.0 ? 2 : 0) + (island.double_sided ? 1 : 0);
}

struct IslandCluster {
    std::vector<std::uint32_t> members;  // of the islands
    double area = 0.0;
    double moment = 0.0;  // area times squared diagonal: what a single VPL gets wrong
    int longest = 0;      // axis
};

IslandCluster cluster_of(const std::vector<Island>& islands, std::vector<std::uint32_t> members) {
    IslandCluster out;
    glm::dvec3 low = islands[members[0]].centre, high = low;
    for (const std::uint32_t m : members) {
        out.area += islands[m].area;
        low = glm::min(low, islands[m].centre);
        high = glm::max(high, islands[m].centre);
    }
    const glm::dvec3 size = high - low;
    for (int k = 1; k < 3; ++k)
        if (size[k] > size[out.longest]) out.longest = k;
    out.moment = out.area * glm::dot(size, size);
    out.members = std::move(members);
    return out;
}

// Two parts of nearly equal area, none empty.
std::array<IslandCluster, 2> cut(const std::vector<Island>& islands, IslandCluster cluster) {
    const int axis = cluster.longest;
    std::sort(
        cluster.members.begin(), cluster.members.end(), [&](std::uint32_t a, std::uint32_t b) {
            return std::tie(islands[a].centre[axis], a) < std::tie(islands[b].centre[axis], b);
        });
    double below = 0.0;
    std::size_t first = 0;  // of the upper part
    while (first + 1 < cluster.members.size()) {
        below += islands[cluster.members[first++]].area;
        if (below >= 0.5 * cluster.area) break;
    }
    const auto middle = cluster.members.begin() + static_cast<std::ptrdiff_t>(first);
    return {cluster_of(islands, {cluster.members.begin(), middle}),
            cluster_of(islands, {middle, cluster.members.end()})};
}

}  // namespace

std::vector<std::vector<std::uint32_t>> cluster_islands(const std::vector<Island>& islands,
                                                        std::int64_t room) {
    std::array<std::vector<std::uint32_t>, 12> kinds;
    for (std::uint32_t s = 0; s < islands.size(); ++s) kinds[kind_of(islands[s])].push_back(s);
    std::vector<IslandCluster> clusters;
    std::priority_queue<std::tuple<double, std::size_t>> widest;
    const auto cost = [&](std::size_t c) {
        return islands[clusters[c].members[0]].double_sided ? 2 : 1;
    };
    for (auto& members : kinds) {
        if (members.empty()) continue;
        clusters.push_back(cluster_of(islands, std::move(members)));
        room -= cost(clusters.size() - 1);
        widest.push({clusters.back().moment, clusters.size() - 1});
    }
    while (room > 0 && !widest.empty()) {
        const std::size_t c = std::get<1>(widest.top());
        widest.pop();
        if (clusters[c].members.size() < 2 || cost(c) > room) continue;
        room -= cost(c);
        std::array<IslandCluster, 2> parts = cut(islands, std::move(clusters[c]));
        clusters[c] = std::move(parts[0]);
        clusters.push_back(std::move(parts[1]));
        widest.push({clusters[c].moment, c});
        widest.push({clusters.back().moment, clusters.size() - 1});
    }
    std::vector<std::vector<std::uint32_t>> out;
    for (const IslandCluster& cluster : clusters) {
        out.emplace_back();
        for (const std::uint32_t m : cluster.members) out.back().push_back(islands[m].id);
    }
    return out;
}

}  // namespace clgi
