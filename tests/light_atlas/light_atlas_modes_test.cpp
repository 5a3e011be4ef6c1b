// One answer, whichever way a light atlas is baked: one VPL at a time or all, transport kept or
// not, again, after a change of light, after a cancelled bake, at another place and size.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>
#include <tuple>

#include "frames.hpp"
#include "light_baking.hpp"
#include "math_modes.hpp"
#include "refusals.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

using test::Baked;
using test::Bakery;

CLGI_IN_BOTH_MATHS(LightAtlasMode);

// A box with a table and an opening in its ceiling, coloured, lit by a point light and a spot.
Scene room() {
    Scene scene = test::plain_scene(glm::vec3(0.7f, 0.6f, 0.5f));
    test::add_floor(scene, 1.0);
    test::add_quad(scene, {glm::dvec3(-1, 0, -1), {1, 0, -1}, {1, 1.5, -1}, {-1, 1.5, -1}});
    test::add_quad(scene, {glm::dvec3(1, 0, 1), {-1, 0, 1}, {-1, 1.5, 1}, {1, 1.5, 1}});
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {-1, 0, -1}, {-1, 1.5, -1}, {-1, 1.5, 1}});
    Material red;
    red.base_color = glm::vec4(0.8f, 0.2f, 0.1f, 1.0f);
    test::add_box(scene, {-0.5, 0.25, -0.5}, {0.25, 0.5, 0.25}, 1, test::add_material(scene, red));
    scene.lights = {test::point_light({0.25, 1.25, 0.5}, 8.0f),
                    test::spot_light({-0.5, 1.0, 0.75}, {0.5f, -0.5f, -1.0f}, 0.6, 20.0f)};
    scene.lights[1].intensity *= glm::vec3(1.0f, 0.5f, 0.25f);
    return scene;
}

void expect_same(const Baked& found, const Baked& wanted, const std::string& what) {
    EXPECT_TRUE(test::same_bits(found.texels, wanted.texels)) << what;
    EXPECT_TRUE(test::same_bits(found.vpls, wanted.vpls)) << what;
    EXPECT_EQ(found.status.power_shot, wanted.status.power_shot) << what;
    EXPECT_EQ(found.status.power_lost, wanted.status.power_lost) << what;
}

// Whose batches are small beside what is kept, however small the scene.
LightAtlasOptions packets() {
    LightAtlasOptions out = test::bake_options();
    out.build.form = Form::packets;
    return out;
}

// Buffers for the transport of one batch, but not of all VPLs; visibility: for that of all VPLs,
// but not for what all texels see.
std::size_t too_little_to_keep(const Bakery& bakery, LightAtlasOptions options,
                               bool visibility = false) {
    const auto bytes = [&](bool seen) {
        const LightAtlasSolver solver = bakery.solver(options);
        EXPECT_TRUE(solver.status().transport_kept);
        EXPECT_EQ(solver.status().visibility_kept, seen);
        return solver.bytes();
    };
    options.memory_budget = bytes(true) - 1;
    return visibility ? options.memory_budget : bytes(false) - 1;
}

const Bakery& small_room() {
    static const Bakery bakery(room(), {.vpls = 200, .atlas = 48});
    return bakery;
}

// The kinds of work: kept and all VPLs at a time, and what departs from it.
std::vector<LightAtlasOptions> ways() {
    LightAtlasOptions all = packets(), alone = all, poor = all, direct = all, drawn = all;
    all.bounces = 3;
    alone.bounces = 0;
    alone.threshold = 0.01f;
    alone.one_at_a_time = true;
    poor.bounces = 3;
    poor.memory_budget = too_little_to_keep(small_room(), poor);
    direct.bounces = 1;
    direct.direct = true;
    drawn.memory_budget = too_little_to_keep(small_room(), drawn, true);
    return {all, alone, poor, direct, drawn};
}

// The shadow maps of a bake, 16 million pixels together.
TEST(LightAtlasShadows, AreSmallerWhereMoreLightsHaveThem) {
    for (const auto& [spots, sky, usual] :
         {std::tuple{4, 0, 2048}, {5, 0, 1024}, {1, 4, 1024}, {16, 0, 1024}, {17, 0, 512}}) {
        ASSERT_LT(room().lights[1].outer_angle, 1.0f);
        Scene scene = room();
        const Light spot = scene.lights[1];
        for (int i = 1; i < spots; ++i) {
            scene.lights.push_back(spot);
            scene.lights.back().position.x += 0.05 * i;
        }
        // These have cubes.
        for (int i = 0; i < 4; ++i) {
            scene.lights.push_back(spot);
            scene.lights.back().outer_angle = 1.1f;
        }
        if (sky > 0) scene.environment = Environment{};
        const Bakery bakery(scene, {.vpls = 60, .atlas = 16});
        LightAtlasOptions options = packets();
        options.emitters.environment_lights = sky;
        const auto bytes = [&](int size) {
            options.emitters.shadow_size = size;
            return bakery.solver(options).bytes();
        };
        const std::size_t found = bytes(bake_emitters().shadow_size);
        const std::string label = std::to_string(spots) + " spots, size " + std::to_string(usual);
        EXPECT_EQ(found, bytes(usual)) << label;
        EXPECT_NE(found, bytes(usual / 2)) << label;
    }
}

