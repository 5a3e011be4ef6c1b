// SPDX-License-Identifier: MIT
#include <clgi/blocker_levels.hpp>

#include <clgi/shared/masks.h>
#include <algorithm>
#include <clgi/error.hpp>
#include <string>

#include "opencl/check.hpp"
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

// Triangles around the vertices of a mesh.
class Rings {
public:
    // corners: welded vertices of each triangle.
    Rings(const std::vector<glm::uvec3>& corners, std::uint32_t vertices)
        : corners_(corners),
          first_(vertices + std::size_t{1}, 0),
          vertex_seen_(vertices, absent),
          triangle_seen_(corners.size(), absent) {
        for (const glm::uvec3& t : corners)
            for (int k = 0; k < 3; ++k) ++first_[t[k] + std::size_t{1}];
        for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
        around_.resize(first_.back());
        std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
        for (std::uint32_t t = 0; t < corners.size(); ++t)
            for (int k = 0; k < 3; ++k) around_[next[corners[t][k]]++] = t;
    }

    // Triangles with a corner at most `rings` edges away but not at the vertex itself, ascending.
    std::vector<std::uint32_t> near(std::uint32_t vertex, int rings) {
        std::vector<std::uint32_t> vertices{vertex}, out;
        vertex_seen_[vertex] = vertex;
        std::size_t begin = 0;
        for (int ring = 0; ring <= rings; ++ring) {
            const std::size_t end = vertices.size();
            for (; begin < end; ++begin)
                for (std::uint32_t i = first_[vertices[begin]]; i < first_[vertices[begin] + 1];
                     ++i) {
                    const std::uint32_t t = around_[i];
                    if (triangle_seen_[t] == vertex) continue;
                    triangle_seen_[t] = vertex;
                    if (ring > 0) out.push_back(t);  // those of ring 0 touch the vertex
                    for (int k = 0; k < 3; ++k) {
                        const std::uint32_t other = corners_[t][k];
                        if (vertex_seen_[other] == vertex) continue;
                        vertex_seen_[other] = vertex;
                        vertices.push_back(other);
                    }
                }
        }
        std::sort(out.begin(), out.end());
        return out;
    }

private:
    const std::vector<glm::uvec3>& corners_;
    std::vector<std::uint32_t> first_, around_;               // triangles of each vertex
    std::vector<std::uint32_t> vertex_seen_, triangle_seen_;  // by the search around this vertex
};

void add_near(const Scene& scene, const DeviceScene& device_scene, int rings, BlockerLevels& out) {
    const std::vector<std::uint32_t> welded = weld(scene.positions, scene.triangles);
    const std::uint32_t count =
        welded.empty() ? 0 : *std::max_element(welded.begin(), welded.end()) + 1;
    std::vector<glm::uvec3> corners;
    for (const std::uint32_t t : device_scene.triangle_order()) {
        const std::uint32_t* v = scene.triangles[t].vertex;
        corners.emplace_back(welded[v[0]], welded[v[1]], welded[v[2]]);
    }
    Rings mesh(corners, count);
    std::vector<std::vector<std::uint32_t>> near(count);  // of each welded vertex
    std::vector<bool> known(count, false);
    out.near_lists.push_back(0);
    for (const std::uint32_t vertex : device_scene.vertex_order()) {
        const std::uint32_t w = welded[vertex];
        if (!known[w]) near[w] = mesh.near(w, rings);
        known[w] = true;
        out.near.insert(out.near.end(), near[w].begin(), near[w].end());
        out.near_lists.push_back(static_cast<std::uint32_t>(out.near.size()));
    }
    if (out.near.empty()) out.near_lists.clear();
}

}  // namespace

BlockerLevels blocker_levels(const Scene& scene, const DeviceScene& device_scene,
                             const std::vector<glm::uvec3>& coarse, int rings) {
    need_range("blocker_levels", "rings", rings, 0, 2);
    check_scene(scene, device_scene);
    const std::vector<std::uint32_t> place = places(scene, device_scene);
    check_coarse(coarse, place);

    BlockerLevels out;
    for (const std::uint32_t t : device_scene.triangle_order()) {
        const std::uint32_t* v = scene.triangles[t].vertex;
        out.triangles.emplace_back(place[v[0]], place[v[1]], place[v[2]], 0);
    }
    out.fine_count = static_cast<std::uint32_t>(out.triangles.size());
    const std::uint32_t clusters = (out.fine_count + BLOCKER_CLUSTER - 1) / BLOCKER_CLUSTER;
    out.lists = {0, 1};
    if (coarse.empty()) {
        out.ranges = {0, clusters};
        return out;
    }
    // Points at a corner of the last triangle: the box of its cluster stays as it is.
    const std::uint32_t point = out.triangles.empty() ? 0 : out.triangles.back().x;
    out.triangles.resize(std::size_t{clusters} * BLOCKER_CLUSTER,
                         glm::uvec4(point, point, point, 0));
    for (const std::uint32_t t : cluster_order(scene, coarse))
        out.triangles.emplace_back(place[coarse[t].x], place[coarse[t].y], place[coarse[t].z], 0);
    const auto coarse_count = static_cast<std::uint32_t>(coarse.size());
    out.ranges = {clusters, (coarse_count + BLOCKER_CLUSTER - 1) / BLOCKER_CLUSTER};
    add_near(scene, device_scene, rings, out);
    return out;
}

}  // namespace clgi
