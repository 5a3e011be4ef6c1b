// SPDX-License-Identifier: MIT
#include <clgi/advanced/blocker_levels.hpp>

#include <clgi/shared/masks.h>
#include <algorithm>
#include <clgi/error.hpp>
#include <string>
#include <utility>

#include "core/opencl/check.hpp"
#include "methods/transfer/nearest_coarse.hpp"
#include "methods/transfer/rings.hpp"
#include "scene/disjoint_sets.hpp"
#include "scene/weld.hpp"

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

// The coarse triangles, and the scene's own where a piece has none of them.
std::vector<glm::uvec3> with_lacking(std::vector<glm::uvec3> coarse,
                                     const std::vector<glm::uvec3>& fine,
                                     const std::vector<std::uint32_t>& pieces) {
    std::vector<bool> has(pieces.size(), false);
    for (const glm::uvec3& t : coarse) has[pieces[t.x]] = true;
    for (const glm::uvec3& t : fine)
        if (!has[pieces[t.x]]) coarse.push_back(t);
    return coarse;
}

class Lists {
public:
    // fine: vertices of the scene, in the order of the device; coarse_of: the place of the coarse
    // triangle that stands for each. coarse: how many there are. welded: below count. behind:
    // triangles before the coarse ones.
    Lists(std::vector<std::uint32_t> coarse_of, const std::vector<glm::uvec3>& fine,
          std::size_t coarse, const std::vector<std::uint32_t>& welded, std::uint32_t count,
          std::uint32_t behind)
        : welded_(welded),
          rings_(on_welded(fine), count),
          coarse_of_(std::move(coarse_of)),
          fine_of_(coarse),
          behind_(behind),
          listed_(count) {
        for (std::uint32_t t = 0; t < fine.size(); ++t)
            if (coarse_of_[t] != absent) fine_of_[coarse_of_[t]].push_back(t);
    }

    // Words that the ranges and singles of a vertex take at most.
    std::size_t words(std::uint32_t scene_vertex, int rings) {
        const std::uint32_t vertex = welded_[scene_vertex];
        std::size_t& out = listed_[vertex].words;
        if (out > 0) return out;
        const std::vector<std::uint32_t> fine = rings_.around(vertex, rings);
        const std::vector<std::uint32_t> own = coarse_of(fine);
        out = 2 * (own.size() + 1);  // a range before each and one behind
        for (const std::uint32_t c : own) out += fine_of_[c].size();
        for (const std::uint32_t t : fine) out += coarse_of_[t] == absent;
        std::uint32_t cluster = absent;
        for (const std::uint32_t c : own)
            if (c / BLOCKER_CLUSTER != cluster) {
                cluster = c / BLOCKER_CLUSTER;
                out += BLOCKER_CLUSTER;
            }
        return out;
    }

    // Adds the ranges and singles of a vertex to `out`.
    void add(std::uint32_t scene_vertex, int rings, BlockerLevels& out) {
        const std::uint32_t vertex = welded_[scene_vertex];
        Listed& listed = listed_[vertex];
        if (listed.known) {
            repeat(out.ranges, listed.ranges);
            repeat(out.near, listed.near);
            return;
        }
        listed.ranges.first = out.ranges.size();
        listed.near.first = out.near.size();
        listed.known = true;
        std::vector<std::uint32_t> fine = rings_.around(vertex, rings);
        const std::vector<std::uint32_t> own = coarse_of(fine);
        for (const std::uint32_t c : own)
            fine.insert(fine.end(), fine_of_[c].begin(), fine_of_[c].end());
        sort_once(fine);
        for (const std::uint32_t t : fine)
            if (!rings_.touches(t, vertex)) out.near.push_back(t);
        add_coarse(own, listed.ranges.first, out);
        listed.ranges.second = out.ranges.size();
        listed.near.second = out.near.size();
    }

private:
    using Run = std::pair<std::size_t, std::size_t>;  // first and end
    struct Listed {                                   // what has been added for a welded vertex
        Run ranges, near;
        std::size_t words = 0;
        bool known = false;
    };

    // Those that stand for some fine triangles, ascending.
    std::vector<std::uint32_t> coarse_of(const std::vector<std::uint32_t>& fine) const {
        std::vector<std::uint32_t> out;
        for (const std::uint32_t t : fine)
            if (coarse_of_[t] != absent) out.push_back(coarse_of_[t]);
        sort_once(out);
        return out;
    }

    static void repeat(std::vector<std::uint32_t>& values, const Run& run) {
        for (std::size_t i = run.first; i < run.second; ++i)
            values.push_back(std::uint32_t{values[i]});
    }

