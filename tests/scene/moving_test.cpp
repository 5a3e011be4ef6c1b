// Geometry that moves on the device gives the bits of a scene that was loaded that way.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <clgi/scene_mover.hpp>
#include <limits>

#include "box_trees.hpp"
#include "frames.hpp"
#include "turning.hpp"

namespace clgi {
namespace {

SecondOrderOptions moving_frame() {
    SecondOrderOptions options;
    options.width = 160;
    options.height = 120;
    options.emitters.vpls = 150;
    options.negative_vpls = 50;
    return options;
}

std::vector<glm::vec3> radiance(const DeviceScene& scene, SecondOrderSolver& solver,
                                const Camera& camera, const WaitList& wait = {}) {
    solver.render(camera, wait).wait();
    return test::read_frame(test::device().queue, scene, solver).radiance;
}

std::vector<glm::vec3> fresh_radiance(const Scene& scene) {
    return test::render(scene, scene.cameras[0], moving_frame()).radiance;
}

// Every position, normal and cluster, and the picture, are those of a fresh load.
void expect_fresh(const DeviceScene& moved, SecondOrderSolver& solver, const Scene& scene) {
    const DeviceScene fresh = test::on_device(scene);
    EXPECT_EQ(moved.frame().origin, fresh.frame().origin);
    EXPECT_EQ(moved.frame().scale, fresh.frame().scale);
    EXPECT_EQ(moved.frame().radius, fresh.frame().radius);
    EXPECT_TRUE(test::same_bits(test::vertex_bits(moved), test::vertex_bits(fresh)));
    const auto got = radiance(moved, solver, scene.cameras[0]);
    const auto wanted = fresh_radiance(scene);
    ASSERT_EQ(got.size(), wanted.size());
    std::size_t other = 0;
    for (std::size_t p = 0; p < got.size(); ++p) other += got[p] != wanted[p];
    EXPECT_EQ(other, 0u) << "of " << got.size() << " pixels";
    EXPECT_TRUE(test::same_bits(got, wanted));
}

TEST(MovingGeometry, OfTheHostGivesTheBitsOfAFreshLoad) {
    const test::Turning turning = test::bunny();
    DeviceScene scene = test::on_device(turning.rest);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, moving_frame());
    SceneMover mover(test::programs(), test::device().queue, scene);
    const auto at_rest = fresh_radiance(turning.rest);
    for (int frame = 1; frame <= 6; ++frame) {
        const Scene turned = turning.turned(0.37 * frame);
        const auto from = turned.positions.begin() + turning.first;
        const auto normals_from = turned.normals.begin() + turning.first;
        mover.move(turning.first, {from, from + turning.count},
                   {normals_from, normals_from + turning.count});
        expect_fresh(scene, solver, turned);
        EXPECT_FALSE(test::same_bits(radiance(scene, solver, turned.cameras[0]), at_rest));
        const MoveStatus status = mover.status();
        EXPECT_EQ(status.not_finite, 0u);
        EXPECT_TRUE(status.fits);
    }
}

TEST(MovingGeometry, OfTheCallersBuffersGivesTheBitsOfAFreshLoad) {
    const test::Turning turning = test::bunny();
    DeviceScene scene = test::on_device(turning.rest);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, moving_frame());
    SceneMover mover(test::programs(), test::device().queue, scene);
    for (int frame = 1; frame <= 6; ++frame) {
        Scene turned = turning.turned(0.41 * frame);
        mover.move(test::buffers_of(turned, turning.first, turning.count));
        expect_fresh(scene, solver, turned);
    }
}

