// Baked light of surfaces that cover a part of what lies behind them.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/clgi.hpp>
#include <clgi/reference.hpp>
#include <cmath>

#include "light_baking.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

// A dark room, in it a bright, leaning sheet between a lamp and half of the room. alpha: of the
// sheet from its one side to the other.
Scene divided_room(AlphaMode mode, float from, float to) {
    Scene scene = test::plain_scene({0.2f, 0.25f, 0.3f});
    test::add_box(scene, {-1, 0, -1}, {1, 2, 1}, -1);
    Material sheet;
    sheet.base_color = {0.9f, 0.6f, 0.3f, 1.0f};
    sheet.alpha_mode = mode;
    sheet.double_sided = true;
    const std::size_t before = scene.positions.size();
    test::add_quad(scene,
                   {{{-0.8, 0.3, -0.1}, {0.8, 0.3, -0.1}, {0.8, 1.6, 0.2}, {-0.8, 1.6, 0.2}}},
                   test::add_material(scene, sheet));
    scene.colors.assign(scene.positions.size(), glm::vec4(1.0f));
    for (std::size_t v = before; v < scene.positions.size(); ++v)
        scene.colors[v].a = scene.positions[v].x < 0.0 ? from : to;
    scene.lights = {test::point_light({0.1, 1.0, 0.6}, 3.0f)};
    return scene;
}

// Mean indirect irradiance of the room, and of the sheet, by a bake and by the path tracer.
void expect_the_path_tracers(const Scene& scene, const char* what) {
    const test::Bakery bakery(scene, {.vpls = 600, .atlas = 96, .samples_per_vpl = 24});
    const test::Baked made = test::bake(bakery, test::converged());
    std::vector<reference::Place> places;
    std::vector<std::size_t> listed;
    for (std::size_t i = 0; i < bakery.atlas.texels.size(); i += 13) {
        const AtlasTexel& texel = bakery.atlas.texels[i];
        if (scene.triangles[texel.triangle].material != 0) continue;
        const glm::vec3 normal(glm::normalize(test::normal_of(scene, texel.triangle)));
        places.push_back({test::position(scene, texel), normal, normal});
        listed.push_back(i);
    }
    ASSERT_GT(places.size(), 200u);
    reference::Options options;
    options.effects.emission = options.effects.direct = false;
    options.samples = 256;
    const auto truth = reference::PathTracer(scene).irradiance(places, options).values;
    for (int c = 0; c < 3; ++c) {
        double found = 0.0, wanted = 0.0;
        for (std::size_t k = 0; k < places.size(); ++k) {
            found += made.texels[listed[k]][c];
            wanted += truth[k][c];
        }
        EXPECT_NEAR(found / wanted, 1.0, 0.02) << what << ", channel " << c;
    }
}

TEST(WeighedByAlpha, BakedLightIsThePathTracers) {
    expect_the_path_tracers(divided_room(AlphaMode::opaque, 1.0f, 1.0f), "whole");
    expect_the_path_tracers(divided_room(AlphaMode::blend, 0.3f, 0.3f), "blended");
    expect_the_path_tracers(divided_room(AlphaMode::blend, 0.0f, 0.8f), "from nothing to more");
    expect_the_path_tracers(divided_room(AlphaMode::mask, 0.0f, 1.0f), "half cut out");
}

}  // namespace
}  // namespace clgi