    std::vector<glm::uvec3> on_welded(const std::vector<glm::uvec3>& triangles) const {
        std::vector<glm::uvec3> out;
        for (const glm::uvec3& t : triangles)
            out.emplace_back(welded_[t.x], welded_[t.y], welded_[t.z]);
        return out;
    }

    // All but its own: clusters where whole ones are left, else singles.
    void add_coarse(const std::vector<std::uint32_t>& own, std::size_t first_range,
                    BlockerLevels& out) const {
        const auto count = static_cast<std::uint32_t>(fine_of_.size());
        for (std::uint32_t first = 0; first < count; first += BLOCKER_CLUSTER) {
            const std::uint32_t end = std::min(first + BLOCKER_CLUSTER, count);
            const auto from = std::lower_bound(own.begin(), own.end(), first);
            if (from == own.end() || *from >= end) {
                const std::uint32_t cluster = (behind_ + first) / BLOCKER_CLUSTER;
                const std::size_t size = out.ranges.size();
                if (size > first_range && out.ranges[size - 2] + out.ranges[size - 1] == cluster)
                    ++out.ranges[size - 1];
                else
                    out.ranges.insert(out.ranges.end(), {cluster, 1});
                continue;
            }
            for (std::uint32_t c = first; c < end; ++c)
                if (!std::binary_search(own.begin(), own.end(), c)) out.near.push_back(behind_ + c);
        }
    }

    const std::vector<std::uint32_t>& welded_;
    Rings rings_;
    std::vector<std::uint32_t> coarse_of_;             // [fine]
    std::vector<std::vector<std::uint32_t>> fine_of_;  // [coarse]
    std::uint32_t behind_;
    std::vector<Listed> listed_;  // [welded]
};

// Words that all lists need, before anything is listed: the fewer coarse triangles, the more each
// stands for.
std::size_t need_room(Lists& lists, int rings, const DeviceScene& scene, std::size_t most_bytes,
                      std::size_t coarse) {
    // Places in lists are numbers of 32 bits.
    std::size_t most = std::size_t{absent} * sizeof(std::uint32_t);
    if (most_bytes > 0) most = std::min(most, most_bytes);
    const auto context = scene.positions().getInfo<CL_MEM_CONTEXT>();
    for (const cl::Device& device : context.getInfo<CL_CONTEXT_DEVICES>())
        most = std::min<std::size_t>(most, device.getInfo<CL_DEVICE_MAX_MEM_ALLOC_SIZE>());
    std::size_t words = 0;
    for (const std::uint32_t vertex : scene.vertex_order()) words += lists.words(vertex, rings);
    if (words * sizeof(std::uint32_t) > most)
        throw DeviceError(
            "blocker_levels: the vertices' lists of triangles need up to " +
            std::to_string(words * sizeof(std::uint32_t)) + " bytes, " + std::to_string(most) +
            " are allowed; give more triangles in coarse, which has " + std::to_string(coarse));
    return words;
}

}  // namespace

BlockerLevels blocker_levels(const Scene& scene, const DeviceScene& device_scene,
                             const std::vector<glm::uvec3>& coarse, int rings,
                             std::size_t most_bytes) {
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
    const std::vector<std::uint32_t> welded = weld(scene.positions, scene.triangles);
    const std::uint32_t count = *std::max_element(welded.begin(), welded.end()) + 1;
    const std::vector<std::uint32_t> pieces = connected(scene, welded, count);
    const std::vector<glm::uvec3> all = with_lacking(coarse, fine, pieces);
    std::vector<glm::uvec3> ordered;
    for (const std::uint32_t t : cluster_order(scene, all)) {
        ordered.push_back(all[t]);
        add(all[t]);
    }
    Lists lists(nearest_coarse(scene.positions, pieces, fine, ordered), fine, ordered.size(),
                welded, count, clusters * BLOCKER_CLUSTER);
    out.near.reserve(need_room(lists, rings, device_scene, most_bytes, coarse.size()));
    out.receivers_per_list = 1;
    out.lists = {0};
    out.near_lists = {0};
    for (const std::uint32_t vertex : device_scene.vertex_order()) {
        lists.add(vertex, rings, out);
        out.lists.push_back(static_cast<std::uint32_t>(out.ranges.size() / 2));
        out.near_lists.push_back(static_cast<std::uint32_t>(out.near.size()));
    }
    if (out.ranges.empty()) out.ranges = {0, 0};
    if (out.near.empty()) out.near_lists.clear();
    return out;
}

}  // namespace clgi
