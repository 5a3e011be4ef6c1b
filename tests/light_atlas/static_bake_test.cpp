// Bakes of what stands still: which triangles these are, and light at points in space, against
// closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/static_bake.hpp>
#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>

#include "light_baking.hpp"
#include "math_modes.hpp"
#include "moving_box.hpp"

namespace clgi {
namespace {

using test::Bakery;

TEST(StaticScene, IsWithoutWhatAClipMoves) {
    const Scene scene = test::moving_box_room();
    const StaticScene fixed = static_scene(scene);
    EXPECT_EQ(fixed.scene.triangles.size(), scene.triangles.size() - 12);
    for (std::size_t t = 0; t < fixed.triangles.size(); ++t) {
        EXPECT_EQ(fixed.triangles[t], t < 24 ? t : t + 12);  // the box lies between others
        for (int k = 0; k < 3; ++k)
            EXPECT_EQ(fixed.scene.triangles[t].vertex[k],
                      scene.triangles[fixed.triangles[t]].vertex[k]);
    }
    EXPECT_FALSE(fixed.scene.animation);
    // Both have the same units on the device.
    const SceneFrame a = test::on_device(scene).frame(), b = test::on_device(fixed.scene).frame();
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.scale, b.scale);
    EXPECT_EQ(a.exposure, b.exposure);
    EXPECT_EQ(a.radius, b.radius);

    // Also where what moves is what makes the scene large.
    Scene apart = scene;
    apart.moving_bounds.reset();
    for (std::uint32_t v = scene.triangles[24].vertex[0]; v < scene.triangles[36].vertex[0]; ++v)
        apart.positions[v] = scene.positions[v] + 7.0;
    const SceneFrame c = test::on_device(apart).frame();
    const SceneFrame d = test::on_device(static_scene(apart).scene).frame();
    EXPECT_EQ(c.origin, d.origin);
    EXPECT_EQ(c.scale, d.scale);
    EXPECT_NE(c.scale, a.scale);

    EXPECT_FALSE(fixed.moving_emission);
    Scene glows = scene;
    glows.materials[scene.triangles[24].material].emission = {0.0f, 0.1f, 0.0f};
    EXPECT_TRUE(static_scene(glows).moving_emission);
    EXPECT_TRUE(scene_analysis(glows).motion.moving_emission);
    EXPECT_FALSE(scene_analysis(scene).motion.moving_emission);

