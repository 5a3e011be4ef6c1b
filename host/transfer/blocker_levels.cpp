// SPDX-License-Identifier: MIT
#include <clgi/blocker_levels.hpp>

#include <clgi/shared/masks.h>
#include <algorithm>
#include <clgi/error.hpp>
#include <string>

#include "opencl/check.hpp"
#include "scene/disjoint_sets.hpp"
#include "scene/weld.hpp"
#include "transfer/nearest_coarse.hpp"
#include "transfer/rings.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t absent = 0xffffffffu;

void check_scene(const Scene& scene, const DeviceScene& device_scene) {
    const std::size_t triangles = device_scene.triangle_order().size();
    if (scene.triangles.size() != triangles ||
        scene.positions.size() != device_scene.file_vertex_count())
        throw Error("blocker_levels: the scene has " + std::to_string(scene.triangles.size()) +
                    " triangles and " + std::to_string(scene.positions.size()) +
                    " vertices, the one on the device " + std::to_string(triangles) + " and " +
                    std::to_string(device_scene.file_vertex_count()));
}

// [vertices of the scene] their places on the device.
std::vector<std::uint32_t> places(const Scene& scene, const DeviceScene& device_scene) {
    std::vector<std::uint32_t> out(scene.positions.size(), absent);
    for (std::uint32_t i = 0; i < device_scene.vertex_order().size(); ++i)
        out[device_scene.vertex_order()[i]] = i;
    return out;
}

void check_coarse(const std::vector<glm::uvec3>& coarse, const std::vector<std::uint32_t>& place) {
    for (std::size_t t = 0; t < coarse.size(); ++t)
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t vertex = coarse[t][k];
            const std::string named = "blocker_levels: coarse triangle " + std::to_string(t) +
                                      " names vertex " + std::to_string(vertex);
            if (vertex >= place.size())
                throw Error(named + ", the scene has " + std::to_string(place.size()));
            if (place[vertex] == absent)
                throw Error(named +
                            ", which is on no triangle of the scene and so not on the device");
        }
}