TEST(MovingGeometry, FarFromTheWorldsOriginIsAsExact) {
    const test::Turning turning = test::bunny({1e6, -3e5, 7654321.123});
    DeviceScene scene = test::on_device(turning.rest);
    SecondOrderSolver solver(test::programs(), test::device().queue, scene, moving_frame());
    SceneMover mover(test::programs(), test::device().queue, scene);
    for (const glm::dvec3& origin :
         {glm::dvec3(1e6, -3e5, 7654321.123), glm::dvec3(1000001.1, -3e5, 7654320.7)}) {
        Scene turned = turning.turned(origin.x > 1e6 ? 1.0 : 2.0);
        mover.move(test::buffers_of(turned, turning.first, turning.count, origin));
        expect_fresh(scene, solver, turned);
    }
}

// Fast math may reorder sums of floats, and positions are none.
TEST(MovingGeometry, IsPlacedAlikeByFastMath) {
    const test::Turning turning = test::bunny({1e6, 0, 0});
    DeviceScene scene = test::on_device(turning.rest);
    SceneMover mover(test::programs(), test::device().queue, scene,
                     {.math = Math::fast, .local_size = 7});
    Scene turned = turning.turned(0.5);
    mover.move(test::buffers_of(turned, turning.first, turning.count, {999999.3, 0, 0.1}));
    EXPECT_TRUE(
        test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(turned))));
}

// The caller moves what it likes in as many calls as it likes.
TEST(MovingGeometry, MayBeAPartOfTheVertices) {
    const test::Turning turning = test::bunny();
    DeviceScene scene = test::on_device(turning.rest);
    SceneMover mover(test::programs(), test::device().queue, scene);
    const Scene whole = turning.turned(0.8);
    Scene half = turning.rest;
    const std::uint32_t first = turning.first + 1001, count = turning.count / 2;
    for (std::uint32_t v = first; v < first + count; ++v) {
        half.positions[v] = whole.positions[v];
        half.normals[v] = whole.normals[v];
    }
    MovedVertices moved = test::buffers_of(half, first, count);
    mover.move(moved);
    EXPECT_TRUE(
        test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(half))));
    // Without normals, which stay.
    for (std::uint32_t v = first; v < first + count; ++v)
        half.positions[v] = turning.rest.positions[v];
    moved = test::buffers_of(half, first, count);
    moved.normals = cl::Buffer();
    mover.move(moved);
    EXPECT_TRUE(
        test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(half))));
    for (std::uint32_t v = first; v < first + count; ++v) half.positions[v].y += 0.01;
    const auto from = half.positions.begin() + first;
    mover.move(first, {from, from + count}, {});
    EXPECT_TRUE(
        test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(half))));
    mover.move(first, {}, {}).wait();  // nothing at all
    EXPECT_TRUE(
        test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(half))));
}

TEST(MovingGeometry, MovesTheBoxesOfClusters) {
    const test::Turning turning = test::bunny();
    DeviceScene scene = test::on_device(turning.rest);
    SceneMover mover(test::programs(), test::device().queue, scene);
    Scene turned = turning.turned(1.3);
    mover.move(test::buffers_of(turned, turning.first, turning.count));
    const auto triangles =
        test::download<glm::uvec4>(scene.triangles(), scene.info().triangle_count);
    const auto positions = test::download<glm::vec4>(scene.positions(), scene.info().vertex_count);
    const auto clusters = test::download<Cluster>(scene.clusters(), scene.info().cluster_count);
    for (std::size_t c = 0; c < clusters.size(); ++c) {
        glm::vec3 low(std::numeric_limits<float>::infinity()), high = -low;
        for (std::size_t t = c * CLUSTER_TRIANGLES;
             t < std::min<std::size_t>((c + 1) * CLUSTER_TRIANGLES, triangles.size()); ++t)
            for (int k = 0; k < 3; ++k) {
                low = glm::min(low, glm::vec3(positions[triangles[t][k]]));
                high = glm::max(high, glm::vec3(positions[triangles[t][k]]));
            }
        EXPECT_EQ(glm::vec3(clusters[c].low), low) << c;
        EXPECT_EQ(glm::vec3(clusters[c].high), high) << c;
    }
    test::expect_boxes(scene, "moved");
}