    EXPECT_TRUE(moves(scene));
    Scene rests = scene;
    rests.animation.reset();
    EXPECT_FALSE(moves(rests));
    EXPECT_THROW(make_static_bake(rests), InputError);
    EXPECT_EQ(static_scene(rests).triangles.size(), scene.triangles.size());
}

TEST(StaticScene, HasItsAtlasInTheWhole) {
    const Scene scene = test::moving_box_room();
    const StaticBake bake = make_static_bake(scene, {.count = 100}, {.size = 64});
    const AtlasLayout &part = bake.layout.atlas, &whole = bake.whole;
    ASSERT_EQ(whole.triangle_chart.size(), scene.triangles.size());
    ASSERT_EQ(whole.uvs.size(), 3 * scene.triangles.size());
    std::size_t without = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        without += whole.triangle_page[t] == ATLAS_NONE && whole.triangle_chart[t] == ATLAS_NONE;
    EXPECT_EQ(without, 12u);
    for (std::size_t t = 0; t < bake.static_scene.triangles.size(); ++t) {
        const std::size_t to = bake.static_scene.triangles[t];
        EXPECT_EQ(whole.triangle_chart[to], part.triangle_chart[t]);
        EXPECT_EQ(whole.triangle_page[to], part.triangle_page[t]);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(whole.uvs[3 * to + k], part.uvs[3 * t + k]);
    }
    ASSERT_EQ(whole.texels.size(), part.texels.size());
    for (std::size_t i = 0; i < part.texels.size(); ++i)
        EXPECT_EQ(whole.texels[i].triangle, bake.static_scene.triangles[part.texels[i].triangle]);
    // The volume covers the way of the box, which is found if the scene does not say it.
    Scene silent = scene;
    silent.moving_bounds.reset();
    EXPECT_EQ(make_static_bake(silent, {.count = 100}, {.size = 64}).volume.first,
              bake.volume.first);
    const IrradianceVolume& v = bake.volume;
    const glm::dvec3 low = v.first - 0.5 * v.spacing;
    const glm::dvec3 high = low + v.spacing * glm::dvec3(v.count);
    for (int k = 0; k < 3; ++k) {
        EXPECT_LE(low[k], scene.moving_bounds->low[k] + 1e-9);
        EXPECT_GE(high[k], scene.moving_bounds->high[k] - 1e-9);
    }
}

TEST(StaticScene, RefusesWhatDoesNotBelong) {
    const Scene scene = test::moving_box_room();
    const StaticBake bake = make_static_bake(scene, {.count = 50}, {.size = 64});
    const std::size_t count = scene.triangles.size();
    std::vector<std::uint32_t> few = bake.static_scene.triangles;
    few.pop_back();
    EXPECT_THROW(atlas_of_whole(bake.layout.atlas, few, count), Error);
    EXPECT_THROW(atlas_of_whole(bake.layout.atlas, bake.static_scene.triangles, count - 1), Error);
    Scene all = scene;  // nothing stands still
    for (SceneTriangle& triangle : all.triangles)
        triangle.vertex[0] = scene.triangles[24].vertex[0];
    EXPECT_THROW(make_static_bake(all, {.count = 50}, {.size = 64}), InputError);
}

CLGI_IN_BOTH_MATHS(BakePoints);

// In a sphere of the albedo p with a point light I in its middle every wall shines alike, so every
// point in it receives I p / ((1 - p) R^2), whichever way it faces.
TEST_P(BakePoints, HaveTheLightOfASphere) {
    Scene scene = furnace({.light = LightSource::point, .albedo = 0.6f});
    scene.lights[0].intensity = {1.0f, 2.0f, 5.0f};
    const Bakery bakery(scene, {.vpls = 300, .atlas = 64});
    std::vector<BakePoint> points;
    for (const double at : {0.0, 0.3, 0.6})
        for (const glm::vec3& n : {glm::vec3(0, 1, 0), glm::normalize(glm::vec3(1, -2, 3))})
            points.push_back({glm::dvec3(at, -0.2, 0.5 * at), n});
    for (const bool occlusion : {true, false})
        for (const int refine : {1, 2}) {
            LightAtlasOptions options = test::converged(GetParam());
            options.occlusion = occlusion ? Occlusion::automatic : Occlusion::none;
            options.refine = refine;
            options.direct = true;  // of texels alone
            LightAtlasSolver solver(test::programs(), test::device().queue, bakery.on_device,
                                    bakery.vpls, bakery.atlas, options, points);
            ASSERT_TRUE(solver.run());
            EXPECT_EQ(solver.status().non_finite, 0u);
            const auto found = solver.point_irradiance();
            ASSERT_EQ(found.size(), points.size());
            for (std::size_t i = 0; i < found.size(); ++i)
                for (int c = 0; c < 3; ++c) {
                    const double wanted = 1.5 * scene.lights[0].intensity[c];
                    EXPECT_NEAR(found[i][c], wanted, 0.02 * wanted)
                        << i << " " << c << " occlusion " << occlusion << " refine " << refine;
                }
        }
}

// Also where memory keeps nothing of what they see, after a break, and under other lights.
TEST_P(BakePoints, HaveTheSameLightHoweverItIsKept) {
    const Scene scene = test::moving_box_room();
    Bakery bakery(scene, {.vpls = 150, .atlas = 64});
    const std::vector<BakePoint> points = {{{0.2, 1.0, 0.3}, {0.0f, 0.0f, 1.0f}},
                                           {{-1.2, 0.4, 1.0}, {1.0f, 0.0f, 0.0f}}};
    const auto bake = [&](const LightAtlasOptions& options) {
        return std::make_unique<LightAtlasSolver>(test::programs(), test::device().queue,
                                                  bakery.on_device, bakery.vpls, bakery.atlas,
                                                  options, points);
    };
    LightAtlasOptions options = test::bake_options(GetParam());
    options.build.form = Form::packets;  // whose batches are small beside what is kept
    const auto kept = bake(options);
    ASSERT_TRUE(kept->run());
    EXPECT_TRUE(kept->status().visibility_kept);
    const auto wanted = kept->point_irradiance();
    EXPECT_GT(wanted[0].x, 0.0f);
    options.memory_budget = kept->bytes() - 1;
    const auto drawn = bake(options);
    ASSERT_TRUE(drawn->run());
    EXPECT_FALSE(drawn->status().visibility_kept);
    EXPECT_TRUE(test::same_bits(drawn->point_irradiance(), wanted));
    options.memory_budget = 0;
    const auto broken = bake(options);
    EXPECT_FALSE(broken->run([](double done) { return done < 0.4; }));
    const auto state = broken->state();
    ASSERT_TRUE(state);
    const auto resumed = bake(options);
    resumed->restore(*state);
    ASSERT_TRUE(resumed->run());
    EXPECT_TRUE(test::same_bits(resumed->point_irradiance(), wanted));
    EXPECT_THROW(bakery.solver(options).restore(*state), Error);
    Light light = scene.lights[0];
    light.intensity *= 2.0f;
    bakery.on_device.set_light(0, light);
    kept->lights_changed();
    ASSERT_TRUE(kept->update(0.0));
    const auto brighter = kept->point_irradiance();
    for (std::size_t i = 0; i < points.size(); ++i)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(brighter[i][c] / wanted[i][c], 2.0, 1e-3);
}

// Two plates that face each other, lit by a point light between them, and points beside them: the
// integral of what the plates reflect, in double precision. Nothing fills what else the points
// face.
TEST_P(BakePoints, HaveTheLightOfPlatesAtTheirSide) {
    Scene scene = test::plain_scene({0.8f, 0.5f, 0.3f});
    test::add_quad(scene, {glm::dvec3(-1, 0, 1), {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}});
    test::add_quad(scene, {glm::dvec3(-1, 1, -1), {1, 1, -1}, {1, 1, 1}, {-1, 1, 1}});
    scene.lights = {test::point_light({0.2, 0.5, -0.1}, 3.0f)};
    scene.lights[0].intensity *= glm::vec3(1.0f, 2.0f, 0.5f);
    std::vector<BakePoint> points;
    for (const glm::dvec3& at : {glm::dvec3(1.6, 0.4, 0.2), {-1.5, 0.7, -1.4}, {0.1, 0.5, 2.0}})
        for (const glm::vec3& n : {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
                                   glm::normalize(glm::vec3(-at.x, 0.3, -at.z))})
            points.push_back({at, n});
    const Bakery bakery(scene, {.vpls = 600, .atlas = 64});
    LightAtlasOptions options = test::bake_options(GetParam());
    options.bounces = 1;
    LightAtlasSolver solver(test::programs(), test::device().queue, bakery.on_device, bakery.vpls,
                            bakery.atlas, options, points);
    ASSERT_TRUE(solver.run());
    const auto found = solver.point_irradiance();
    constexpr int steps = 200;
    for (std::size_t p = 0; p < points.size(); ++p) {
        glm::dvec3 wanted(0.0);
        for (const double height : {0.0, 1.0})
            for (int i = 0; i < steps * steps; ++i) {
                const glm::dvec3 x(-1.0 + 2.0 * (i % steps + 0.5) / steps, height,
                                   -1.0 + 2.0 * (i / steps + 0.5) / steps);
                const glm::dvec3 up(0.0, height > 0.5 ? -1.0 : 1.0, 0.0);
                const glm::dvec3 lamp = glm::dvec3(scene.lights[0].position) - x;
                const double lit = glm::dot(up, lamp) / std::pow(glm::length(lamp), 3.0);
                const glm::dvec3 to = points[p].position - x;
                const double meets = std::max(0.0, -glm::dot(to, glm::dvec3(points[p].normal))) *
                                     std::max(0.0, glm::dot(to, up)) /
                                     (3.14159265358979 * std::pow(glm::dot(to, to), 2.0));
                wanted += lit * meets * (4.0 / (steps * steps)) *
                          glm::dvec3(scene.lights[0].intensity) *
                          glm::dvec3(scene.materials[0].base_color);
            }
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[p][c] / wanted[c], 1.0, 0.03) << p << " " << c;
    }
}

