// The two-level mesh hierarchy of blockers [Kautz04, section 3.2]: near a receiver the triangles of
// the scene itself block, for the remaining parts a coarse mesh.
//
// Coarse triangles use vertices of the scene, so they follow every pose. Each triangle of the scene
// belongs to the coarse one that stands for it. A receiver does not see the coarse triangles that
// stand for its surroundings: they would cover it wherever the surface is hollow. It sees all
// triangles that belong to them instead.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/scene.hpp>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

// What MaskPasses::blockers and BlockerBuffers take, for receivers that are the vertices of a
// DeviceScene, in its order.
struct BlockerLevels {
    // Vertices of the device, and 0. The triangles of the device in its order come first; then
    // points, which block nothing, up to a whole cluster; then the coarse triangles, in clusters
    // that are small in space in the scene's own pose.
    std::vector<glm::uvec4> triangles;
    std::uint32_t fine_count = 0;  // triangles of the device

    // Clusters of BlockerBuffers: for each vertex, those coarse ones that hold no triangle that it
    // must not see; without a coarse mesh, all clusters for all vertices.
    std::vector<std::uint32_t> lists;
    std::vector<std::uint32_t> ranges;
    std::uint32_t receivers_per_list = ~0u;  // 1 with a coarse mesh

    // Singles of BlockerBuffers, ascending: for each vertex of the device the fine triangles near
    // it, and what is left of the other coarse clusters. Both are empty without a coarse mesh.
    std::vector<std::uint32_t> near_lists;  // [vertices + 1] where each begins in `near`
    std::vector<std::uint32_t> near;
};

// coarse: vertices of the scene; mesh::simplify of clgi::mesh makes such triangles. rings: 0 to 2;
// the surroundings of a vertex are the triangles with a corner at most this many edges away.
// Vertices in one place count as one (clgi/advanced/adjacency.hpp). Triangles that touch the vertex
// itself are in no list: it sees them edge-on. A piece of the scene without any coarse triangle is
// part of the coarse mesh as it is. most_bytes: of all lists; 0: what the device allows for one
// buffer. The fewer coarse triangles, the longer lists are: they hold all that the coarse triangles
// near a vertex stand for. Throws DeviceError when that is too much, before it is listed, and Error
// when the scene is not the one on the device, when rings is out of range, and for coarse triangles
// with vertices that the scene has not or that are not on the device.
CLGI_API BlockerLevels blocker_levels(const Scene& scene, const DeviceScene& device_scene,
                                      const std::vector<glm::uvec3>& coarse, int rings,
                                      std::size_t most_bytes = 0);

}  // namespace clgi
