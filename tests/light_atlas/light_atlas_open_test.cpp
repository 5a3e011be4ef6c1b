// Light atlases where nothing lies between surfaces: closed forms, the light of bakes that draw
// hemicubes, and what is saved.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>

#include "effect_cost.hpp"
#include "frames.hpp"
#include "lab/scenes/rooms.hpp"
#include "light_baking.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Baked;
using test::Bakery;

CLGI_IN_BOTH_MATHS(LightAtlasOpen);

LightAtlasOptions open_options(LightAtlasOptions options = test::bake_options()) {
    options.occlusion = Occlusion::none;
    options.emitters.shadows = false;
    return options;
}

// A closed tetrahedron with crooked walls, coloured lights of every kind.
const Bakery& crooked_room() {
    static const Bakery bakery(test::convex_room(false), {.vpls = 200, .atlas = 48});
    return bakery;
}

// In a sphere with the albedo p and a point light I in its middle all places receive
// I p / ((1 - p) R^2) by reflection. Facets make it 0.3 % smaller.
TEST_P(LightAtlasOpen, HasTheLightOfASphere) {
    Scene scene = furnace({.light = LightSource::point, .albedo = 0.6f});
    scene.lights[0].intensity = {1.0f, 2.0f, 5.0f};
    const Bakery bakery(scene, {.vpls = 300, .atlas = 64});
    const Baked baked = test::bake(bakery, open_options(test::converged(GetParam())));
    const test::Spread texels = test::over_texels(bakery, baked.texels);
    for (int c = 0; c < 3; ++c) {
        const double wanted = 1.5 * scene.lights[0].intensity[c];
        EXPECT_NEAR(texels.mean[c], wanted, 0.01 * wanted) << c;
        EXPECT_GT(texels.least[c], 0.96 * wanted) << c;
        EXPECT_LT(texels.most[c], 1.04 * wanted) << c;
    }
}

// What arrives by reflection in a closed room: p / (1 - p) of the direct power, in each channel,
// where all walls reflect alike.
TEST_P(LightAtlasOpen, KeepsTheEnergyOfAClosedRoom) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.2f});
    test::add_box(scene, {-1, 0, -2}, {1.5, 1.2, 1}, -1);
    scene.lights = {test::point_light({0.3, 0.9, -0.4}, 8.0f)};
    scene.lights[0].intensity *= glm::vec3(1.0f, 0.4f, 2.0f);
    const Bakery bakery(scene, {.vpls = 300, .atlas = 64});
    LightAtlasSolver solver = bakery.solver(open_options(test::converged(GetParam())));
    ASSERT_TRUE(solver.run());
    const Baked baked(solver);
    const LightAtlasStatus& s = baked.status;
    EXPECT_LT(s.power_lost, 1e-5 * s.power_shot);
    EXPECT_NEAR(s.power_received + s.power_lost, s.power_shot, 1e-5 * s.power_shot);
    const glm::dvec3 flux = 4.0 * 3.14159265358979 * glm::dvec3(scene.lights[0].intensity);
    const double area = 2.0 * (2.5 * 1.2 + 2.5 * 3.0 + 1.2 * 3.0);
    const test::Spread vpls = test::over_vpls(bakery, baked.vpls);
    const test::Spread texels = test::over_texels(bakery, baked.texels);
    for (int c = 0; c < 3; ++c) {
        const double albedo = scene.materials[0].base_color[c];
        // Sample points take the light of a point light to within 1 %.
        const double all = flux[c] / (1.0 - albedo) / area;
        EXPECT_NEAR(vpls.mean[c], all, 0.01 * all) << c;
        EXPECT_NEAR(texels.mean[c], all * albedo, 0.03 * all * albedo) << c;
    }
}

TEST_P(LightAtlasOpen, IsTheLightOfHemicubes) {
    const LightAtlasOptions options = test::bake_options(GetParam());
    LightAtlasOptions drawn = open_options(options);
    drawn.occlusion = Occlusion::automatic;
    drawn.refine = 1;
    const Baked with = test::bake(crooked_room(), drawn),
                without = test::bake(crooked_room(), open_options(options));
    // Pixels of hemicubes beside the sharp edges of this room.
    EXPECT_LT(test::relative_difference(without.texels, with.texels), 0.02);
    EXPECT_LT(test::relative_difference(without.vpls, with.vpls), 0.02);
    EXPECT_GT(test::relative_difference(without.texels, with.texels), 0.0);
    EXPECT_NEAR(without.status.power_shot, with.status.power_shot, 2e-3 * with.status.power_shot);
    EXPECT_EQ(without.status.non_finite, 0u);
}

