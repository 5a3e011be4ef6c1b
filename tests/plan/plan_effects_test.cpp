// Which effects analysis call for, and the scene that is left of a plan. No device.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/error.hpp>
#include <clgi/plan.hpp>
#include <cmath>

#include "scenes.hpp"

namespace clgi {
namespace {

// A closed room with every effect in it.
SceneAnalysis everything() {
    SceneAnalysis out;
    out.lights.points = out.lights.spots = out.lights.directional = 1;
    out.lights.emission = true;
    out.lights.emissive_triangles = 3;
    out.lights.environment = true;
    out.lights.moving = true;
    out.surfaces.triangles = 100;
    out.surfaces.largest_albedo = 0.5;
    out.surfaces.gloss = 0.1;
    out.surfaces.glossy_area = 0.5;
    out.surfaces.textures = out.surfaces.cutouts = true;
    out.motion.geometry = true;
    return out;
}

const EffectChoice& of(const EffectChoices& choices, Effect effect) {
    return choices[static_cast<std::size_t>(effect)];
}

void expect_choice(const EffectChoices& choices, Effect effect, bool on, Evidence evidence) {
    EXPECT_EQ(of(choices, effect).on, on) << name_of(effect);
    EXPECT_EQ(of(choices, effect).evidence, evidence) << name_of(effect);
    if (!on && evidence != Evidence::measured) {
        EXPECT_EQ(of(choices, effect).bound, 0.0) << name_of(effect);
    }
}

TEST(Effects, HaveNamesThatLeadBack) {
    for (std::size_t k = 0; k < effect_count; ++k) {
        const auto effect = static_cast<Effect>(k);
        EXPECT_EQ(effect_of(name_of(effect)), effect);
        EXPECT_EQ(of(choose_effects(everything(), 0.01), effect).effect, effect);
    }
    EXPECT_EQ(effect_of("caustics"), std::nullopt);
    EXPECT_EQ(method_of("atlas"), Method::light_atlas);
    EXPECT_EQ(method_of("auto"), std::nullopt);
}

TEST(Effects, AreOnWhereAllOfThemAre) {
    for (const EffectChoice& choice : choose_effects(everything(), 0.01)) {
        EXPECT_TRUE(choice.on) << name_of(choice.effect);
        EXPECT_EQ(choice.evidence, Evidence::needed);
        EXPECT_TRUE(std::isinf(choice.bound));
        EXPECT_FALSE(choice.why.empty());
    }
}

TEST(Effects, AreOffWhereTheSceneHasNothingOfThem) {
    using Change = void (*)(SceneAnalysis&);
    const std::pair<Effect, Change> cases[] = {
        {Effect::point_light, [](SceneAnalysis& f) { f.lights.points = 0; }},
        {Effect::spot_light, [](SceneAnalysis& f) { f.lights.spots = 0; }},
        {Effect::directional_light, [](SceneAnalysis& f) { f.lights.directional = 0; }},
        {Effect::area_light, [](SceneAnalysis& f) { f.lights.emission = false; }},
        {Effect::gloss, [](SceneAnalysis& f) { f.surfaces.glossy_area = 0.0; }},
        {Effect::textures, [](SceneAnalysis& f) { f.surfaces.textures = false; }},
        {Effect::cutouts, [](SceneAnalysis& f) { f.surfaces.cutouts = false; }},
        {Effect::moving_geometry, [](SceneAnalysis& f) { f.motion.geometry = false; }},
        {Effect::moving_lights, [](SceneAnalysis& f) { f.lights.moving = false; }},
    };
    for (const auto& [effect, change] : cases) {
        SceneAnalysis analysis = everything();
        change(analysis);
        const EffectChoices choices = choose_effects(analysis, 0.01);
        for (const EffectChoice& choice : choices)
            expect_choice(choices, choice.effect, choice.effect != effect,
                          choice.effect == effect ? Evidence::absent : Evidence::needed);
    }
    SceneAnalysis dark = everything();
    dark.lights.environment = false;
    EffectChoices choices = choose_effects(dark, 0.01);
    expect_choice(choices, Effect::environment_light, false, Evidence::absent);
    expect_choice(choices, Effect::environment_shadows, false, Evidence::absent);
    expect_choice(choices, Effect::direct_shadows, true, Evidence::needed);
    SceneAnalysis sky = everything();
    sky.lights = LightAnalysis();
    sky.lights.environment = true;
    choices = choose_effects(sky, 0.01);
    expect_choice(choices, Effect::direct_shadows, false, Evidence::absent);
    expect_choice(choices, Effect::environment_shadows, true, Evidence::needed);
    expect_choice(choices, Effect::first_bounce, true, Evidence::needed);
    sky.lights = LightAnalysis();
    choices = choose_effects(sky, 0.01);
    for (const Effect effect :
         {Effect::first_bounce, Effect::further_bounces, Effect::indirect_occlusion})
        expect_choice(choices, effect, false, Evidence::absent);
}

TEST(Effects, AreOffWhereProofsSayThatTheyChangeNothing) {
    SceneAnalysis analysis = everything();
    analysis.proof.lights_open = true;
    expect_choice(choose_effects(analysis, 0.01), Effect::direct_shadows, false, Evidence::proven);
    expect_choice(choose_effects(analysis, 0.01), Effect::environment_shadows, true,
                  Evidence::needed);
    expect_choice(choose_effects(analysis, 0.01), Effect::indirect_occlusion, true,
                  Evidence::needed);
    analysis = everything();
    analysis.proof.environment_open = true;
    expect_choice(choose_effects(analysis, 0.01), Effect::environment_shadows, false,
                  Evidence::proven);
    expect_choice(choose_effects(analysis, 0.01), Effect::direct_shadows, true, Evidence::needed);
    analysis = everything();
    analysis.proof.surfaces_open = true;
    expect_choice(choose_effects(analysis, 0.01), Effect::indirect_occlusion, false,
                  Evidence::proven);
    expect_choice(choose_effects(analysis, 0.01), Effect::first_bounce, true, Evidence::needed);
    for (const bool black : {false, true}) {
        analysis = everything();
        if (black)
            analysis.surfaces.largest_albedo = 0.0;
        else
            analysis.proof.surfaces_apart = true;
        for (const Effect effect :
             {Effect::first_bounce, Effect::further_bounces, Effect::indirect_occlusion})
            expect_choice(choose_effects(analysis, 0.01), effect, false, Evidence::proven);
    }
}

// Surfaces reflect q = 0.1 at most. All bounces together are 1 / (1 - q) of the first one, the
// further ones q / (1 - q), and the margin is two.
TEST(Effects, AreLeftOutWhereAProbeBoundsThem) {
    SceneAnalysis analysis = everything();
    analysis.surfaces.largest_albedo = 0.1;
    analysis.surfaces.gloss = analysis.surfaces.glossy_area = 0.0;
    ProbeResult probe;
    probe.first_bounce = 0.018;
    EffectChoices choices = choose_effects(analysis, 0.01, probe);
    EXPECT_NEAR(of(choices, Effect::first_bounce).bound, 0.04, 1e-12);
    expect_choice(choices, Effect::first_bounce, true, Evidence::needed);
    EXPECT_NEAR(of(choices, Effect::further_bounces).bound, 0.004, 1e-12);
    expect_choice(choices, Effect::further_bounces, false, Evidence::measured);
    expect_choice(choices, Effect::indirect_occlusion, true, Evidence::needed);
    expect_choice(choose_effects(analysis, 0.0039, probe), Effect::further_bounces, true,
                  Evidence::needed);

    choices = choose_effects(analysis, 0.05, probe);
    expect_choice(choices, Effect::first_bounce, false, Evidence::measured);
    expect_choice(choices, Effect::further_bounces, false, Evidence::measured);
    expect_choice(choices, Effect::indirect_occlusion, false, Evidence::measured);
    EXPECT_NEAR(of(choices, Effect::first_bounce).bound, 0.04, 1e-12);

    analysis.surfaces.largest_albedo = 0.2;
    choices = choose_effects(analysis, 0.05, probe);
    EXPECT_NEAR(of(choices, Effect::first_bounce).bound, 0.045, 1e-12);
    // The scene reflects ten times as much as the picture shows: what goes on may come later.
    probe.reflected = 1.0;  // 2 0.2 0.2 / 0.8
    choices = choose_effects(analysis, 0.05, probe);
    EXPECT_NEAR(of(choices, Effect::further_bounces).bound, 0.1, 1e-12);
    EXPECT_NEAR(of(choices, Effect::first_bounce).bound, 0.136, 1e-12);
    expect_choice(choices, Effect::first_bounce, true, Evidence::needed);
    probe.reflected = 0.0;
    // Nor do pictures without gloss bound what is glossy, or bright surfaces.
    analysis.surfaces.glossy_area = 0.1;
    expect_choice(choose_effects(analysis, 0.05, probe), Effect::first_bounce, true,
                  Evidence::needed);
    analysis.surfaces.glossy_area = 0.0;
    analysis.surfaces.largest_albedo = 0.31;
    EXPECT_TRUE(std::isinf(of(choose_effects(analysis, 0.05, probe), Effect::first_bounce).bound));
    analysis.surfaces.largest_albedo = 0.2;
    // A camera that sees nothing lit says nothing.
    probe.first_bounce = INFINITY;
    expect_choice(choose_effects(analysis, 0.05, probe), Effect::first_bounce, true,
                  Evidence::needed);
}

// ---- what is left of a scene -------------------------------------------------------------------

Texture chessboard(std::uint8_t dark, std::uint8_t light) {
    Texture out;
    out.width = out.height = 2;
    out.srgb = false;
    for (const std::uint8_t value : {dark, light, light, dark})
        for (const int channel : {int{value}, value / 2, 10, 200})
            out.rgba.push_back(static_cast<std::uint8_t>(channel));
    return out;
}

// Every effect but motion.
Scene full_scene() {
    Scene scene = test::plain_scene({0.5f, 0.4f, 0.3f});
    test::add_floor(scene, 1.0);
    scene.uvs.assign(scene.positions.size(), glm::vec4(0.0f));
    scene.textures = {chessboard(0, 255), chessboard(128, 128)};
    Material& material = scene.materials[0];
    material.base_texture.texture = 0;
    material.roughness = 0.3f;
    material.specular = 1.0f;
    material.emission = {1.0f, 2.0f, 3.0f};
    scene.lights = {test::point_light({0, 1, 0}), test::spot_light({0, 1, 0}, {0, -1, 0}, 0.5),
                    test::directional_light({0, -1, 0}), test::point_light({0, 2, 0}, 0.0f)};
    scene.environment = Environment();
    return scene;
}

Plan plan_without(Effect effect) {
    Plan plan;
    for (std::size_t k = 0; k < effect_count; ++k)
        plan.effects[k] = {static_cast<Effect>(k), static_cast<Effect>(k) != effect};
    return plan;
}

TEST(PlannedScene, LosesWhatIsOff) {
    const Scene scene = full_scene();
    for (const auto& [effect, kind] : {std::pair{Effect::point_light, Light::Kind::point},
                                       {Effect::spot_light, Light::Kind::spot},
                                       {Effect::directional_light, Light::Kind::directional}}) {
        const Scene left = planned_scene(scene, plan_without(effect));
        ASSERT_EQ(left.lights.size(), 2u);  // and the dark one is gone
        for (const Light& light : left.lights) EXPECT_NE(light.kind, kind);
        EXPECT_TRUE(left.environment);
    }
    EXPECT_FALSE(planned_scene(scene, plan_without(Effect::environment_light)).environment);
    Material left = planned_scene(scene, plan_without(Effect::area_light)).materials[0];
    EXPECT_EQ(left.emission, glm::vec3(0.0f));
    EXPECT_EQ(left.roughness, 0.3f);
    left = planned_scene(scene, plan_without(Effect::gloss)).materials[0];
    EXPECT_EQ(left.metallic + left.specular, 0.0f);
    EXPECT_EQ(left.base_color, scene.materials[0].base_color);
    // Half a metal of alpha 0.16 reflects 94 % of that half.
    Scene metal = scene;
    metal.materials[0].metallic = 0.5f;
    metal.materials[0].roughness = 0.4f;
    metal.materials[0].base_color = {0.8f, 0.6f, 0.4f, 0.5f};
    const glm::vec4 base =
        planned_scene(metal, plan_without(Effect::gloss)).materials[0].base_color;
    const float wanted[] = {0.9696f * 0.8f, 0.9696f * 0.6f, 0.9696f * 0.4f, 0.5f};
    for (int c = 0; c < 4; ++c) EXPECT_NEAR(base[c], wanted[c], 2e-3f) << c;
    EXPECT_EQ(left.base_texture.texture, 0);
    EXPECT_EQ(left.emission, glm::vec3(1.0f, 2.0f, 3.0f));
}

TEST(PlannedScene, LosesDetailWithTexturesAndFinishWithGloss) {
    Scene scene = full_scene();
    scene.textures.push_back(chessboard(3, 250));
    scene.textures.push_back(chessboard(40, 90));
    scene.materials[0].normal_texture.texture = 2;
    scene.materials[0].metallic_roughness_texture.texture = 3;
    Scene left = planned_scene(scene, plan_without(Effect::cutouts));
    ASSERT_EQ(left.textures.size(), 3u);
    const Material& kept = left.materials[0];
    const auto texels = [&](const TextureSlot& slot) {
        return left.textures[static_cast<std::size_t>(slot.texture)].rgba;
    };
    EXPECT_EQ(texels(kept.normal_texture), scene.textures[2].rgba);
    EXPECT_EQ(texels(kept.metallic_roughness_texture), scene.textures[3].rgba);
    left = planned_scene(scene, plan_without(Effect::gloss));
    EXPECT_GE(left.materials[0].normal_texture.texture, 0);
    EXPECT_EQ(left.materials[0].metallic_roughness_texture.texture, -1);
    left = planned_scene(scene, plan_without(Effect::textures));
    EXPECT_EQ(left.materials[0].normal_texture.texture, -1);
    EXPECT_EQ(left.materials[0].metallic_roughness_texture.texture, -1);
    EXPECT_TRUE(left.textures.empty());
}

TEST(PlannedScene, KeepsDarkLightsThatMayChange) {
    Plan plan = plan_without(Effect::point_light);
    plan.request.lights_change = true;
    Scene scene = full_scene();
    EXPECT_EQ(planned_scene(scene, plan).lights.size(), 2u);  // the dark one is a point light
    plan = plan_without(Effect::spot_light);
    plan.request.lights_change = true;
    EXPECT_EQ(planned_scene(scene, plan).lights.size(), 3u);
}

TEST(PlannedScene, HasTexturesThatAreReadAlone) {
    Scene scene = full_scene();
    Plan plan = plan_without(Effect::textures);
    EXPECT_TRUE(planned_scene(scene, plan).textures.empty());
    plan = plan_without(Effect::gloss);
    scene.materials[0].base_texture.texture = 1;  // of one colour
    scene.materials[0].emission_texture.texture = 0;
    Scene left = planned_scene(scene, plan);
    ASSERT_EQ(left.textures.size(), 1u);
    EXPECT_EQ(left.textures[0].rgba, scene.textures[0].rgba);
    EXPECT_EQ(left.materials[0].emission_texture.texture, 0);
    // A slot moves with its texture.
    std::swap(scene.textures[0], scene.textures[1]);
    std::swap(scene.materials[0].base_texture, scene.materials[0].emission_texture);
    scene.materials[0].base_texture.texture = 1;
    scene.materials[0].emission_texture.texture = -1;
    left = planned_scene(scene, plan);
    ASSERT_EQ(left.textures.size(), 1u);
    EXPECT_EQ(left.textures[0].rgba, scene.textures[1].rgba);
    EXPECT_EQ(left.materials[0].base_texture.texture, 0);
    // Nobody has the material.
    scene.materials.push_back(scene.materials[0]);
    for (SceneTriangle& triangle : scene.triangles) triangle.material = 1;
    scene.materials[1].base_texture.texture = 0;
    EXPECT_TRUE(planned_scene(scene, plan).textures.empty());
}

TEST(PlannedScene, HasMeansInPlaceOfTextures) {
    Scene scene = full_scene();
    const Material left = planned_scene(scene, plan_without(Effect::textures)).materials[0];
    EXPECT_EQ(left.base_texture.texture, -1);
    EXPECT_NEAR(left.base_color.r, 0.5 * 0.5, 1e-6);
    EXPECT_NEAR(left.base_color.g, 0.4 * 63.5 / 255.0, 1e-6);
    EXPECT_NEAR(left.base_color.b, 0.3 * 10.0 / 255.0, 1e-6);

    // Not of one of the two triangles of its square.
    Scene halves = scene;
    Texture& texture = halves.textures[0];
    texture.width = 2;
    texture.height = 1;
    texture.rgba = {0, 0, 0, 255, 255, 0, 0, 255};
    EXPECT_NEAR(planned_scene(halves, plan_without(Effect::textures)).materials[0].base_color.r,
                0.25, 1e-6);

    // A texture of one colour is replaced whatever the plan says, one that cuts holes never.
    scene.materials[0].base_texture.texture = 1;
    Material plain = planned_scene(scene, plan_without(Effect::gloss)).materials[0];
    EXPECT_EQ(plain.base_texture.texture, -1);
    EXPECT_NEAR(plain.base_color.r, 0.5 * 128.0 / 255.0, 1e-6);
    for (const AlphaMode mode : {AlphaMode::mask, AlphaMode::blend}) {
        scene.materials[0].alpha_mode = mode;
        plain = planned_scene(scene, plan_without(Effect::gloss)).materials[0];
        EXPECT_EQ(plain.base_texture.texture, 0);  // the only one that is read
        EXPECT_EQ(plain.alpha_mode, mode);
        plain = planned_scene(scene, plan_without(Effect::cutouts)).materials[0];
        EXPECT_EQ(plain.base_texture.texture, -1);
        EXPECT_EQ(plain.alpha_mode, AlphaMode::opaque);
    }
}

TEST(PlannedScene, CarriesOnTheLightsThatStay) {
    Scene scene = full_scene();
    Animation animation;
    animation.nodes.resize(3);
    animation.lights = {{0, 1}, {1, 2}, {2, 0}};
    scene.animation = animation;
    const Scene left = planned_scene(scene, plan_without(Effect::point_light));
    ASSERT_TRUE(left.animation);
    ASSERT_EQ(left.animation->lights.size(), 2u);
    EXPECT_EQ(left.animation->lights[0].index, 0u);
    EXPECT_EQ(left.animation->lights[0].node, 2u);
    EXPECT_EQ(left.animation->lights[1].index, 1u);
    EXPECT_EQ(left.animation->lights[1].node, 0u);

    scene.animation->ranges.resize(1);
    const Scene held = planned_scene(scene, plan_without(Effect::moving_lights));
    ASSERT_TRUE(held.animation);  // geometry moves
    EXPECT_TRUE(held.animation->lights.empty());
    EXPECT_EQ(held.animation->ranges.size(), 1u);
    Plan still = plan_without(Effect::moving_geometry);
    ASSERT_TRUE(planned_scene(scene, still).animation);  // lights move
    EXPECT_TRUE(planned_scene(scene, still).animation->ranges.empty());
    still.effects[static_cast<std::size_t>(Effect::moving_lights)].on = false;
    EXPECT_FALSE(planned_scene(scene, still).animation);
    scene.animation->cameras = {{0, 0}};
    EXPECT_TRUE(planned_scene(scene, still).animation);
}

}  // namespace
}  // namespace clgi
