// Coarse meshes that are too coarse, and those that lack parts of the scene.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/blocker_levels.hpp>
#include <clgi/dynamic_transfer.hpp>
#include <set>

#include "transfer_scenes.hpp"

namespace clgi {
namespace {

// Triangles of the device that a vertex lists, by their places.
std::multiset<std::uint32_t> listed(const BlockerLevels& levels, std::size_t vertex) {
    std::multiset<std::uint32_t> out;
    for (std::uint32_t i = levels.near_lists[vertex]; i < levels.near_lists[vertex + 1]; ++i)
        out.insert(levels.near[i]);
    for (std::uint32_t i = levels.lists[vertex]; i < levels.lists[vertex + 1]; ++i)
        for (std::uint32_t t = 64 * levels.ranges[2 * i];
             t < 64 * (levels.ranges[2 * i] + levels.ranges[2 * i + 1]); ++t)
            if (t < levels.triangles.size()) out.insert(t);
    return out;
}

std::vector<glm::uvec3> triangles_of(const Scene& scene, std::size_t first, std::size_t count) {
    std::vector<glm::uvec3> out;
    for (std::size_t t = first; t < first + count; ++t) {
        const std::uint32_t* v = scene.triangles[t].vertex;
        out.emplace_back(v[0], v[1], v[2]);
    }
    return out;
}

// Four triangles for 1,280: each vertex lists a quarter of the scene and more.
TEST(BlockerLimits, RefuseACoarseMeshWhoseListsAreTooLong) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 3);
    const DeviceScene device = test::on_device(scene);
    const auto coarse = triangles_of(scene, 0, 4);
    const BlockerLevels levels = blocker_levels(scene, device, coarse, 1);
    const std::size_t bytes = 4 * (levels.near.size() + levels.ranges.size());
    EXPECT_GT(bytes, 4u * 642 * 300);
    const auto text = [&](std::size_t most) {
        try {
            const BlockerLevels again = blocker_levels(scene, device, coarse, 1, most);
            EXPECT_EQ(again.near, levels.near);
            return std::string();
        } catch (const DeviceError& error) {
            return std::string(error.what());
        }
    };
    const std::string refused = text(bytes - 1);
    EXPECT_NE(refused.find(std::to_string(bytes - 1) +
                           " are allowed; give more triangles in coarse, which has 4"),
              std::string::npos)
        << refused;
    EXPECT_EQ(text(bytes + bytes / 2), "");
    // The solver's budget is that of lists as well.
    DynamicTransferOptions options;
    options.coarse = coarse;
    options.memory_budget = 100000;
    test::light_by(scene, {1, 1, 1});
    try {
        DynamicTransferSolver(test::programs(), test::device().queue, scene, device, options);
        ADD_FAILURE();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("coarse"), std::string::npos) << error.what();
    }
}

// A sphere has a coarse mesh, the ceiling above it has none: it is its own.
TEST(BlockerLimits, KeepThePiecesThatACoarseMeshLacks) {
    Scene scene = test::plain_scene();
    test::add_sphere(scene, {0, 0, 0}, 1.0, 2);
    const std::size_t ball = scene.triangles.size();
    const auto coarse = triangles_of(scene, 0, ball);
    for (int i = 0; i < 40; ++i)
        test::add_quad(
            scene, {glm::dvec3(i - 20, 3, 9), {i - 20, 3, -9}, {i - 19, 3, -9}, {i - 19, 3, 9}});
    const DeviceScene device = test::on_device(scene);
    const BlockerLevels levels = blocker_levels(scene, device, coarse, 0);
    const std::size_t clusters = (scene.triangles.size() + 63) / 64;
    EXPECT_EQ(levels.triangles.size(), 64 * clusters + scene.triangles.size());
    for (std::size_t i = 0; i < device.vertex_order().size(); ++i) {
        const bool above = scene.positions[device.vertex_order()[i]].y > 2;
        std::size_t ceiling = 0;
        for (const std::uint32_t t : listed(levels, i)) {
            const glm::uvec4 v = levels.triangles[t];
            if (v.x == v.y) continue;  // points
            ceiling += scene.positions[device.vertex_order()[v.x]].y > 2;
        }
        // Those that touch a vertex are in no list of it.
        EXPECT_GE(ceiling, above ? 74u : 80u) << i;
        EXPECT_LE(ceiling, 80u) << i;
    }
    // So vertices of the ball see the ceiling as without a coarse mesh.
    test::light_by(scene, {1, 1, 1});
    std::vector<std::vector<glm::dvec3>> found;
    for (const bool far : {false, true}) {
        DynamicTransferOptions options;
        if (far) options.coarse = coarse;
        DynamicTransferSolver solver(test::programs(), test::device().queue, scene, device,
                                     options);
        ASSERT_TRUE(solver.run());
        found.push_back(test::irradiance_of(solver, device));
    }
    EXPECT_EQ(found[0], found[1]);
}

}  // namespace
}  // namespace clgi