TEST(MovingGeometry, KeepsVerticesThatAreNotFinite) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const test::Turning turning = test::bunny();
    for (const Math math : {Math::strict, Math::fast}) {
        DeviceScene scene = test::on_device(turning.rest);
        SceneMover mover(test::programs(), test::device().queue, scene, {.math = math});
        Scene turned = turning.turned(0.3);
        MovedVertices moved = test::buffers_of(turned, turning.first, turning.count);
        const auto spoil = [&](const cl::Buffer& buffer, std::uint32_t v, int axis, float value) {
            test::device().queue.enqueueWriteBuffer(
                buffer, CL_TRUE, (4 * std::size_t{v} + static_cast<std::size_t>(axis)) * 4, 4,
                &value);
            turned.positions[turning.first + v] = turning.rest.positions[turning.first + v];
            turned.normals[turning.first + v] = turning.rest.normals[turning.first + v];
        };
        spoil(moved.positions, 10, 0, nan);
        spoil(moved.positions, 500, 1, -infinity);
        spoil(moved.positions, 501, 2, nan);
        spoil(moved.normals, 7, 0, infinity);
        spoil(moved.normals, 8, 1, nan);
        spoil(moved.normals, 9, 2, -infinity);
        spoil(moved.normals, 10, 2, nan);  // counted once
        mover.move(moved);
        EXPECT_TRUE(
            test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(turned))));
        EXPECT_EQ(mover.status().not_finite, 6u);
        EXPECT_EQ(mover.status().not_finite, 0u);  // counted anew
        mover.move(turning.first, {glm::dvec3(0, double{nan}, 0)}, {});
        EXPECT_EQ(mover.status().not_finite, 1u);
        for (int axis = 0; axis < 3; ++axis) {  // too far for a float
            moved.origin = glm::dvec3(0.0);
            moved.origin[axis] = 1e300;
            mover.move(moved);
            EXPECT_EQ(mover.status().not_finite, turning.count) << axis;
        }
        EXPECT_TRUE(
            test::same_bits(test::vertex_bits(scene), test::vertex_bits(test::on_device(turned))));
    }
}

TEST(MovingGeometry, SaysWhenItLeavesTheFrame) {
    const test::Turning turning = test::bunny();
    DeviceScene scene = test::on_device(turning.rest);
    SceneMover mover(test::programs(), test::device().queue, scene);
    // Corners of the frame's own box fit to the last bit.
    mover.move(0, turning.rest.positions, turning.rest.normals);
    MoveStatus status = mover.status();
    const Bounds box = bounds(turning.rest);
    EXPECT_TRUE(status.fits);
    EXPECT_NEAR(status.farthest, 0.5 * glm::length(box.high - box.low), 1e-6);
    const std::uint32_t last = turning.first + turning.count - 1;
    mover.move(last, {glm::dvec3(0, 1, 9)}, {});
    mover.move(last, {glm::dvec3(0, 1, 0)}, {});
    status = mover.status();
    EXPECT_FALSE(status.fits);
    EXPECT_NEAR(status.farthest, 9.0, 1e-5);
    EXPECT_TRUE(mover.status().fits);
    // To each side of the box, no farther than its corners.
    const glm::dvec3 middle = 0.5 * (box.low + box.high), half = 0.5 * (box.high - box.low);
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            glm::dvec3 at = middle;
            at[axis] += side * 1.001 * half[axis];
            mover.move(last, {at}, {});
            status = mover.status();
            EXPECT_FALSE(status.fits) << axis << ", " << side;
            EXPECT_LT(status.farthest, glm::length(half));
            at[axis] -= side * 0.002 * half[axis];
            mover.move(last, {at}, {});
            EXPECT_TRUE(mover.status().fits) << axis << ", " << side;
        }
}

}  // namespace
}  // namespace clgi
