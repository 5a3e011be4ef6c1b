// Which vertices hemicubes mark, against what their pixels show.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <set>
#include <utility>

#include "device.hpp"
#include "record_cubes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using Side = std::pair<std::uint32_t, bool>;  // of a vertex; whether it is the back

// The second of two records among boxes that turn their fronts and backs: all of its five faces,
// and bits of many words.
TEST(CachePasses, MarkWhatTheFacesOfARecordShow) {
    Scene room = test::plain_scene();
    test::add_box(room, {-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, -1);
    for (int i = 0; i < 8; ++i) {
        const glm::dvec3 at(i & 1 ? 0.5 : -0.6, i & 2 ? 0.55 : -0.5, i & 4 ? 0.6 : -0.55);
        test::add_box(room, at, at + glm::dvec3(0.15, 0.2, 0.1), i % 3 == 0 ? -1 : 1);
    }
    const DeviceScene scene = test::on_device(room);
    const cl::CommandQueue& queue = test::device().queue;
    const CachePasses passes(test::programs(), test::usual_build());
    constexpr std::uint32_t size = 32;
    const glm::dvec3 eye(0.1, -0.1, 0.05);
    const CacheBuffers b = test::record_cubes(
        scene,
        {{{-0.9, 0.2, 0.1}, {1.0, 0.0, 0.0}}, {eye, glm::normalize(glm::dvec3(0.4, 1.0, -0.3))}},
        size);
    CacheParams params{};
    params.first = params.count = 1;
    params.stride = test::record_stride;
    params.size = size;
    SpotBuffers spots;
    const std::uint32_t vertices = scene.info().vertex_count;
    std::vector<std::uint32_t> seen((2 * vertices + 31) / 32, 0u);
    spots.seen = test::upload(seen);
    passes.mark(queue, params, scene, b, spots);
    queue.enqueueReadBuffer(spots.seen, CL_TRUE, 0, seen.size() * sizeof seen[0], seen.data());

    std::vector<std::uint64_t> words(6 * size * size);
    queue.enqueueReadBuffer(b.visibility, CL_TRUE, 0, words.size() * sizeof words[0], words.data());
    std::vector<glm::uvec4> triangles(scene.info().triangle_count);
    queue.enqueueReadBuffer(scene.triangles(), CL_TRUE, 0, triangles.size() * sizeof triangles[0],
                            triangles.data());
    std::set<Side> wanted;
    for (std::size_t i = 3 * size * size; i < words.size(); ++i) {  // the second record's half
        const auto triangle = static_cast<std::uint32_t>(words[i]);
        if (triangle == ~0u) continue;
        glm::dvec3 corners[3];
        for (int k = 0; k < 3; ++k)
            corners[k] = room.positions[scene.vertex_order()[triangles[triangle][k]]];
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        const bool back = glm::dot(normal, eye - corners[0]) < 0.0;
        for (int k = 0; k < 3; ++k) wanted.insert({triangles[triangle][k], back});
    }
    std::set<Side> found;
    for (std::uint32_t bit = 0; bit < 2 * vertices; ++bit)
        if (seen[bit / 32] >> bit % 32 & 1u) found.insert({bit / 2, bit % 2 == 1});
    EXPECT_EQ(found, wanted);
    EXPECT_GT(wanted.size(), 30u);
    EXPECT_LT(wanted.size(), 2 * std::size_t{vertices});
}

}  // namespace
}  // namespace clgi
