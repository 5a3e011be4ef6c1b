// Light atlases whose lights change: only what changed is sent, and it adds up to a fresh bake.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <cmath>
#include <limits>

#include "frames.hpp"
#include "light_baking.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Bakery;

// A room with a block, lit by a point light and a coloured spot.
Scene lamp_room() {
    Scene scene = test::plain_scene(glm::vec3(0.7f, 0.6f, 0.5f));
    test::add_box(scene, {-1, 0, -1}, {1, 1.5, 1}, -1);
    test::add_box(scene, {-0.5, 0.25, -0.5}, {0.25, 0.5, 0.25}, 1);
    scene.lights = {test::point_light({0.25, 1.25, 0.5}, 8.0f),
                    test::spot_light({-0.5, 1.0, 0.75}, {0.5f, -0.5f, -1.0f}, 0.6, 20.0f)};
    scene.lights[1].intensity *= glm::vec3(1.0f, 0.5f, 0.25f);
    return scene;
}

// A baked room whose lights can be changed.
struct Changing {
    explicit Changing(const LightAtlasOptions& of = test::bake_options())
        : bakery(lamp_room(), {.vpls = 200, .atlas = 48}), options(of), solver(bakery.solver(of)) {}
    void set_spot(const glm::vec3& intensity, const glm::vec3& direction) {
        Light light = bakery.scene.lights[1];
        light.intensity = intensity;
        light.direction = glm::normalize(direction);
        bakery.on_device.set_light(1, light);
        solver.lights_changed();
    }
    std::uint32_t vpls() const { return static_cast<std::uint32_t>(bakery.vpls.vpls.size()); }
    // What a solver finds that never saw other lights.
    test::Baked fresh() const { return test::bake(bakery, options); }

    Bakery bakery;
    LightAtlasOptions options;
    LightAtlasSolver solver;
};

const glm::vec3 spots[] = {{1, 30, 4}, {0, 0, 0}, {200, 90, 10}, {20, 10, 5}, {19, 10, 5}};
const glm::vec3 ways[] = {
    {0.2f, -1.0f, -0.4f}, {0, -1, 0}, {0.3f, 0.8f, -1.0f}, {0.5f, -0.5f, -1}, {0.5f, -0.5f, -1}};

// Every texel is a sum of a few hundred terms, once for each change, and of no larger ones than it
// was at its brightest. Rounding errors of a sum go as the root of their number: 14 for each.
double rounding(int changes) { return 32.0 * 0x1p-24 * (changes + 1); }

TEST(LightAtlasUpdate, OfEveryChangeComesToAFreshBake) {
    for (const std::uint32_t bounces : {1u, 4u}) {
        LightAtlasOptions options = test::bake_options();
        options.bounces = bounces;
        options.direct = bounces == 1;
        Changing lamp_room(options);
        ASSERT_TRUE(lamp_room.solver.run());
        std::vector<glm::vec3> brightest = lamp_room.solver.irradiance();
        EXPECT_EQ(lamp_room.solver.status().sent, lamp_room.vpls());
        for (int k = 0; k < 5; ++k) {
            lamp_room.set_spot(spots[k], ways[k]);
            ASSERT_TRUE(lamp_room.solver.update(0.0));
            const test::Baked found(lamp_room.solver), wanted = lamp_room.fresh();
            EXPECT_TRUE(test::same_bits(found.vpls, wanted.vpls)) << k;
            EXPECT_EQ(found.status.power_direct, wanted.status.power_direct);
            EXPECT_EQ(found.status.non_finite, 0u);
            EXPECT_GT(found.status.sent, 0u);
            for (std::size_t t = 0; t < brightest.size(); ++t) {
                brightest[t] = glm::max(brightest[t], wanted.texels[t]);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(found.texels[t][c], wanted.texels[t][c],
                                rounding(k + 1) * brightest[t][c])
                        << "change " << k << ", texel " << t;
            }
        }
    }
}

CLGI_IN_BOTH_MATHS(LightAtlasAgain);

