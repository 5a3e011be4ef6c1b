// Light atlases whose blocks of texels take over what their corners see.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <cmath>
#include <set>
#include <string>

#include "frames.hpp"
#include "light_baking.hpp"

namespace clgi {
namespace {

using test::Bakery;

// A room with a block and an opening between two of its parts, in daylight colours.
const Bakery& divided_room() {
    static const Bakery bakery(
        [] {
            Scene scene = test::plain_scene(glm::vec3(0.7f, 0.6f, 0.5f));
            test::add_box(scene, {-1, 0, -1}, {1, 1.5, 1}, -1);
            test::add_box(scene, {-0.5, 0.25, -0.5}, {0.25, 0.5, 0.25}, 1);
            test::add_box(scene, {0.4, 0.0, -1.0}, {0.5, 1.2, 0.6}, 1);
            scene.lights = {test::point_light({-0.25, 1.25, 0.5}, 8.0f)};
            return scene;
        }(),
        {.vpls = 300, .atlas = 128});
    return bakery;
}

LightAtlasOptions refined(int step) {
    LightAtlasOptions out = test::bake_options();
    out.refine = step;
    return out;
}

std::set<std::string> passes_of(const LightAtlasSolver& solver) {
    std::set<std::string> out;
    for (const PassEvent& event : solver.events()) out.insert(event.name);
    return out;
}

// The light hardly changes: only texels between corners differ, and those of thin shadows alone.
// The light of VPLs is the same to the bit.
TEST(LightAtlasRefined, HasAboutTheLightOfEveryTexelInFull) {
    LightAtlasSolver full = divided_room().solver(refined(1));
    ASSERT_TRUE(full.run());
    const test::Baked wanted(full);
    EXPECT_EQ(passes_of(full).count("atlas.see"), 1u);
    EXPECT_EQ(passes_of(full).count("atlas.see_blocks"), 0u);
    for (const int step : {2, 4}) {
        LightAtlasSolver solver = divided_room().solver(refined(step));
        ASSERT_TRUE(solver.run());
        EXPECT_EQ(passes_of(solver).count("atlas.see"), 0u);
        EXPECT_EQ(passes_of(solver).count("atlas.see_blocks"), 1u);
        const test::Baked found(solver);
        EXPECT_TRUE(test::same_bits(found.vpls, wanted.vpls));
        EXPECT_EQ(found.status.power_lost, wanted.status.power_lost);
        double square = 0.0, sum = 0.0, more = 0.0;
        std::size_t same = 0;
        for (std::size_t t = 0; t < wanted.texels.size(); ++t) {
            const double d = double{found.texels[t].x} - double{wanted.texels[t].x};
            square += d * d;
            more += d;
            sum += double{wanted.texels[t].x};
            same += d == 0.0;
        }
        const auto count = static_cast<double>(wanted.texels.size());
        EXPECT_LT(std::sqrt(square / count) / (sum / count), step == 2 ? 0.005 : 0.01);
        EXPECT_LT(std::abs(more) / sum, step == 2 ? 5e-4 : 2e-3);
        EXPECT_GT(same, wanted.texels.size() / 2);
        EXPECT_LT(same, wanted.texels.size());
    }
}

// By projection there are no depth maps to be looked up, and a page may be too small for a block.
TEST(LightAtlasRefined, IsNothingWhereThereIsNoBlock) {
    LightAtlasOptions project = refined(4);
    project.filling = Filling::project;
    LightAtlasSolver projected = divided_room().solver(project);
    ASSERT_TRUE(projected.run());
    EXPECT_EQ(passes_of(projected).count("atlas.flat"), 0u);
    Scene box = test::plain_scene();
    test::add_box(box, glm::dvec3(-1), glm::dvec3(1), -1);
    box.lights = {test::point_light({0.2, 0.3, 0.1}, 8.0f)};
    const Bakery tiny(box, {.vpls = 60, .atlas = 14});
    LightAtlasSolver small = tiny.solver(refined(4)), full = tiny.solver(refined(1));
    ASSERT_TRUE(small.run());
    ASSERT_TRUE(full.run());
    EXPECT_EQ(passes_of(small).count("atlas.see"), 1u);
    EXPECT_TRUE(test::same_bits(small.irradiance(), full.irradiance()));
}

TEST(LightAtlasRefined, HasAStepOfOneTwoOrFour) {
    for (const int step : {-1, 0, 3, 5, 8})
        EXPECT_THROW(divided_room().solver(refined(step)), Error);
}

}  // namespace
}  // namespace clgi