// What leaves through the open side is lost: the sum of form factors, instead of rays.
TEST_P(LightAtlasOpen, LosesWhatLeavesAnOpenRoom) {
    const Bakery bakery(test::convex_room(true), {.vpls = 200, .atlas = 48});
    const LightAtlasOptions options = test::bake_options(GetParam());
    LightAtlasOptions drawn = open_options(options);
    drawn.occlusion = Occlusion::automatic;
    drawn.refine = 1;
    const Baked with = test::bake(bakery, drawn),
                without = test::bake(bakery, open_options(options));
    EXPECT_GT(with.status.power_lost, 0.1 * with.status.power_shot);
    EXPECT_NEAR(without.status.power_lost, with.status.power_lost, 0.02 * with.status.power_lost);
    EXPECT_LT(test::relative_difference(without.texels, with.texels), 0.03);
}

// Nothing is promised of a scene in which something lies between: light goes through it.
TEST(LightAtlasOpen, GoesThroughAWall) {
    Scene scene = test::plain_scene(glm::vec3(0.5f));
    test::add_box(scene, {0, 0, 0}, {2, 1, 1}, -1);
    test::add_quad(scene, {glm::dvec3(1.02, 0, 0), {1.02, 1, 0}, {1.02, 1, 1}, {1.02, 0, 1}});
    test::add_quad(scene, {glm::dvec3(1, 0, 0), {1, 0, 1}, {1, 1, 1}, {1, 1, 0}});
    scene.lights = {test::point_light({0.3, 0.6, 0.5})};
    const Bakery bakery(scene, {.vpls = 200, .atlas = 48});
    const auto beyond = [&](bool occlusion) {
        LightAtlasOptions options = test::bake_options();
        options.occlusion = occlusion ? Occlusion::automatic : Occlusion::none;
        const Baked baked = test::bake(bakery, options);
        return test::over_texels(
                   bakery, baked.texels,
                   [&](const AtlasTexel& texel) {
                       double x = double{1.0f - texel.b1 - texel.b2} *
                                  test::corner(scene, texel.triangle, 0).x;
                       x += texel.b1 * test::corner(scene, texel.triangle, 1).x;
                       return x + texel.b2 * test::corner(scene, texel.triangle, 2).x > 1.1;
                   })
            .mean.y;
    };
    EXPECT_LT(beyond(true), 0.01);
    EXPECT_GT(beyond(false), 0.1);
}

// ---- one answer ----------------------------------------------------------------------------

TEST(LightAtlasOpen, KeepsTransportOrNotForAboutTheSameLight) {
    // More VPLs than a batch has.
    const Bakery bakery(test::convex_room(false), {.vpls = 300, .atlas = 48});
    LightAtlasOptions options = open_options();
    options.bounces = 4;
    const Baked kept = test::bake(bakery, options);
    options.memory_budget = bakery.solver(options).bytes() - 1;
    const Baked made = test::bake(bakery, options);
    EXPECT_TRUE(kept.status.transport_kept);
    EXPECT_FALSE(kept.status.visibility_kept);
    EXPECT_FALSE(made.status.transport_kept);
    EXPECT_LT(test::relative_difference(made.texels, kept.texels), 0.01);
    EXPECT_LT(test::relative_difference(made.vpls, kept.vpls), 0.01);
}

TEST(LightAtlasOpen, GivesTheSameBitsAgainAndAfterACancelledBake) {
    const Baked wanted = test::bake(crooked_room(), open_options());
    int reports = 0;
    LightAtlasSolver solver = crooked_room().solver(open_options());
    ASSERT_TRUE(solver.run([&](double) { return ++reports > 0; }));
    ASSERT_GT(reports, 3);
    for (int last = 1; last < reports; ++last) {
        int seen = 0;
        LightAtlasSolver again = crooked_room().solver(open_options());
        EXPECT_FALSE(again.run([&](double) { return ++seen < last; }));
        const auto state = again.state();
        ASSERT_TRUE(again.run());
        EXPECT_TRUE(test::same_bits(Baked(again).texels, wanted.texels)) << last;
        if (!state) continue;
        LightAtlasSolver other = crooked_room().solver(open_options());
        other.restore(*state);
        ASSERT_TRUE(other.run());
        EXPECT_TRUE(test::same_bits(Baked(other).texels, wanted.texels)) << last;
    }
}

