// Light that is gone from an atlas and was a hundred thousand times as bright.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <limits>

#include "light_baking.hpp"
#include "one_batch.hpp"

namespace clgi {
namespace {

using test::Bakery;

// Two rooms side by side, sealed from each other; in each a dim lamp and one that can be bright.
Scene two_rooms() {
    Scene scene = test::plain_scene(glm::vec3(0.7f, 0.6f, 0.5f));
    test::add_box(scene, {0, 0, 0}, {1, 1, 1.2}, -1);
    test::add_box(scene, {1.5, 0, 0}, {2.5, 1, 1.2}, -1);
    for (const double x : {0.3, 1.9}) {
        scene.lights.push_back(test::point_light({x, 0.8, 0.4}, 1.0f));
        scene.lights.push_back(test::point_light({x + 0.4, 0.7, 0.9}, 1.0f));
        scene.lights.back().intensity = glm::vec3(0.0f);
    }
    return scene;
}

struct Rooms {
    Rooms() : bakery(two_rooms(), {.vpls = 120, .atlas = 32}), solver(bakery.solver(options())) {}
    static LightAtlasOptions options() {
        LightAtlasOptions out = test::bake_options();
        out.bounces = 2;
        return out;
    }
    void set(std::size_t light, const glm::vec3& intensity) {
        Light changed = bakery.on_device.lights()[light];
        changed.intensity = intensity;
        bakery.on_device.set_light(light, changed);
        solver.lights_changed();
    }
    int sendings() const {
        int out = 0;
        for (const PassEvent& event : solver.events()) out += event.name == "vpl.send";
        return out;
    }
    Bakery bakery;
    LightAtlasSolver solver;
};

const glm::vec3 bright(1e5f, 3e5f, 2e5f);

void expect_fresh(const Rooms& rooms) {
    const test::Baked found(rooms.solver), wanted = test::bake(rooms.bakery, Rooms::options());
    for (std::size_t t = 0; t < wanted.texels.size(); ++t)
        for (int c = 0; c < 3; ++c) {
            // Residues are 2^-20 of what was, at most 2^-7 of what is.
            EXPECT_NEAR(found.texels[t][c], wanted.texels[t][c], 0.01 * wanted.texels[t][c]) << t;
            EXPECT_GE(found.texels[t][c], 0.0f) << t;
        }
}

TEST(LightAtlasResidue, OfALampThatIsSwitchedOffIsNotSeen) {
    Rooms rooms;
    rooms.set(1, bright);
    ASSERT_TRUE(rooms.solver.run());
    rooms.set(1, glm::vec3(0.0f));
    ASSERT_TRUE(rooms.solver.update(0.0));
    expect_fresh(rooms);
    EXPECT_EQ(rooms.sendings(), 2);  // the difference, then everything
    EXPECT_EQ(rooms.solver.status().sent, rooms.bakery.vpls.vpls.size());
    // The next change is a difference again.
    rooms.set(0, glm::vec3(0.5f));
    ASSERT_TRUE(rooms.solver.update(0.0));
    expect_fresh(rooms);
    EXPECT_EQ(rooms.sendings(), 1);
}

// Of all lamps together nothing fell, and the room that it left is far darker than the mean.
TEST(LightAtlasResidue, OfALampThatMovesToAnotherRoomIsNotSeen) {
    Rooms rooms;
    rooms.set(1, bright);
    ASSERT_TRUE(rooms.solver.run());
    rooms.set(1, glm::vec3(0.0f));
    rooms.set(3, bright);
    ASSERT_TRUE(rooms.solver.update(0.0));
    expect_fresh(rooms);
    EXPECT_EQ(rooms.sendings(), 2);
}

// In two steps, of which neither is a large fall.
TEST(LightAtlasResidue, OfLightThatFellBitByBitIsNotSeen) {
    Rooms rooms;
    rooms.set(1, bright);
    ASSERT_TRUE(rooms.solver.run());
    for (const float share : {1e-2f, 1e-4f, 0.0f}) {
        rooms.set(1, share * bright);
        ASSERT_TRUE(rooms.solver.update(0.0));
        expect_fresh(rooms);
    }
}

// A change that floats tell well is sent as a difference.
TEST(LightAtlasResidue, OfAnOrdinaryChangeIsLeft) {
    Rooms rooms;
    rooms.set(1, {100.0f, 300.0f, 200.0f});
    ASSERT_TRUE(rooms.solver.run());
    rooms.set(1, glm::vec3(0.0f));
    ASSERT_TRUE(rooms.solver.update(0.0));
    EXPECT_EQ(rooms.sendings(), 1);
    expect_fresh(rooms);
}

// What was taken away is never less than nothing.
TEST(LightAtlasResidue, IsNotNegative) {
    const std::uint32_t stride = 16;
    std::vector<float> gathered(3 * stride, -1e-6f);
    gathered[3] = 2.0f;
    gathered[stride + 5] = std::numeric_limits<float>::quiet_NaN();
    gathered[stride + 7] = -std::numeric_limits<float>::infinity();
    const cl::Buffer out = test::empty<float>(3 * stride),
                     bad = test::upload(std::vector<cl_uint>(4));
    test::atlas_passes().complete(test::device().queue, {0, 0, 16, 16, 16, stride, 0, 0},
                                  test::upload(std::vector<float>(stride, 1.0f)),
                                  test::upload(std::vector<float>(stride, 1.0f)),
                                  test::upload(gathered), out, bad);
    const auto found = test::download<float>(out, 3 * stride);
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (i == stride + 5)
            EXPECT_TRUE(std::isnan(found[i]));
        else
            EXPECT_EQ(found[i], i == 3 ? 2.0f : i == stride + 7 ? gathered[i] : 0.0f) << i;
    }
    EXPECT_GE(test::download<cl_uint>(bad, 1)[0], 1u);
}

}  // namespace
}  // namespace clgi
