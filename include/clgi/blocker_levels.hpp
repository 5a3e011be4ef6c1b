// The two-level mesh hierarchy of blockers [Kautz04, section 3.2]: far from a receiver a coarse
// mesh blocks, near it the triangles of the scene itself.
//
// Coarse triangles use vertices of the scene, so they follow every pose. Both levels overlap, which
// does no harm: masks are unions.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <clgi/export.hpp>
#include <clgi/scene.hpp>
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

    // The far level, one list for all receivers (receivers_per_list = ~0u): the coarse clusters;
    // without a coarse mesh, all clusters.
    std::vector<std::uint32_t> lists;
    std::vector<std::uint32_t> ranges;

    // The near level: fine triangles for each vertex of the device, ascending. Both are empty when
    // there is no coarse mesh or no vertex has a triangle near it.
    std::vector<std::uint32_t> near_lists;  // [vertices + 1] where each begins in `near`
    std::vector<std::uint32_t> near;
};

// coarse: vertices of the scene; mesh::simplify of clgi::mesh makes such triangles. rings: 0 to 2;
// near a vertex are the triangles with a corner at most this many edges away. Vertices in one place
// count as one (clgi/adjacency.hpp). The triangles that touch the vertex itself are left out: it
// sees them edge-on.
// Throws Error when the scene is not the one on the device, when rings is out of range, and for
// coarse triangles with vertices that the scene has not or that are not on the device.
CLGI_API BlockerLevels blocker_levels(const Scene& scene, const DeviceScene& device_scene,
                                      const std::vector<glm::uvec3>& coarse, int rings);

}  // namespace clgi
