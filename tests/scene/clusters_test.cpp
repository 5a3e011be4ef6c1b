// Boxes around runs of triangles, as the host makes them at load and the device again later.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <algorithm>
#include <clgi/procedural.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "device.hpp"
#include "lab/scenes/rooms.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

std::vector<Cluster> clusters_of(const DeviceScene& scene) {
    return test::download<Cluster>(scene.clusters(), scene.info().cluster_count);
}

// What lies on the device.
struct Uploaded {
    explicit Uploaded(const Scene& world) : scene(test::on_device(world)) {}

    DeviceScene scene;
    std::vector<glm::uvec4> triangles =
        test::download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    std::vector<glm::vec4> positions =
        test::download<glm::vec4>(scene.positions(), scene.info().vertex_count);
    std::vector<Cluster> clusters = clusters_of(scene);
};

// `count` triangles here and there, some on the planes through the origin.
Scene dust(int count) {
    Scene scene = test::plain_scene();
    test::Random random(7);
    for (int i = 0; i < count; ++i) {
        const glm::dvec3 at(random(-1, 1), random(-1, 1), random(-1, 1));
        const auto away = [&] { return glm::dvec3(random(0, 0.1), random(0, 0.1), 0.0); };
        const glm::dvec3 flat(1, 1, i % 3 == 0 ? 0 : 1);
        test::add_triangle(scene, at * flat, (at + away()) * flat, (at + away()) * flat);
    }
    return scene;
}

// Triangles that face nearly one way: one of no area, one seen from both sides.
Scene sheet() {
    Scene scene = test::plain_scene();
    Material both;
    both.double_sided = true;
    scene.materials.push_back(both);
    const auto last = static_cast<std::uint32_t>(scene.materials.size() - 1);
    for (int i = 0; i < 200; ++i) {
        const double x = 0.01 * i;
        test::add_triangle(scene, {x, 0, 0}, {x, i == 20 ? 0 : 1, 0},
                           {x + 0.01, 0, 0.001 * (i % 7)}, i == 150 ? last : 0);
    }
    return scene;
}

// Triangles that face +z, and one in the middle that faces away. Its normal is 1e-24 long, so the
// square of the length is 0.
Scene island() {
    Scene scene = test::plain_scene();
    for (const double y : {-1.0, 0.0})
        test::add_triangle(scene, {-1, y, 0}, {1, y, 0}, {1, y + 1, 0});
    test::add_triangle(scene, {0, 0, 0}, {0, 1e-12, 0}, {1e-12, 0, 0});
    return scene;
}

TEST(Clusters, AreTheLeastBoxesAroundTheirTriangles) {
    for (const int count : {1, 63, 64, 65, 1000}) {
        const Uploaded on(dust(count));
        const auto& [scene, triangles, positions, clusters] = on;
        ASSERT_EQ(clusters.size(), static_cast<std::size_t>((count + 63) / 64));
        for (std::size_t c = 0; c < clusters.size(); ++c) {
            glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
            for (std::size_t t = 64 * c; t < std::min<std::size_t>(64 * c + 64, triangles.size());
                 ++t)
                for (int k = 0; k < 3; ++k) {
                    low = glm::min(low, glm::vec3(positions[triangles[t][k]]));
                    high = glm::max(high, glm::vec3(positions[triangles[t][k]]));
                }
            EXPECT_EQ(clusters[c].low, glm::vec4(low, 0.0f)) << count << ", " << c;
            EXPECT_EQ(clusters[c].high, glm::vec4(high, 0.0f)) << count << ", " << c;
        }
    }
}

// Spheres around every eight triangles: no corner is outside, and one is on it.
TEST(Clusters, HaveSpheresAroundTheirParts) {
    for (const int count : {1, 8, 9, 63, 65, 1000}) {
        const Uploaded on(dust(count));
        const auto& [scene, triangles, positions, clusters] = on;
        for (std::size_t p = 0; p < clusters.size() * CLUSTER_PARTS; ++p) {
            const auto& part = clusters[p / CLUSTER_PARTS].part;
            const std::size_t k = p % CLUSTER_PARTS;
            const glm::dvec3 middle(part[0][k], part[1][k], part[2][k]);
            double farthest = 0.0;
            for (std::size_t t = 8 * p; t < std::min<std::size_t>(8 * p + 8, triangles.size()); ++t)
                for (int c = 0; c < 3; ++c)
                    farthest = std::max(
                        farthest, glm::distance(middle, glm::dvec3(positions[triangles[t][c]])));
            EXPECT_NEAR(part[3][k], farthest, 1e-6 * farthest) << count << ", " << p;
            EXPECT_LT(farthest, 2.0);
            if (8 * p >= triangles.size()) {
                EXPECT_EQ(middle, glm::dvec3(0.0));
            }
        }
    }
}