// Only what changed is sent, and it adds up to a fresh bake.
TEST(LightAtlasOpen, FollowsChangedLights) {
    Bakery bakery(test::convex_room(false), {.vpls = 200, .atlas = 48});
    LightAtlasSolver solver = bakery.solver(open_options());
    ASSERT_TRUE(solver.run());
    const Baked before(solver);
    EXPECT_EQ(before.status.sent, bakery.vpls.vpls.size());
    Light light = bakery.scene.lights[1];
    light.intensity *= glm::vec3(9.0f, 0.5f, 6.0f);
    bakery.on_device.set_light(1, light);
    solver.lights_changed();
    ASSERT_TRUE(solver.update(0.01));
    const Baked updated(solver), fresh = test::bake(bakery, open_options());
    EXPECT_GT(updated.status.sent, 0u);
    EXPECT_LT(test::relative_difference(updated.texels, fresh.texels), 0.01);
    EXPECT_GT(test::relative_difference(before.texels, fresh.texels), 0.02);
    ASSERT_TRUE(solver.update(0.01));
    EXPECT_EQ(solver.status().sent, 0u);
    EXPECT_TRUE(test::same_bits(solver.irradiance(), updated.texels));
}

// ---- what it costs -------------------------------------------------------------------------

const Bakery& box() {
    static const Bakery bakery(
        [] {
            Scene scene = test::plain_scene(glm::vec3(0.5f));
            test::add_box(scene, {-1, 0, -2}, {1.5, 1.2, 1}, -1);
            scene.lights = {test::point_light({0.3, 0.9, -0.4}, 8.0f)};
            return scene;
        }(),
        {.vpls = 200, .atlas = 48});
    return bakery;
}

test::Cost cost_of(const LightAtlasOptions& options) {
    const Programs own = test::own_programs();
    LightAtlasSolver solver(own, test::device().queue, box().on_device, box().vpls, box().atlas,
                            options);
    EXPECT_TRUE(solver.run());
    test::Cost out;
    out.kernels = own.built_kernels();
    out.add(solver.events());
    out.bytes = solver.bytes();
    return out;
}

TEST(LightAtlasOpen, DrawsNoHemicubeAndKeepsNoVisibility) {
    LightAtlasOptions drawn = open_options();
    drawn.occlusion = Occlusion::automatic;
    drawn.refine = 1;
    drawn.hemicube_size = 64;
    drawn.build.form = Form::packets;  // whose batches are counted
    const test::Cost on = cost_of(drawn), off = cost_of(open_options());
    for (const char* name : {"gbuffer/cubes", "gbuffer/raster", "atlas/see", "atlas/flat",
                             "vpl/reach ", "atlas/nearest"})
        EXPECT_EQ(off.built(name), 0u) << name;
    EXPECT_EQ(off.built("-DCLGI_OPEN"), 2u);
    EXPECT_EQ(off.built("vpl/reach_open"), 1u);
    EXPECT_EQ(off.built("vpl/transport"), 1u);
    EXPECT_EQ(off.built("atlas/gather"), 1u);
    EXPECT_EQ(on.built("-DCLGI_OPEN") + on.built("vpl/reach_open"), 0u);
    EXPECT_EQ(on.built("raster_views"), 1u);
    for (const char* name : {"raster", "cubes", "see", "nearest"}) {
        EXPECT_EQ(off.enqueued(name), 0u) << name;
        EXPECT_GT(on.enqueued(name), 0u) << name;
    }
    // Views and depth of a batch, and the bits of all.
    const std::size_t views = 5 * SEEN_VPLS * sizeof(View);
    const std::size_t pixels = std::size_t{3} * SEEN_VPLS * 64 * 64 * sizeof(std::uint32_t);
    const std::size_t stride = plane_stride(box().atlas.texels.size());
    EXPECT_EQ(on.bytes - off.bytes, views + pixels + seen_rows(box().vpls.vpls.size()) * stride);
}

TEST(LightAtlasOpen, CannotProjectHemicubes) {
    LightAtlasOptions options = open_options();
    options.filling = Filling::project;
    try {
        crooked_room().solver(options);
        ADD_FAILURE() << "it was taken";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("occlusion"), std::string::npos);
        EXPECT_NE(std::string(error.what()).find("project"), std::string::npos);
    }
}

}  // namespace
}  // namespace clgi
