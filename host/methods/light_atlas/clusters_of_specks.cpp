// SPDX-License-Identifier: MIT
#include "methods/light_atlas/clusters_of_specks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <queue>
#include <tuple>

namespace clgi {
namespace {

int kind_of(const Speck& speck) {
    int axis = 0;
    for (int k = 1; k < 3; ++k)
        if (std::abs(speck.normal[k]) > std::abs(speck.normal[axis])) axis = k;
    return 4 * axis + (speck.normal[axis] < 0.0 ? 2 : 0) + (speck.double_sided ? 1 : 0);
}

struct Cluster {
    std::vector<std::uint32_t> members;  // of the specks
    double area = 0.0;
    double moment = 0.0;  // area times squared diagonal: what a single VPL gets wrong
    int longest = 0;      // axis
};

Cluster cluster_of(const std::vector<Speck>& specks, std::vector<std::uint32_t> members) {
    Cluster out;
    glm::dvec3 low = specks[members[0]].centre, high = low;
    for (const std::uint32_t m : members) {
        out.area += specks[m].area;
        low = glm::min(low, specks[m].centre);
        high = glm::max(high, specks[m].centre);
    }
    const glm::dvec3 size = high - low;
    for (int k = 1; k < 3; ++k)
        if (size[k] > size[out.longest]) out.longest = k;
    out.moment = out.area * glm::dot(size, size);
    out.members = std::move(members);
    return out;
}

// Two parts of nearly equal area, none empty.
std::array<Cluster, 2> cut(const std::vector<Speck>& specks, Cluster cluster) {
    const int axis = cluster.longest;
    std::sort(cluster.members.begin(), cluster.members.end(),
              [&](std::uint32_t a, std::uint32_t b) {
                  return std::tie(specks[a].centre[axis], a) < std::tie(specks[b].centre[axis], b);
              });
    double below = 0.0;
    std::size_t first = 0;  // of the upper part
    while (first + 1 < cluster.members.size()) {
        below += specks[cluster.members[first++]].area;
        if (below >= 0.5 * cluster.area) break;
    }
    const auto middle = cluster.members.begin() + static_cast<std::ptrdiff_t>(first);
    return {cluster_of(specks, {cluster.members.begin(), middle}),
            cluster_of(specks, {middle, cluster.members.end()})};
}

}  // namespace

std::vector<std::vector<std::uint32_t>> cluster_specks(const std::vector<Speck>& specks,
                                                       std::int64_t room) {
    std::array<std::vector<std::uint32_t>, 12> kinds;
    for (std::uint32_t s = 0; s < specks.size(); ++s) kinds[kind_of(specks[s])].push_back(s);
    std::vector<Cluster> clusters;
    std::priority_queue<std::tuple<double, std::size_t>> widest;
    const auto cost = [&](std::size_t c) {
        return specks[clusters[c].members[0]].double_sided ? 2 : 1;
    };
    for (auto& members : kinds) {
        if (members.empty()) continue;
        clusters.push_back(cluster_of(specks, std::move(members)));
        room -= cost(clusters.size() - 1);
        widest.push({clusters.back().moment, clusters.size() - 1});
    }
    while (room > 0 && !widest.empty()) {
        const std::size_t c = std::get<1>(widest.top());
        widest.pop();
        if (clusters[c].members.size() < 2 || cost(c) > room) continue;
        room -= cost(c);
        std::array<Cluster, 2> parts = cut(specks, std::move(clusters[c]));
        clusters[c] = std::move(parts[0]);
        clusters.push_back(std::move(parts[1]));
        widest.push({clusters[c].moment, c});
        widest.push({clusters.back().moment, clusters.size() - 1});
    }
    std::vector<std::vector<std::uint32_t>> out;
    for (const Cluster& cluster : clusters) {
        out.emplace_back();
        for (const std::uint32_t m : cluster.members) out.back().push_back(specks[m].id);
    }
    return out;
}

}  // namespace clgi