TEST_P(LightAtlasAgain, WithoutAChangeSendsNothing) {
    Changing lamp_room;
    ASSERT_TRUE(lamp_room.solver.run());
    const auto before = lamp_room.solver.irradiance();
    for (const bool told : {false, true}) {
        if (told) lamp_room.solver.lights_changed();
        ASSERT_TRUE(lamp_room.solver.update(0.0));
        EXPECT_EQ(lamp_room.solver.status().sent, 0u);
        EXPECT_TRUE(test::same_bits(lamp_room.solver.irradiance(), before));
    }
}

// Mean difference of texels, by area, in lumen of three channels.
double difference(const Changing& lamp_room, const std::vector<glm::vec3>& wanted) {
    const auto found = lamp_room.solver.irradiance();
    double sum = 0.0;
    for (std::size_t t = 0; t < found.size(); ++t)
        for (int c = 0; c < 3; ++c)
            sum += lamp_room.bakery.atlas.texels[t].area *
                   std::abs(double{found[t][c]} - double{wanted[t][c]});
    return sum;
}

// What a VPL does not send is less than `least` mean powers, and of a power of 1 no more than 1
// arrives at all texels together, or half as much again where corners are completed.
TEST(LightAtlasUpdate, LeavesNoMoreThanIsAllowed) {
    Changing lamp_room;
    ASSERT_TRUE(lamp_room.solver.run());
    const double least = 0.05;
    std::uint32_t fewest = lamp_room.vpls();
    double largest = 0.0;
    glm::vec3 spot = lamp_room.bakery.scene.lights[1].intensity;
    for (int k = 0; k < 8; ++k) {
        spot *= 0.97f;
        lamp_room.set_spot(spot, ways[3]);
        ASSERT_TRUE(lamp_room.solver.update(least));
        const test::Baked wanted = lamp_room.fresh();
        const LightAtlasStatus status = lamp_room.solver.status();
        const double error = difference(lamp_room, wanted.texels);
        EXPECT_LT(error, 1.6 * least * status.power_direct) << k;
        EXPECT_LT(status.sent, lamp_room.vpls() / 2) << k;
        fewest = std::min(fewest, status.sent);
        largest = std::max(largest, error / status.power_direct);
    }
    EXPECT_GT(largest, 1e-4);  // something was left
    // What was left is not lost.
    ASSERT_TRUE(lamp_room.solver.update(0.0));
    EXPECT_GT(lamp_room.solver.status().sent, fewest);
    const test::Baked wanted = lamp_room.fresh();
    EXPECT_LT(difference(lamp_room, wanted.texels), rounding(9) * wanted.status.power_direct);
}

// A VPL that changes by little again and again sends it in the end.
TEST(LightAtlasUpdate, ForgetsNoSmallChange) {
    Changing lamp_room;
    ASSERT_TRUE(lamp_room.solver.run());
    glm::vec3 spot = lamp_room.bakery.scene.lights[1].intensity;
    std::uint32_t sent = 0;
    for (int k = 0; k < 12; ++k) {
        spot *= 1.01f;
        lamp_room.set_spot(spot, ways[3]);
        ASSERT_TRUE(lamp_room.solver.update(0.2));
        if (k == 0) {
            EXPECT_EQ(lamp_room.solver.status().sent, 0u);
        }
        sent += lamp_room.solver.status().sent;
    }
    EXPECT_GT(sent, 0u);
}

// Nothing of a run that did not end is taken for granted.
TEST(LightAtlasUpdate, AfterACancelledRunBakesAnew) {
    LightAtlasOptions options = test::bake_options();
    options.bounces = 3;
    Changing first(options);
    ASSERT_TRUE(first.solver.update());  // before any run
    EXPECT_EQ(first.solver.status().sent, first.vpls());
    EXPECT_TRUE(test::same_bits(first.solver.irradiance(), first.fresh().texels));
    int reports = 0;
    ASSERT_TRUE(first.solver.update(0.0, [&](double) { return ++reports > 0; }));
    ASSERT_GT(reports, 2);
    for (int last = 1; last < reports; ++last) {
        Changing lamp_room(options);
        ASSERT_TRUE(lamp_room.solver.run());
        lamp_room.set_spot(spots[0], ways[0]);
        int seen = 0;
        ASSERT_FALSE(lamp_room.solver.update(0.0, [&](double) { return ++seen < last; }));
        EXPECT_EQ(lamp_room.solver.status().sent, 0u);
        ASSERT_TRUE(lamp_room.solver.update(0.5));
        EXPECT_EQ(lamp_room.solver.status().sent, lamp_room.vpls()) << last;
        EXPECT_TRUE(test::same_bits(lamp_room.solver.irradiance(), lamp_room.fresh().texels))
            << last;
    }
}