TEST(Clusters, HaveTheLeastBoxesAroundTheirParts) {
    for (const int count : {1, 8, 9, 63, 65, 1000}) {
        const Uploaded on(dust(count));
        const auto& [scene, triangles, positions, clusters] = on;
        for (std::size_t p = 0; p < clusters.size() * CLUSTER_PARTS; ++p) {
            const Cluster& cluster = clusters[p / CLUSTER_PARTS];
            const std::size_t k = p % CLUSTER_PARTS;
            for (int axis = 0; axis < 3; ++axis) {
                std::vector<float> corners;
                for (std::size_t t = 8 * p; t < std::min<std::size_t>(8 * p + 8, triangles.size());
                     ++t)
                    for (int c = 0; c < 3; ++c) corners.push_back(positions[triangles[t][c]][axis]);
                if (corners.empty()) corners.push_back(0.0f);
                const auto [low, high] = std::minmax_element(corners.begin(), corners.end());
                EXPECT_EQ(cluster.part_low[axis][k], *low) << count << ", " << p;
                EXPECT_EQ(cluster.part_high[axis][k], *high) << count << ", " << p;
            }
        }
    }
}

std::vector<PartCorners> parts_of(const DeviceScene& scene) {
    return test::download<PartCorners>(scene.parts(),
                                       scene.info().cluster_count * std::size_t{CLUSTER_PARTS});
}

// The last triangle stands for those that a part lacks.
TEST(Clusters, HaveTheCornersOfTheirTriangles) {
    for (const int count : {1, 8, 9, 63, 65, 1000}) {
        const Uploaded on(dust(count));
        const std::vector<PartCorners> parts = parts_of(on.scene);
        for (std::size_t t = 0; t < 8 * parts.size(); ++t) {
            const glm::uvec4 triangle = on.triangles[std::min(t, on.triangles.size() - 1)];
            const PartCorners& part = parts[t / 8];
            EXPECT_EQ(part.word[t % 8], triangle.w) << count << ", " << t;
            for (int c = 0; c < 3; ++c)
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_EQ(part.corner[c][axis][t % 8], on.positions[triangle[c]][axis])
                        << count << ", " << t;
        }
    }
}

// Every normal lies in the cone, and triangles seen from both sides have none.
TEST(Clusters, KnowWhichWayTheirTrianglesFace) {
    Scene both = bumpy_mesh();
    both.materials.push_back(both.materials[0]);
    both.materials.back().double_sided = true;
    both.triangles[70].material = static_cast<std::uint32_t>(both.materials.size() - 1);
    for (const Scene& world : {bumpy_mesh(), both, dust(1000)}) {
        const Uploaded on(world);
        const auto& [scene, triangles, positions, clusters] = on;
        std::size_t narrow = 0;
        for (std::size_t c = 0; c < clusters.size(); ++c) {
            const glm::dvec3 axis(clusters[c].cone);
            const double cosine = std::sqrt(1.0 - std::pow(double{clusters[c].cone.w}, 2));
            bool single = true;
            for (std::size_t t = 64 * c; t < std::min<std::size_t>(64 * c + 64, triangles.size());
                 ++t) {
                single = single && !(triangles[t].w & std::uint32_t(TRIANGLE_DOUBLE_SIDED));
                const glm::dvec3 a(positions[triangles[t].x]);
                const glm::dvec3 n = glm::cross(glm::dvec3(positions[triangles[t].y]) - a,
                                                glm::dvec3(positions[triangles[t].z]) - a);
                if (clusters[c].cone.w < 1.0f && glm::length(n) > 0.0) {
                    EXPECT_GE(glm::dot(n, axis) / glm::length(n), cosine - 1e-5) << c;
                }
            }
            EXPECT_TRUE(single || clusters[c].cone.w == 2.0f) << c;
            narrow += clusters[c].cone.w < 0.7f;
        }
        // A smooth mesh faces one way within most of its clusters, dust in none.
        const bool mesh = world.triangles.size() > 1000;
        EXPECT_TRUE(mesh ? narrow > clusters.size() / 2 : narrow == 0) << narrow;
    }
}

TEST(Clusters, AreNotTurnedByATriangleTooSmallToBeSeen) {
    const DeviceScene scene = test::on_device(island());
    EXPECT_EQ(clusters_of(scene)[0].cone, glm::vec4(0, 0, 1, 0));
}