// Texels do not notice points beside them.
TEST_P(BakePoints, LeaveTexelsAsTheyAre) {
    const Bakery bakery(test::moving_box_room(), {.vpls = 150, .atlas = 64});
    std::vector<BakePoint> points(37, {{0.2, 1.0, 0.3}, {0.0f, 0.0f, 1.0f}});
    for (const bool occlusion : {true, false}) {
        LightAtlasOptions options = test::bake_options(GetParam());
        options.occlusion = occlusion ? Occlusion::automatic : Occlusion::none;
        LightAtlasSolver with(test::programs(), test::device().queue, bakery.on_device, bakery.vpls,
                              bakery.atlas, options, points);
        ASSERT_TRUE(with.run());
        EXPECT_TRUE(test::same_bits(with.irradiance(), test::bake(bakery, options).texels));
        // All are in the same place.
        const auto found = with.point_irradiance();
        for (const glm::vec3& one : found) EXPECT_EQ(one, found[0]);
        EXPECT_GT(found[0].x, 0.0f);
    }
}

// Walls shadow points, and points within them are all but dark.
TEST_P(BakePoints, AreShadowed) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.2f});
    test::add_box(scene, {-2, 0, -2}, {2, 2, 2}, -1);
    test::add_box(scene, {0.2, 0.0, -2.0}, {0.6, 2.0, 2.0}, 1);  // two rooms, one of them dark
    scene.lights = {test::point_light({-1.0, 1.2, 0.3}, 8.0f)};
    const Bakery bakery(scene, {.vpls = 200, .atlas = 64});
    const std::vector<BakePoint> points = {
        {{-0.5, 1.0, 0.4}, {1, 0, 0}}, {{1.3, 1.0, 0.4}, {-1, 0, 0}}, {{0.4, 1.0, 0.4}, {0, 1, 0}}};
    LightAtlasSolver solver(test::programs(), test::device().queue, bakery.on_device, bakery.vpls,
                            bakery.atlas, test::bake_options(GetParam()), points);
    ASSERT_TRUE(solver.run());
    const auto found = solver.point_irradiance();
    EXPECT_GT(found[0].x, 1.0f);
    EXPECT_LT(found[1].x, 1e-3f * found[0].x);
    EXPECT_LT(found[2].x, 5e-3f * found[0].x);
}