// 25,600 points for all VPLs together, from 4 to 16 of each.
TEST(LightAtlasExchange, LooksAtFewerPointsOfMoreVpls) {
    for (const auto& [vpls, usual, other] :
         {std::tuple{300u, 16u, 17u}, {2000u, 12u, 13u}, {7000u, 4u, 3u}}) {
        const Bakery bakery(room(), {.vpls = vpls, .atlas = 16, .samples_per_vpl = 24});
        LightAtlasOptions options;
        options.bounces = 2;
        options.hemicube_size = 32;
        const auto received = [&](std::uint32_t samples) {
            options.exchange_samples = samples;
            return test::bake(bakery, options).vpls;
        };
        const auto found = received(0);
        EXPECT_TRUE(test::same_bits(found, received(usual))) << vpls << " VPLs";
        EXPECT_FALSE(test::same_bits(found, received(other))) << vpls << " VPLs";
    }
}

// Both end when no VPL has more than a millionth of the power left, 200 of them 2e-4.
TEST_P(LightAtlasMode, OneAtATimeConvergesToAllAtATime) {
    LightAtlasOptions options = test::bake_options(GetParam());
    options.bounces = 0;
    options.threshold = 1e-6f;
    const Baked all = test::bake(small_room(), options);
    options.one_at_a_time = true;
    const Baked alone = test::bake(small_room(), options);
    EXPECT_LT(test::relative_difference(alone.texels, all.texels), 2e-4);
    EXPECT_LT(test::relative_difference(alone.vpls, all.vpls), 2e-4);
    for (const LightAtlasStatus& status : {all.status, alone.status}) {
        EXPECT_GT(status.shots, small_room().vpls.vpls.size());
        EXPECT_LT(status.power_left, 2e-4 * status.power_direct);
        EXPECT_NEAR(status.power_received + status.power_lost, status.power_shot,
                    1e-5 * status.power_shot);
    }
}

// Rows that are not kept are balanced by their shooters alone: 0.9 % at VPLs, 0.4 % at texels.
TEST_P(LightAtlasMode, KeepsTransportOrNotForAboutTheSameLight) {
    for (const bool one_at_a_time : {false, true}) {
        LightAtlasOptions options = test::bake_options(GetParam());
        options.build.form = Form::packets;
        options.bounces = one_at_a_time ? 0 : 4;
        options.threshold = 1e-3f;
        options.one_at_a_time = one_at_a_time;
        const Baked kept = test::bake(small_room(), options);
        options.memory_budget = too_little_to_keep(small_room(), options);
        const Baked made = test::bake(small_room(), options);
        EXPECT_TRUE(kept.status.transport_kept);
        EXPECT_FALSE(made.status.transport_kept);
        EXPECT_LT(test::relative_difference(made.texels, kept.texels), 0.01);
        EXPECT_LT(test::relative_difference(made.vpls, kept.vpls), 0.01);
        EXPECT_NEAR(made.status.power_shot, kept.status.power_shot, 0.01 * kept.status.power_shot);
        EXPECT_NEAR(made.status.power_received + made.status.power_lost, made.status.power_shot,
                    1e-5 * made.status.power_shot);
    }
}

// What texels see is the same, looked up again or kept.
TEST(LightAtlasModes, KeepVisibilityOrNotForTheSameBits) {
    for (const std::uint32_t bounces : {0u, 1u, 3u}) {
        LightAtlasOptions options = packets();
        options.bounces = bounces;
        const Baked kept = test::bake(small_room(), options);
        options.memory_budget = too_little_to_keep(small_room(), options, true);
        const Baked drawn = test::bake(small_room(), options);
        EXPECT_TRUE(kept.status.visibility_kept);
        EXPECT_FALSE(drawn.status.visibility_kept);
        expect_same(drawn, kept, std::to_string(bounces) + " bounces");
    }
}

// In batches of more VPLs, too, whose visibility is kept or not.
TEST(LightAtlasModes, InGroupsGiveTheSameBits) {
    const Bakery room(test::furnished_room(3), {.vpls = 800, .atlas = 256});
    LightAtlasOptions options = packets();
    options.bounces = 2;
    options.hemicube_size = 32;
    options.build.packet_width = 1;
    const Baked alone = test::bake(room, options);
    options.build.form = Form::groups;
    expect_same(test::bake(room, options), alone, "kept");
    options.memory_budget = too_little_to_keep(room, options, true);
    const Baked drawn = test::bake(room, options);
    EXPECT_FALSE(drawn.status.visibility_kept);
    expect_same(drawn, alone, "drawn again");
}