// Where what texels see is not kept, an update is a bake; and the light is the same, to the bit.
TEST(LightAtlasUpdate, WithoutKeptVisibilityBakesAnew) {
    LightAtlasOptions usual = test::bake_options();
    usual.build.form = Form::packets;  // whose batches are small beside what is kept
    Changing kept(usual);
    ASSERT_TRUE(kept.solver.run());
    EXPECT_TRUE(kept.solver.status().visibility_kept);
    LightAtlasOptions poor = usual, projected = usual;
    poor.memory_budget = kept.solver.bytes() - 1;
    projected.filling = Filling::project;
    for (const LightAtlasOptions& options : {poor, projected}) {
        const bool gathers = options.filling == Filling::gather;
        Changing lamp_room(options);
        ASSERT_TRUE(lamp_room.solver.run());
        EXPECT_TRUE(lamp_room.solver.status().transport_kept);
        EXPECT_FALSE(lamp_room.solver.status().visibility_kept);
        if (gathers) {
            EXPECT_TRUE(test::same_bits(lamp_room.solver.irradiance(), kept.solver.irradiance()));
        }
        lamp_room.set_spot(spots[0], ways[0]);
        ASSERT_TRUE(lamp_room.solver.update(0.5));
        EXPECT_EQ(lamp_room.solver.status().sent, lamp_room.vpls());
        EXPECT_TRUE(test::same_bits(lamp_room.solver.irradiance(), lamp_room.fresh().texels))
            << gathers;
    }
}

TEST(LightAtlasUpdate, DrawsNoHemicubeAgain) {
    LightAtlasOptions options = test::bake_options();
    options.build.form = Form::packets;  // eight VPLs at a time
    Changing lamp_room(options);
    const auto count = [&](const char* name) {
        std::size_t out = 0;
        for (const PassEvent& event : lamp_room.solver.events())
            out += std::string(event.name) == name;
        return out;
    };
    const char* const once[] = {"gbuffer.cubes",    "vpl.transport",         "vpl.reach",
                                "atlas.see_blocks", "vpl.balance_receivers", "gbuffer.surface",
                                "atlas.nearest"};
    ASSERT_TRUE(lamp_room.solver.run());
    for (const char* name : once) EXPECT_GT(count(name), 0u) << name;
    EXPECT_EQ(count("gbuffer.cubes"), (lamp_room.vpls() + 7) / 8);  // and each once
    for (const bool whole : {true, false}) {
        lamp_room.set_spot(spots[whole], ways[whole]);
        ASSERT_TRUE(whole ? lamp_room.solver.run() : lamp_room.solver.update(0.0));
        for (const char* name : once) EXPECT_EQ(count(name), 0u) << name;
        EXPECT_GT(count("lights.direct"), 0u);
        EXPECT_GT(count("atlas.gather"), 0u);
    }
}

TEST(LightAtlasUpdate, RefusesALeastThatIsNone) {
    Changing lamp_room;
    ASSERT_TRUE(lamp_room.solver.run());
    for (const double least : {-1e-9, -1.0, std::numeric_limits<double>::quiet_NaN()}) try {
            lamp_room.solver.update(least);
            ADD_FAILURE() << least << ": taken";
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("least is"), std::string::npos)
                << error.what();
        }
    // No VPL ever changes by so much.
    lamp_room.set_spot(spots[2], ways[2]);
    ASSERT_TRUE(lamp_room.solver.update(std::numeric_limits<double>::infinity()));
    EXPECT_EQ(lamp_room.solver.status().sent, 0u);
}

}  // namespace
}  // namespace clgi