TEST(BakePoints, AreRefusedWhereTheyAreNone) {
    const Bakery bakery(test::moving_box_room(), {.vpls = 50, .atlas = 64});
    const auto make = [&](const BakePoint& point, LightAtlasOptions options = {}) {
        LightAtlasSolver(test::programs(), test::device().queue, bakery.on_device, bakery.vpls,
                         bakery.atlas, options, {point});
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NO_THROW(make({{0, 1, 0}, {0, 1, 0}}));
    EXPECT_THROW(make({{0, nan, 0}, {0, 1, 0}}), Error);
    EXPECT_THROW(make({{0, 1, 0}, {0, 2, 0}}), Error);
    EXPECT_THROW(make({{0, 1, 0}, {0, 0, 0}}), Error);
    EXPECT_THROW(make({{0, 1, 0}, {0, static_cast<float>(nan), 0}}), Error);
    LightAtlasViewOptions small;
    small.width = 8;
    small.height = 6;
    const auto view = [&](const IrradianceVolume& volume) {
        LightAtlasView(test::programs(), test::device().queue, bakery.on_device, bakery.atlas,
                       small, volume);
    };
    const IrradianceVolume usual = make_irradiance_volume({glm::dvec3(0.0), glm::dvec3(1.0)}, 8);
    EXPECT_NO_THROW(view(usual));
    const auto changed = [&](auto&& change) {
        IrradianceVolume out = usual;
        change(out);
        EXPECT_THROW(view(out), Error);
    };
    changed([](IrradianceVolume& v) { v.spacing = 0.0; });
    changed([&](IrradianceVolume& v) { v.spacing = nan; });
    changed([&](IrradianceVolume& v) { v.first = glm::dvec3(nan); });
    changed([](IrradianceVolume& v) { v.count.y = 0; });
    changed([](IrradianceVolume& v) { v.places.pop_back(); });
    changed([](IrradianceVolume& v) { v.distances.pop_back(); });
    changed([](IrradianceVolume& v) { ++v.open_count; });
    changed([](IrradianceVolume& v) { v.places[3].w = 8.0f; });
    changed([&](IrradianceVolume& v) { v.places[3].y = static_cast<float>(nan); });
    changed([&](IrradianceVolume& v) { v.distances[5].x = static_cast<float>(nan); });
    LightAtlasOptions projected;
    projected.filling = Filling::project;
    EXPECT_THROW(make({{0, 1, 0}, {0, 1, 0}}, projected), Error);
}

}  // namespace
}  // namespace clgi
