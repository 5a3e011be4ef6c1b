// Which vertices hemicubes mark, against what their pixels show.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <set>
#include <utility>

#include "device.hpp"
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
    const GBufferPasses gbuffer(test::programs(), test::usual_build());
    constexpr std::uint32_t size = 32, plane = 16;
    std::vector<float> planes(RECORD_PLANES * plane, 0.0f);
    const glm::dvec3 eyes[2] = {{-0.9, 0.2, 0.1}, {0.1, -0.1, 0.05}},
                     normals[2] = {{1.0, 0.0, 0.0}, glm::normalize(glm::dvec3(0.4, 1.0, -0.3))};
    for (std::uint32_t r = 0; r < 2; ++r) {
        const glm::dvec3 local = scene.frame().scale * (eyes[r] - scene.frame().origin);
        for (std::uint32_t c = 0; c < 3; ++c) {
            const int axis = static_cast<int>(c);
            planes[c * plane + r] = static_cast<float>(local[axis]);
            for (const std::uint32_t first : {RECORD_NORMAL, RECORD_GEOMETRIC})
                planes[(first + c) * plane + r] = static_cast<float>(normals[r][axis]);
        }
    }
    CacheBuffers b;
    b.planes = test::upload(planes);
    b.views = test::empty<View>(10);
    b.visibility = test::empty<std::uint64_t>(6 * size * size);
    CubeParams cube{};
    cube.point_count = 2;
    cube.faces = 5;
    cube.size = size;
    cube.stride = plane;
    cube.near = 1e-5f;
    cube.turned = 1;
    gbuffer.cubes(queue, cube, b.planes, test::upload(std::vector<std::uint32_t>{0, 1}), b.views);
    gbuffer.raster_views(queue, {0, 10, size, size, 6 * size * size}, b.views, scene, b.visibility,
                         Pixels::visibility);
    CacheParams params{};
    params.first = params.count = 1;
    params.stride = plane;
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
        const bool back = glm::dot(normal, eyes[1] - corners[0]) < 0.0;
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
