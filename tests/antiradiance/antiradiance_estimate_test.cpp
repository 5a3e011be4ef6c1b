// What the antiradiance solver needs, before elements are linked.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/rooms.hpp"
#include "rooms.hpp"
#include "solved_antiradiance.hpp"

namespace clgi {
namespace {

using test::options_of;
using test::Solved;

Estimate estimated(const Scene& scene, const AntiradianceOptions& options) {
    const DeviceScene device = test::on_device(scene);
    return estimate(test::device().device, scene, device, options);
}

// Links of a sample of 128 leaves stand for all of them.
TEST(AntiradianceEstimate, IsATwentiethOffAtMostInLargeScenes) {
    for (const Scene& scene : {cornell(), corridor(), office()})
        for (const int bins : {64, 128}) {
            const AntiradianceOptions options = options_of(Math::strict, bins, 4000);
            const Solved solved(scene, options, false);
            const auto found = static_cast<double>(estimated(scene, options).bytes);
            const auto wanted = static_cast<double>(solved.solver.bytes());
            EXPECT_NEAR(found, wanted, 0.05 * wanted) << scene.name << " " << bins;
        }
}

// Where the sample has every leaf nothing is left to be estimated.
TEST(AntiradianceEstimate, IsExactInSmallScenes) {
    Scene scene = test::furnished_room(3);
    scene.materials[1].metallic = 1.0f;
    scene.materials[1].roughness = 0.4f;
    for (const Storage storage : {Storage::full, Storage::half})
        for (const bool glossy : {false, true}) {
            AntiradianceOptions options = options_of(Math::strict, 36, 100);
            options.build.storage = storage;
            options.least_gloss = glossy ? 1e-4 : 1.0;
            const Solved solved(scene, options, false);
            ASSERT_LE(solved.count(), 128u);
            EXPECT_EQ(solved.solver.gloss().count > 0, glossy);
            EXPECT_EQ(estimated(scene, options).bytes, solved.solver.bytes());
        }
}

// `always` gives every element a row, also where nothing can lie between two of them; with more
// leaves than the sample has as well.
TEST(AntiradianceEstimate, HasRowsOfAllElementsWhereTheyAreWanted) {
    Scene empty = test::plain_scene({0.7f, 0.5f, 0.2f});
    test::add_box(empty, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
    empty.lights = {test::point_light({0.5, 0.6, 0.4})};
    for (const std::size_t leaves : {60u, 600u}) {
        AntiradianceOptions options = options_of(Math::strict, 64, leaves);
        const Solved without(empty, options, false);
        EXPECT_EQ(without.count() > 128u, leaves > 128u);
        EXPECT_EQ(without.solver.row_count(), 0u);
        options.occlusion = Occlusion::always;
        const Solved solved(empty, options, false);
        const std::size_t bytes = solved.solver.bytes();
        EXPECT_EQ(solved.solver.row_count(), solved.solver.elements().count());
        EXPECT_GT(bytes, without.solver.bytes() + solved.solver.row_count() * 64 * 2 * 16 / 2);
        if (leaves > 128)
            EXPECT_NEAR(double(estimated(empty, options).bytes), double(bytes),
                        0.05 * double(bytes));
        else
            EXPECT_EQ(estimated(empty, options).bytes, bytes);
    }
}

TEST(AntiradianceEstimate, HasWhatFollowsGeometryThatMoves) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.2f});
    test::add_box(scene, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
    const std::size_t first = scene.positions.size();
    test::add_box(scene, {0.3, 0.1, 0.3}, {0.5, 0.4, 0.6}, 1);
    scene.lights = {test::point_light({0.5, 0.6, 0.4})};
    AntiradianceOptions options = options_of(Math::strict, 64, 60);
    options.poses = {scene.positions, scene.positions};
    for (std::size_t v = first; v < scene.positions.size(); ++v)
        options.poses[1][v] += glm::dvec3(0.4, 0.3, 0.2);
    const Solved solved(scene, options, false);
    ASSERT_LE(solved.count(), 128u);
    EXPECT_GT(solved.solver.moving_links(), 0u);
    EXPECT_EQ(estimated(scene, options).bytes, solved.solver.bytes());
}

TEST(AntiradianceEstimate, GrowsWithBinsStepsAndElements) {
    const Scene scene = test::furnished_room(3);
    AntiradianceOptions options = options_of(Math::strict, 64, 1000);
    options.steps = 4;
    const Estimate few = estimated(scene, options);
    options.steps = 8;
    const Estimate twice = estimated(scene, options);
    EXPECT_EQ(twice.bytes, few.bytes);
    EXPECT_GT(twice.milliseconds, 1.5 * few.milliseconds);
    options.bins = 128;
    const Estimate finer = estimated(scene, options);
    EXPECT_GT(finer.milliseconds, 1.2 * twice.milliseconds);
    EXPECT_GT(finer.bytes, few.bytes);
    options.elements.requested = 4000;
    EXPECT_GT(estimated(scene, options).milliseconds, 2.0 * finer.milliseconds);
}

TEST(AntiradianceEstimate, RefusesWhatTheSolverRefuses) {
    AntiradianceOptions options = options_of(Math::strict, 33, 300);
    EXPECT_THROW(estimated(test::furnished_room(5), options), Error);
    options.bins = 32;
    options.links.bin_share = 0.0;
    EXPECT_THROW(estimated(test::furnished_room(5), options), Error);
    options.links.bin_share = 0.5;
    options.memory_budget = 1;
    EXPECT_GT(estimated(test::furnished_room(5), options).bytes, 1u);
}

}  // namespace
}  // namespace clgi