// Sheets one before another, further apart than a cluster is wide, share none.
TEST(Clusters, LieInOneLayerOfSeveral) {
    Scene scene = test::plain_scene();
    test::Random random(3);
    const int sizes[] = {1000, 3000, 700, 5000};  // triangles
    std::vector<std::uint32_t> layer;
    for (std::uint32_t sheet = 0; sheet < 4; ++sheet)
        for (int i = 0; i < sizes[sheet]; ++i) {
            const glm::dvec3 at(random(0, 1), 0.6 * sheet, random(0, 1));
            test::add_triangle(scene, at, at + glm::dvec3(0.01, 0, 0), at + glm::dvec3(0, 0, 0.01));
            layer.push_back(sheet);
        }
    const DeviceScene device = test::on_device(scene);
    std::size_t mixed = 0;
    for (std::size_t t = 0; t < layer.size(); ++t)
        mixed += layer[device.triangle_order()[t]] !=
                 layer[device.triangle_order()[t / CLUSTER_TRIANGLES * CLUSTER_TRIANGLES]];
    EXPECT_LT(mixed, 4u * CLUSTER_TRIANGLES);  // where a sheet ends
}

// Where all are in one place the order is the scene's, and in other places it soon is found.
TEST(Clusters, TakeAnyPlaces) {
    Scene heap = test::plain_scene(), spiral = test::plain_scene();
    for (int i = 0; i < 20000; ++i) {
        test::add_triangle(heap, {1, 2, 3}, {2, 2, 3}, {1, 3, 3});
        const double size = std::exp2(-0.005 * i);
        const glm::dvec3 at(size, -size, size);
        test::add_triangle(spiral, at, 0.999 * at, at + glm::dvec3(0, 0, 0.001 * size));
    }
    const DeviceScene placed = test::on_device(heap);
    EXPECT_TRUE(std::is_sorted(placed.triangle_order().begin(), placed.triangle_order().end()));
    std::vector<std::uint32_t> order = test::on_device(spiral).triangle_order();
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) EXPECT_EQ(order[i], i);
}

// Triangles of one cluster are neighbours: that is what their boxes are good for.
TEST(Clusters, AreSmallInADenseMesh) {
    const DeviceScene scene = test::on_device(bumpy_mesh());
    const std::vector<Cluster> clusters = clusters_of(scene);
    ASSERT_EQ(clusters.size(), (69451u + 63) / 64);
    double sum = 0.0;
    for (const Cluster& cluster : clusters)
        sum += double{glm::length(glm::vec3(cluster.high - cluster.low))};
    // 64 of 69,451 triangles are a patch of 3 % of the surface's extent.
    EXPECT_LT(sum / static_cast<double>(clusters.size()),
              0.06 * 2.0 * double{scene.frame().radius});
}

TEST(Clusters, OfNoTrianglesAreNone) {
    DeviceScene scene = test::on_device(Scene());
    EXPECT_EQ(scene.info().cluster_count, 0u);
    EXPECT_GE(scene.clusters().getInfo<CL_MEM_SIZE>(), sizeof(Cluster));
    const ScenePasses passes(test::programs());
    passes.clusters(test::device().queue, scene).wait();
}

TEST(Clusters, AreTheSameBitsFromTheDevice) {
    const test::Device& on = test::device();
    for (const std::size_t group : {std::size_t{0}, std::size_t{1}, std::size_t{3}}) {
        const ScenePasses passes(test::programs(), {.local_size = group});
        for (const Scene& world :
             {dust(1), dust(64), dust(65), dust(1000), dust(2500), box(), sheet(), island()}) {
            DeviceScene scene = test::on_device(world);
            const std::vector<Cluster> host = clusters_of(scene);
            const std::size_t bytes = host.size() * sizeof(Cluster);
            const std::vector<PartCorners> corners = parts_of(scene);
            const std::size_t corner_bytes = corners.size() * sizeof(PartCorners);
            on.queue.enqueueFillBuffer(scene.clusters(), cl_uchar{0xff}, 0, bytes);
            on.queue.enqueueFillBuffer(scene.parts(), cl_uchar{0xff}, 0, corner_bytes);
            passes.clusters(on.queue, scene);
            EXPECT_EQ(std::memcmp(host.data(), clusters_of(scene).data(), bytes), 0);
            EXPECT_EQ(std::memcmp(corners.data(), parts_of(scene).data(), corner_bytes), 0);
        }
    }
}

}  // namespace
}  // namespace clgi