// Direct light alone bounces here: what surfaces are around is known all the same.
TEST(LightAtlasModes, WithoutBouncesNeedNoTransportToFillTheAtlas) {
    LightAtlasOptions options = packets();
    options.bounces = 1;
    const Baked kept = test::bake(small_room(), options);
    options.memory_budget = too_little_to_keep(small_room(), options);
    const Baked made = test::bake(small_room(), options);
    EXPECT_FALSE(made.status.transport_kept);
    EXPECT_LT(test::relative_difference(made.texels, kept.texels), 1e-6);
    EXPECT_TRUE(test::same_bits(made.vpls, kept.vpls));
}

TEST(LightAtlasModes, RunAgainGivesTheSameBits) {
    for (const LightAtlasOptions& options : ways()) {
        LightAtlasSolver solver = small_room().solver(options);
        ASSERT_TRUE(solver.run());
        const Baked first(solver);
        ASSERT_TRUE(solver.run());
        expect_same(Baked(solver), first, std::to_string(options.bounces) + " bounces");
        expect_same(test::bake(small_room(), options), first, "another solver");
    }
}

// Cancelled at every report that a bake makes but the last, which comes too late; then it is run to
// its end.
TEST(LightAtlasModes, RunAgainAfterACancelledBakeGivesTheSameBits) {
    for (const LightAtlasOptions& options : ways()) {
        const Baked wanted = test::bake(small_room(), options);
        int reports = 0;
        {
            LightAtlasSolver solver = small_room().solver(options);
            ASSERT_TRUE(solver.run([&](double) { return ++reports > 0; }));
        }
        ASSERT_GT(reports, 3);
        const int step = std::max(1, reports / 8);
        for (int last = 1; last < reports; last += step) {
            LightAtlasSolver solver = small_room().solver(options);
            int seen = 0;
            EXPECT_FALSE(solver.run([&](double) { return ++seen < last; }));
            EXPECT_EQ(seen, last);
            ASSERT_TRUE(solver.run());
            expect_same(
                Baked(solver), wanted,
                "cancelled at report " + std::to_string(last) + " of " + std::to_string(reports));
        }
    }
}

TEST(LightAtlasModes, ChangedLightsGiveTheBitsOfAFreshSolver) {
    for (const LightAtlasOptions& options : ways()) {
        Bakery bakery(room(), {.vpls = 200, .atlas = 48});
        LightAtlasSolver solver = bakery.solver(options);
        ASSERT_TRUE(solver.run());
        const Baked before(solver);
        Light light = bakery.scene.lights[1];
        light.intensity = {1.0f, 30.0f, 4.0f};
        light.direction = glm::normalize(glm::vec3(0.2f, -1.0f, -0.4f));
        bakery.on_device.set_light(1, light);
        solver.lights_changed();
        ASSERT_TRUE(solver.run());
        const Baked after(solver);
        expect_same(after, test::bake(bakery, options), "changed");
        EXPECT_GT(test::relative_difference(after.texels, before.texels), 0.05);
    }
}

// 2^-10 of the size, with 2^-20 of the intensity, and away by 2^12 metres.
TEST(LightAtlasModes, PlaceAndPowersOfTwoInSizeChangeNoBit) {
    const LightAtlasOptions options = ways().front();
    const Baked wanted = test::bake(small_room(), options);
    for (const auto& [scale, away] : {std::pair{0x1p-10, 0.0}, {0x1p6, 0.0}, {1.0, 4096.0}}) {
        Scene scene = room();
        for (glm::dvec3& p : scene.positions) p = p * scale + away;
        for (Light& light : scene.lights) {
            light.position = light.position * scale + away;
            light.intensity *= static_cast<float>(scale * scale);
        }
        const Baked found = test::bake(Bakery(scene, {.vpls = 200, .atlas = 48}), options);
        EXPECT_TRUE(test::same_bits(found.texels, wanted.texels)) << scale << ", " << away;
        EXPECT_TRUE(test::same_bits(found.vpls, wanted.vpls)) << scale << ", " << away;
    }
}

// The closed form of a point light in a sphere of radius 1: its intensity, everywhere.
TEST_P(LightAtlasMode, HoldsDirectLightIfAskedTo) {
    const Bakery bakery(furnace({.light = LightSource::point, .subdivisions = 3}), {.vpls = 100});
    LightAtlasOptions options = test::bake_options(GetParam());
    options.bounces = 2;
    const Baked without = test::bake(bakery, options);
    options.direct = true;
    const Baked with = test::bake(bakery, options);
    EXPECT_TRUE(test::same_bits(with.vpls, without.vpls));
    for (std::size_t i = 0; i < with.texels.size(); ++i)
        EXPECT_NEAR(with.texels[i].y - without.texels[i].y, 1.0, 0.02) << i;
}

