// Collected animated files: on the host and on the device they are where glTF's formulas say.
// SPDX-License-Identifier: MIT
#include "gltf_truth.hpp"  // before headers that bring io's tinygltf, if any

#include <gtest/gtest.h>
#include <clgi/io/gltf.hpp>
#include <clgi/scene_animator.hpp>

#include "read_back.hpp"

namespace clgi {
namespace {

using test::GltfTruth;
using test::TrueCorner;

const std::filesystem::path scenes = CLGI_SCENES_DIR;

const char* const files[] = {"animated/AnimatedMorphCube/AnimatedMorphCube.gltf",
                             "animated/AnimatedMorphSphere/AnimatedMorphSphere.gltf",
                             "animated/BoxAnimated/BoxAnimated.gltf",
                             "animated/CesiumMan.glb",
                             "animated/Fox.glb",
                             "animated/InterpolationTest/InterpolationTest.gltf",
                             "animated/Lumberjack.glb",
                             "animated/MorphStressTest.gltf",
                             "animated/RiggedSimple/RiggedSimple.gltf",
                             "animated/SimpleMorph/SimpleMorph.gltf",
                             "bunny/bunny-skinned.glb",
                             "odd-valid/CesiumMan-weights-not-normalised/CesiumMan.gltf",
                             "odd-valid/RiggedFigure-weights-not-normalised/RiggedFigure.gltf",
                             "odd-valid/asset-generator/Animation_Skin/Animation_Skin_01.gltf",
                             "odd-valid/asset-generator/Animation_Skin/Animation_Skin_05.gltf",
                             "odd-valid/asset-generator/Animation_Skin/Animation_Skin_08.gltf",
                             "odd-valid/asset-generator/Animation_Skin/Animation_Skin_10.gltf",
                             "odd-valid/misc/singleBlendshapeCube_sparse.glb"};

// Before the first key, between keys, at the end and after it.
std::vector<double> times(double duration) {
    return {-1.0, 0.0, 0.13 * duration, 0.5 * duration, 0.77 * duration, duration, duration + 1.0};
}

// Where a scene's triangles are. The loader exchanges two corners of mirrored triangles.
void expect_true(const Scene& scene, const std::vector<TrueCorner>& truth, double near,
                 double normal_near, const std::string& where) {
    ASSERT_EQ(3 * scene.triangles.size(), truth.size()) << where;
    double worst = 0.0, worst_normal = 0.0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const auto differences = [&](int b, int c) {
            const int order[3] = {0, b, c};
            glm::dvec2 out(0.0);
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t vertex = scene.triangles[t].vertex[order[k]];
                const TrueCorner& corner = truth[3 * t + k];
                out.x = std::max(out.x, glm::length(scene.positions[vertex] - corner.position));
                const glm::dvec3 n(scene.normals[vertex]);
                if (!std::isnan(corner.normal.x))  // of triangles without area
                    out.y = std::max(out.y, glm::length(n - corner.normal));
            }
            return out;
        };
        const glm::dvec2 straight = differences(1, 2), exchanged = differences(2, 1);
        const glm::dvec2 found = exchanged.x < straight.x ? exchanged : straight;
        worst = std::max(worst, found.x);
        worst_normal = std::max(worst_normal, found.y);
    }
    EXPECT_LE(worst, near) << where;
    EXPECT_LE(worst_normal, normal_near) << where;
}

TEST(AnimatedScenes, AreWhereTheFormulasSay) {
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no scenes in " << scenes;
    for (const char* file : files) {
        GltfTruth truth(scenes / file);
        const Scene scene = io::load_gltf(scenes / file);
        ASSERT_TRUE(scene.animation) << file;
        ASSERT_EQ(scene.animation->clips.size(), truth.clips()) << file;
        for (std::size_t clip = 0; clip < truth.clips(); ++clip) {
            Scene framed = scene;
            framed.moving_bounds = motion_bounds(scene, clip);
            ASSERT_TRUE(framed.moving_bounds) << file;
            DeviceScene device = test::on_device(framed);
            SceneAnimator animator(test::programs(), test::device().queue, framed, device);
            const double radius = device.frame().radius / device.frame().scale;
            EXPECT_DOUBLE_EQ(scene.animation->clips[clip].duration, truth.duration(clip)) << file;
            for (const double time : times(truth.duration(clip))) {
                const std::string where =
                    std::string(file) + " " + std::to_string(clip) + " at " + std::to_string(time);
                const auto corners = truth.at(clip, time);
                // Rest positions and weights are floats: 2^-24 of the size, some of them summed.
                expect_true(posed(scene, pose_at(*scene.animation, clip, time)), corners,
                            4 * 0x1p-24 * radius, 2e-6, where);
                animator.animate(clip, time).done.wait();
                // A dozen roundings of numbers as large as the radius; normals of thin triangles
                // lose more, the thinner they are.
                expect_true(test::read_back(scene, device), corners, 16 * 0x1p-24 * radius, 2e-4,
                            where);
                const MoveStatus status = animator.status();
                EXPECT_EQ(status.not_finite, 0u) << where;
                EXPECT_TRUE(status.fits) << where;
            }
        }
    }
}

// No wider than twice what moves, and the scene around it.
TEST(AnimatedScenes, HaveBoundsThatAreNotWide) {
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no scenes in " << scenes;
    for (const char* file : files) {
        const Scene scene = io::load_gltf(scenes / file);
        Bounds all = bounds(posed(scene, pose_at(*scene.animation, 0, 0.0)));
        const double duration = scene.animation->clips[0].duration;
        for (int i = 1; i <= 100; ++i) {
            const Bounds now =
                bounds(posed(scene, pose_at(*scene.animation, 0, 0.01 * i * duration)));
            all = {glm::min(all.low, now.low), glm::max(all.high, now.high)};
        }
        const Bounds found = *motion_bounds(scene, 0);
        EXPECT_LE(glm::length(found.high - found.low), 2.0 * glm::length(all.high - all.low))
            << file;
        if (scene.animation->ranges.size() == scene.parts.size()) {
            EXPECT_TRUE(glm::all(glm::lessThanEqual(found.low, all.low))) << file;
            EXPECT_TRUE(glm::all(glm::greaterThanEqual(found.high, all.high))) << file;
        }
    }
}

// What the file stores is what load_gltf flattens.
TEST(AnimatedScenes, AtRestAreAsLoaded) {
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no scenes in " << scenes;
    for (const char* file : files) {
        const Scene scene = io::load_gltf(scenes / file);
        const Scene rest = posed(scene, rest_pose(*scene.animation));
        const Bounds box = bounds(scene);
        const double size = glm::length(box.high - box.low);
        for (std::size_t v = 0; v < scene.positions.size(); ++v) {
            ASSERT_LE(glm::length(rest.positions[v] - scene.positions[v]), 4 * 0x1p-24 * size)
                << file << " " << v;
            ASSERT_LE(glm::length(rest.normals[v] - scene.normals[v]), 2e-6f) << file << " " << v;
        }
        EXPECT_FALSE(rest.animation);
    }
}

}  // namespace
}  // namespace clgi