// Halves of the triangles along the longest axis of their centres' box, split at whole clusters,
// until each cluster is on its own: they are small and all full but the last.
void order_in_clusters(std::uint32_t* first, std::size_t count,
                       const std::vector<glm::dvec3>& centres) {
    constexpr std::size_t cluster = BLOCKER_CLUSTER;
    if (count <= cluster) {
        std::sort(first, first + count);
        return;
    }
    glm::dvec3 low = centres[*first], high = low;
    for (std::size_t i = 0; i < count; ++i) {
        low = glm::min(low, centres[first[i]]);
        high = glm::max(high, centres[first[i]]);
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::size_t clusters = (count + cluster - 1) / cluster;
    const std::size_t half = clusters / 2 * cluster;
    std::nth_element(first, first + half, first + count, [&](std::uint32_t a, std::uint32_t b) {
        const double x = centres[a][axis], y = centres[b][axis];
        return x != y ? x < y : a < b;
    });
    order_in_clusters(first, half, centres);
    order_in_clusters(first + half, count - half, centres);
}

std::vector<std::uint32_t> cluster_order(const Scene& scene,
                                         const std::vector<glm::uvec3>& coarse) {
    std::vector<glm::dvec3> centres;
    std::vector<std::uint32_t> order;
    for (const glm::uvec3& t : coarse) {
        centres.push_back((scene.positions[t.x] + scene.positions[t.y] + scene.positions[t.z]) /
                          3.0);
        order.push_back(static_cast<std::uint32_t>(order.size()));
    }
    order_in_clusters(order.data(), order.size(), centres);
    return order;
}

// [vertices of the scene] what triangles connect, by welded vertices.
std::vector<std::uint32_t> connected(const Scene& scene, const std::vector<std::uint32_t>& welded,
                                     std::uint32_t count) {
    DisjointSets sets(count);
    for (const SceneTriangle& t : scene.triangles)
        for (int k = 1; k < 3; ++k) sets.join(welded[t.vertex[0]], welded[t.vertex[k]]);
    const std::vector<std::uint32_t> number = sets.numbered();
    std::vector<std::uint32_t> out;
    for (const std::uint32_t w : welded) out.push_back(number[w]);
    return out;
}

void sort_once(std::vector<std::uint32_t>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

// Both levels for one receiver.
struct Listed {
    std::vector<std::uint32_t> ranges, near;
    bool known = false;
};

class Lists {
public:
    // fine, coarse: vertices of the scene, in the order of the device and of the clusters. behind:
    // triangles before the coarse ones.
    Lists(const Scene& scene, const std::vector<glm::uvec3>& fine,
          const std::vector<glm::uvec3>& coarse, std::uint32_t behind)
        : welded_(weld(scene.positions, scene.triangles)),
          count_(welded_.empty() ? 0 : *std::max_element(welded_.begin(), welded_.end()) + 1),
          rings_(on_welded(fine), count_),
          coarse_of_(
              nearest_coarse(scene.positions, connected(scene, welded_, count_), fine, coarse)),
          fine_of_(coarse.size()),
          behind_(behind),
          listed_(count_) {
        for (std::uint32_t t = 0; t < fine.size(); ++t)
            if (coarse_of_[t] != absent) fine_of_[coarse_of_[t]].push_back(t);
    }

    const Listed& of(std::uint32_t scene_vertex, int rings) {
        const std::uint32_t vertex = welded_[scene_vertex];
        Listed& out = listed_[vertex];
        if (out.known) return out;
        out.known = true;
        std::vector<std::uint32_t> fine = rings_.around(vertex, rings), own;
        for (const std::uint32_t t : fine)
            if (coarse_of_[t] != absent) own.push_back(coarse_of_[t]);
        sort_once(own);
        for (const std::uint32_t c : own)
            fine.insert(fine.end(), fine_of_[c].begin(), fine_of_[c].end());
        sort_once(fine);
        for (const std::uint32_t t : fine)
            if (!rings_.touches(t, vertex)) out.near.push_back(t);
        add_coarse(own, out);
        return out;
    }

private:
    std::vector<glm::uvec3> on_welded(const std::vector<glm::uvec3>& triangles) const {
        std::vector<glm::uvec3> out;
        for (const glm::uvec3& t : triangles)
            out.emplace_back(welded_[t.x], welded_[t.y], welded_[t.z]);
        return out;
    }

    // All but its own: clusters where whole ones are left, else singles.
    void add_coarse(const std::vector<std::uint32_t>& own, Listed& out) const {
        const auto count = static_cast<std::uint32_t>(fine_of_.size());
        for (std::uint32_t first = 0; first < count; first += BLOCKER_CLUSTER) {
            const std::uint32_t end = std::min(first + BLOCKER_CLUSTER, count);
            const auto from = std::lower_bound(own.begin(), own.end(), first);
            if (from == own.end() || *from >= end) {
                const std::uint32_t cluster = (behind_ + first) / BLOCKER_CLUSTER;
                const std::size_t size = out.ranges.size();
                if (size > 0 && out.ranges[size - 2] + out.ranges[size - 1] == cluster)
                    ++out.ranges[size - 1];
                else
                    out.ranges.insert(out.ranges.end(), {cluster, 1});
                continue;
            }
            for (std::uint32_t c = first; c < end; ++c)
                if (!std::binary_search(own.begin(), own.end(), c)) out.near.push_back(behind_ + c);
        }
    }

    std::vector<std::uint32_t> welded_;
    std::uint32_t count_;  // welded vertices
    Rings rings_;
    std::vector<std::uint32_t> coarse_of_;             // [fine]
    std::vector<std::vector<std::uint32_t>> fine_of_;  // [coarse]
    std::uint32_t behind_;
    std::vector<Listed> listed_;  // [welded]
};

}  // namespace

BlockerLevels blocker_levels(const Scene& scene, const DeviceScene& device_scene,
                             const std::vector<glm::uvec3>& coarse, int rings) {
    need_range("blocker_levels", "rings", rings, 0, 2);
    check_scene(scene, device_scene);
    const std::vector<std::uint32_t> place = places(scene, device_scene);
    check_coarse(coarse, place);

    BlockerLevels out;
    std::vector<glm::uvec3> fine;  // vertices of the scene
    const auto add = [&](const glm::uvec3& t) {
        out.triangles.emplace_back(place[t.x], place[t.y], place[t.z], 0);
    };
    for (const std::uint32_t t : device_scene.triangle_order()) {
        const std::uint32_t* v = scene.triangles[t].vertex;
        fine.emplace_back(v[0], v[1], v[2]);
        add(fine.back());
    }
    out.fine_count = static_cast<std::uint32_t>(fine.size());
    const std::uint32_t clusters = (out.fine_count + BLOCKER_CLUSTER - 1) / BLOCKER_CLUSTER;
    if (coarse.empty()) {
        out.lists = {0, 1};
        out.ranges = {0, clusters};
        return out;
    }
    // Points at a corner of the last triangle: the box of its cluster stays as it is.
    const std::uint32_t point = out.triangles.back().x;
    out.triangles.resize(std::size_t{clusters} * BLOCKER_CLUSTER,
                         glm::uvec4(point, point, point, 0));
    std::vector<glm::uvec3> ordered;
    for (const std::uint32_t t : cluster_order(scene, coarse)) {
        ordered.push_back(coarse[t]);
        add(coarse[t]);
    }
    Lists lists(scene, fine, ordered, clusters * BLOCKER_CLUSTER);
    out.receivers_per_list = 1;
    out.lists = {0};
    out.near_lists = {0};
    for (const std::uint32_t vertex : device_scene.vertex_order()) {
        const Listed& listed = lists.of(vertex, rings);
        out.ranges.insert(out.ranges.end(), listed.ranges.begin(), listed.ranges.end());
        out.lists.push_back(static_cast<std::uint32_t>(out.ranges.size() / 2));
        out.near.insert(out.near.end(), listed.near.begin(), listed.near.end());
        out.near_lists.push_back(static_cast<std::uint32_t>(out.near.size()));
    }
    if (out.ranges.empty()) out.ranges = {0, 0};
    if (out.near.empty()) out.near_lists.clear();
    return out;
}

}  // namespace clgi