TEST_P(LightAtlasMode, IsExactlyDarkWithoutLight) {
    Scene scene = room();
    scene.lights[0].intensity = scene.lights[1].intensity = glm::vec3(0.0f);
    const Bakery dark(scene, {.vpls = 100, .atlas = 32});
    for (const bool one_at_a_time : {false, true})
        for (const std::uint32_t bounces : {0u, 1u, 5u}) {
            LightAtlasOptions options = test::bake_options(GetParam());
            options.bounces = bounces;
            options.one_at_a_time = one_at_a_time;
            options.direct = true;
            const Baked baked = test::bake(dark, options);
            for (const glm::vec3& value : baked.texels) EXPECT_EQ(value, glm::vec3(0.0f));
            for (const glm::vec3& value : baked.vpls) EXPECT_EQ(value, glm::vec3(0.0f));
            EXPECT_EQ(baked.status.non_finite, 0u);
            EXPECT_EQ(baked.status.power_direct, 0.0);
            EXPECT_EQ(baked.status.power_shot, 0.0);
        }
}

// Light that is no number at one VPL: counted, however often it is sent on, and gone when the light
// is.
TEST_P(LightAtlasMode, CountsWhatIsNotFinite) {
    const Bakery& bakery = small_room();
    const float wrong[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity()};
    for (const float value : wrong)
        for (const std::uint32_t bounces : {0u, 1u, 3u}) {
            LightAtlasOptions options = test::bake_options(GetParam());
            options.bounces = bounces;
            std::vector<glm::vec3> direct(bakery.vpls.vpls.size(), glm::vec3(1.0f));
            direct[17].y = value;
            const Baked baked = test::bake_from(bakery, options, direct);
            EXPECT_GT(baked.status.non_finite, 0u) << value << ", " << bounces << " bounces";
            std::size_t found = 0;
            for (const glm::vec3& texel : baked.texels) found += !std::isfinite(texel.y);
            EXPECT_GT(found, 0u) << value << ", " << bounces << " bounces";
        }
    LightAtlasSolver solver = bakery.solver(test::bake_options(GetParam()));
    const SiteBuffers& sites = solver.sites();
    ASSERT_TRUE(solver.run([&](double) {
        const std::uint32_t all_bits = 0xffffffff;
        if (test::direct_is_known(solver))
            test::device().queue.enqueueWriteBuffer(sites.light, CL_TRUE, 0, 4, &all_bits);
        return true;
    }));
    EXPECT_GT(solver.status().non_finite, 0u);
    ASSERT_TRUE(solver.run());
    EXPECT_EQ(solver.status().non_finite, 0u);
}

TEST(LightAtlasModes, RefuseWhatCannotWork) {
    const Bakery& bakery = small_room();
    const auto refused = [&](auto change) {
        LightAtlasOptions options = packets();
        change(options);
        return test::refusal<Error>([&] { bakery.solver(options); });
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    using Options = LightAtlasOptions;
    EXPECT_NE(refused([](Options& o) { o.bounces = 1001; }).find("bounces"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.threshold = 0.0f; }).find("threshold"), std::string::npos);
    EXPECT_NE(refused([&](Options& o) { o.threshold = nan; }).find("threshold"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.hemicube_size = 65; }).find("even"), std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.build.storage = Storage::half; }).find("storage is half"),
              std::string::npos);
    EXPECT_NE(refused([](Options& o) { o.hemicube_size = 2048; }).find("hemicube_size"),
              std::string::npos);

    Options poor = packets();
    poor.memory_budget = 100000;
    const std::string advice = test::refusal<DeviceError>([&] { bakery.solver(poor); });
    EXPECT_NE(advice.find("memory_budget allows 0.1 MB"), std::string::npos) << advice;

    const Bakery other(furnace({.subdivisions = 2}), {.vpls = 50, .atlas = 256});
    const auto with = [&](const VplLayout& vpls, const AtlasLayout& atlas) {
        return test::refusal<Error>([&] {
            LightAtlasSolver(test::programs(), test::device().queue, bakery.on_device, vpls, atlas);
        });
    };
    for (const std::string& said :
         {with(other.vpls, bakery.atlas), with(bakery.vpls, other.atlas)}) {
        EXPECT_NE(said.find("a layout names triangle"), std::string::npos) << said;
        EXPECT_NE(said.find("the scene has 20"), std::string::npos) << said;
    }
    EXPECT_NE(with({}, bakery.atlas).find("no VPL"), std::string::npos);
    EXPECT_NE(with(bakery.vpls, {}).find("no texel"), std::string::npos);
}

}  // namespace
}  // namespace clgi
