// What is read from scenes: proofs against geometry that is known, shares and sums against closed
// forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <filesystem>
#include "lab/scenes/interiors.hpp"

#include "convex_scenes.hpp"
#include "lab/scenes/rooms.hpp"
#include "posing.hpp"

namespace clgi {
namespace {

using test::Proven;

// Surfaces are shaded flat, unless told.
void expect_proven(const Scene& scene, const Proven& wanted, const std::string& name,
                   bool flat = true) {
    const OpennessProof proof = scene_analysis(scene).proof;
    EXPECT_EQ(proof.surfaces_open, wanted.surfaces) << name;
    EXPECT_EQ(proof.surfaces_apart, wanted.apart) << name;
    EXPECT_EQ(proof.environment_open, wanted.apart && flat) << name;
    EXPECT_EQ(proof.lights_open, wanted.lights) << name;
}

TEST(OpennessProof, IsWhatIsKnownOfSmallScenes) {
    for (const test::ConvexCase& known : test::convex_cases())
        expect_proven(known.scene, known.proven, known.name);
}

TEST(OpennessProof, DependsOnNeitherPlaceNorSizeNorDirection) {
    for (const test::ConvexCase& known : test::convex_cases()) {
        expect_proven(test::carried_off(known.scene, 1.0, {}), known.proven, known.name);
        expect_proven(test::carried_off(known.scene, 3.0, {1e5, -2e5, 1e5}), known.proven,
                      known.name + ", far away");
        expect_proven(test::carried_off(known.scene, 1e-4, {}), known.proven,
                      known.name + ", small");
        expect_proven(test::carried_off(known.scene, 1e4, {}), known.proven, known.name + ", big");
    }
}

// As a modelling program would store it: no wall of 800 triangles is flat then.
TEST(OpennessProof, HoldsForFineWallsOfRoundedVertices) {
    Scene room = test::plain_scene();
    constexpr int cells = 20;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side)
            for (int i = 0; i < cells; ++i)
                for (int j = 0; j < cells; ++j) {
                    std::array<glm::dvec3, 4> corners;
                    for (int k = 0; k < 4; ++k) {
                        corners[k][axis] = side;
                        corners[k][(axis + 1) % 3] = (i + (k == 1 || k == 2)) / double(cells);
                        corners[k][(axis + 2) % 3] = (j + (k >= 2)) / double(cells);
                    }
                    if (side == 1) std::swap(corners[1], corners[3]);
                    test::add_quad(room, corners);
                }
    room = test::with_light(room, test::point_light({0.5, 0.5, 0.5}));
    room = test::carried_off(room, 3.0, {});
    for (glm::dvec3& p : room.positions) p = glm::dvec3(glm::vec3(p));
    expect_proven(room, {true, false, true}, "room");

    Scene cube = room;
    for (SceneTriangle& triangle : cube.triangles)
        std::swap(triangle.vertex[1], triangle.vertex[2]);
    expect_proven(cube, {true, true, true}, "cube with normals that look into it", false);
    for (glm::vec3& normal : cube.normals) normal = -normal;
    expect_proven(cube, {true, true, true}, "cube");

    // A bump in one wall, and a dent, nine times as deep as what counts as the same place.
    for (const double depth : {9e-6, -9e-6}) {
        Scene dented = room;
        const glm::dvec3 at = dented.positions[4 * 210];
        const glm::dvec3 normal(dented.normals[4 * 210]);
        for (glm::dvec3& p : dented.positions)
            if (p == at) p += depth * normal;
        EXPECT_FALSE(scene_analysis(dented).proof.surfaces_open) << depth;
    }
}

TEST(OpennessProof, HoldsForSpheresWithinItsBounds) {
    FurnaceOptions options;
    expect_proven(furnace(options), {true, false, true}, "spot");
    options.light = LightSource::area;
    Scene sphere = furnace(options);
    expect_proven(sphere, {true, false, true}, "area");
    Scene dented = sphere;
    dented.positions[777] *= 0.99;
    expect_proven(dented, {false, false, false}, "dented");
    for (SceneTriangle& triangle : sphere.triangles)
        std::swap(triangle.vertex[1], triangle.vertex[2]);
    for (glm::vec3& normal : sphere.normals) normal = -normal;
    expect_proven(sphere, {true, true, true}, "from outside", false);

    options.subdivisions = 6;  // 81,920 planes against 40,962 vertices
    const SceneAnalysis bounded = scene_analysis(furnace(options));
    EXPECT_FALSE(bounded.proof.surfaces_open);
    EXPECT_FALSE(bounded.proof.lights_open);
    EXPECT_LT(bounded.milliseconds, 20000.0);
}

// The scene's only part follows a node that a curve drives from (0,0,0).
Scene driven(Scene scene, const std::vector<float>& values) {
    scene.parts = {{"all", 0, static_cast<std::uint32_t>(scene.triangles.size())}};
    Animation& animation = scene.animation.emplace();
    animation.nodes.resize(2);
    animation.nodes[1].parent = 0;
    PosedRange range;
    range.vertex_count = static_cast<std::uint32_t>(scene.positions.size());
    range.node = 1;
    animation.ranges = {range};
    for (const glm::dvec3& p : scene.positions) animation.rest_positions.emplace_back(p);
    animation.rest_normals = scene.normals;
    AnimationClip clip;
    clip.duration = 2.0;
    clip.curves = {{Interpolation::linear, 3, {0.0f, 1.0f, 2.0f}, values}};
    clip.channels = {{ChannelTarget::translation, 0, 0}};
    animation.clips = {clip};
    return scene;
}

TEST(MotionAnalysis, AreWhatClipsMove) {
    const Scene room = test::with_light(test::unit_box(-1), test::point_light({0.5, 0.5, 0.5}));
    const std::vector<float> still(9, 0.0f), there_and_back = {0, 0, 0, 0, 3, 0, 0, 0, 0};
    const SceneAnalysis moved = scene_analysis(driven(room, there_and_back));
    EXPECT_TRUE(moved.motion.geometry);
    EXPECT_EQ(moved.motion.moving_area, 1.0);
    EXPECT_FALSE(moved.lights.moving);
    expect_proven(driven(room, there_and_back), {false, false, false}, "moved");

    const SceneAnalysis stays = scene_analysis(driven(room, still));
    EXPECT_FALSE(stays.motion.geometry);
    EXPECT_EQ(stays.motion.moving_area, 0.0);
    expect_proven(driven(room, still), {true, false, true}, "held where it is");
    Scene held = driven(room, still);
    held.animation->nodes[0].translation.y = 3.0;  // and the curve holds it elsewhere
    EXPECT_TRUE(scene_analysis(held).motion.geometry);

    // A cubic curve has tangents beside its values: both must stay.
    Scene cubic = driven(room, std::vector<float>(27, 0.0f));
    cubic.animation->clips[0].curves[0].interpolation = Interpolation::cubic;
    for (std::size_t key = 0; key < 3; ++key) {
        cubic.animation->nodes[0].translation.z = 2.0;
        cubic.animation->clips[0].curves[0].values[9 * key + 5] = 2.0f;
    }
    EXPECT_FALSE(scene_analysis(cubic).motion.geometry);
    cubic.animation->clips[0].curves[0].values[9 + 6] = 1.0f;
    EXPECT_TRUE(scene_analysis(cubic).motion.geometry);

    Scene announced = room;
    announced.moving_bounds = bounds(room);
    expect_proven(announced, {false, false, false}, "will be moved");

    Scene lamp = driven(room, there_and_back);
    lamp.animation->ranges.clear();
    lamp.animation->lights = {{0, 1}};
    EXPECT_TRUE(scene_analysis(lamp).lights.moving);
    EXPECT_FALSE(scene_analysis(lamp).motion.geometry);
    expect_proven(lamp, {true, false, false}, "moving light");
    lamp.lights[0].intensity = glm::vec3(0.0f);
    EXPECT_FALSE(scene_analysis(lamp).lights.moving);
    expect_proven(lamp, {true, false, true}, "moving light without power");
}

// The second joint, with the last pair alone, turns by a quarter about x = 1.
TEST(MotionAnalysis, OfSkinsAreThoseOfTheirJoints) {
    const std::vector<float> shares = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0,
                                       1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0};
    const Scene strip = test::strip_draft("JOINTS_0", "WEIGHTS_0", shares).load();
    const MotionAnalysis analysis = scene_analysis(strip).motion;
    EXPECT_TRUE(analysis.geometry);
    EXPECT_NEAR(analysis.moving_area, 0.5, 1e-6);  // of two squares
    EXPECT_FALSE(analysis.moving_emission);
}

TEST(SurfaceAnalysis, AreSumsOverTriangles) {
    Scene scene = test::plain_scene({0.2f, 0.4f, 0.8f});
    test::add_tile(scene, 0, 0);
    Material metal;
    metal.base_color = glm::vec4(0.5f, 0.25f, 1.0f, 1.0f);
    metal.metallic = 1.0f;
    metal.roughness = 0.5f;
    metal.specular = 1.0f;
    metal.double_sided = true;
    test::add_quad(scene, {glm::dvec3(0, 1, 0), {3, 1, 0}, {3, 2, 0}, {0, 2, 0}},
                   test::add_material(scene, metal));
    test::add_triangle(scene, {5, 0, 0}, {6, 0, 0}, {7, 0, 0});
    const SurfaceAnalysis analysis = scene_analysis(scene).surfaces;
    EXPECT_EQ(analysis.triangles, 5u);
    EXPECT_EQ(analysis.degenerate, 1u);
    EXPECT_NEAR(analysis.area, 4.0, 1e-12);
    const Reflectance of_metal = reflectance(metal);  // brightest in blue, which is 1
    EXPECT_NEAR(analysis.largest_albedo,
                double{of_metal.diffuse} + double{of_metal.lobe} + double{of_metal.coat}, 1e-6);
    const auto luminance = [](double r, double g, double b) {
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    // Of all that is reflected: the plain tile's, and three times the metal's.
    const auto gloss_of = [&](const Material& material, const glm::dvec3& plain,
                              const glm::dvec3& base) {
        const Reflectance r = reflectance(material);
        const double coat = r.coat;
        const double lobes = luminance(base.r, base.g, base.b) * r.lobe + coat;
        const double all = luminance(base.r, base.g, base.b) * (r.lobe + r.diffuse) + coat;
        return 3.0 * lobes / (luminance(plain.r, plain.g, plain.b) + 3.0 * all);
    };
    EXPECT_NEAR(analysis.gloss, gloss_of(metal, {0.2, 0.4, 0.8}, {0.5, 0.25, 1.0}), 1e-6);
    EXPECT_NEAR(analysis.glossy_area, 0.75, 1e-12);
    EXPECT_NEAR(analysis.double_sided_area, 0.75, 1e-12);
    EXPECT_FALSE(analysis.textures);
    EXPECT_FALSE(analysis.cutouts);

    Material& plastic = scene.materials[1];
    plastic.metallic = 0.0f;
    EXPECT_NEAR(scene_analysis(scene).surfaces.gloss,
                gloss_of(plastic, {0.2, 0.4, 0.8}, {0.5, 0.25, 1.0}), 1e-6);
    scene.colors.assign(scene.positions.size(), glm::vec4(0.5f, 1.0f, 0.25f, 1.0f));
    const SurfaceAnalysis coloured = scene_analysis(scene).surfaces;
    EXPECT_NEAR(coloured.gloss, gloss_of(plastic, {0.1, 0.4, 0.2}, {0.25, 0.25, 0.25}), 1e-6);
    EXPECT_NEAR(coloured.largest_albedo, 0.4, 1e-7);
    scene.colors[0].b = 1.0f;  // of a corner
    EXPECT_NEAR(scene_analysis(scene).surfaces.largest_albedo, 0.8, 1e-7);
}

// A tile with a texture of two texels, left and right.
Scene textured(const std::array<std::uint8_t, 8>& rgba) {
    Scene scene = test::plain_scene(glm::vec3(0.5f));
    test::add_tile(scene, 0, 0);
    Texture texture;
    texture.width = 2;
    texture.height = 1;
    texture.rgba.assign(rgba.begin(), rgba.end());
    texture.nearest = true;
    texture.srgb = false;
    scene.textures = {texture};
    scene.uvs = {{0, 1, 0, 0}, {1, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0, 0}};
    scene.materials[0].base_texture.texture = 0;
    return scene;
}

TEST(SurfaceAnalysis, ReadTextures) {
    Scene scene = textured({255, 0, 51, 255, 255, 255, 51, 255});
    SurfaceAnalysis analysis = scene_analysis(scene).surfaces;
    EXPECT_TRUE(analysis.textures);
    EXPECT_NEAR(analysis.largest_albedo, 0.5, 1e-7) << "of the brightest texel";
    scene.materials.push_back(scene.materials[0]);
    scene.materials[0].base_texture.texture = -1;
    EXPECT_FALSE(scene_analysis(scene).surfaces.textures) << "of a material not in use";
    for (TextureSlot Material::*slot :
         {&Material::normal_texture, &Material::metallic_roughness_texture}) {
        Scene detailed = scene;
        (detailed.materials[0].*slot).texture = 0;
        EXPECT_TRUE(scene_analysis(detailed).surfaces.textures);
    }
    EXPECT_NEAR(
        scene_analysis(textured({0, 0, 0, 255, 255, 255, 255, 255})).surfaces.largest_albedo, 0.5,
        1e-7);
    analysis = scene_analysis(textured({9, 8, 7, 255, 9, 8, 7, 0})).surfaces;
    EXPECT_FALSE(analysis.textures);
    EXPECT_NEAR(analysis.largest_albedo, 0.5 * 9 / 255, 1e-7);

    scene = textured({9, 8, 7, 255, 9, 8, 7, 102});  // alpha 0.4
    EXPECT_FALSE(scene_analysis(scene).surfaces.cutouts);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    EXPECT_TRUE(scene_analysis(scene).surfaces.cutouts);
    scene.materials[0].alpha_cutoff = 0.3f;
    EXPECT_FALSE(scene_analysis(scene).surfaces.cutouts);
    scene.colors.assign(4, glm::vec4(1.0f));
    scene.colors[2].a = 0.5f;
    EXPECT_TRUE(scene_analysis(scene).surfaces.cutouts);
    scene.colors.clear();
    scene.materials[0].base_color.a = 0.5f;
    EXPECT_TRUE(scene_analysis(scene).surfaces.cutouts);
    scene = textured({9, 8, 7, 255, 9, 8, 7, 255});
    scene.materials[0].alpha_mode = AlphaMode::blend;
    EXPECT_FALSE(scene_analysis(scene).surfaces.cutouts);
    scene.materials[0].base_color.a = 0.9f;
    EXPECT_TRUE(scene_analysis(scene).surfaces.cutouts);
}

// Where there are many triangles, each counts with the mean of its texture.
TEST(SurfaceAnalysis, OfManyTrianglesHaveTheMeanOfTheirTextures) {
    Scene scene = textured({255, 0, 51, 255, 255, 255, 51, 255});
    scene.materials[0].roughness = 0.5f;
    scene.materials[0].specular = 1.0f;
    const double gloss = scene_analysis(scene).surfaces.gloss;
    EXPECT_GT(gloss, 0.05);
    while (scene.triangles.size() <= 30000)
        for (const std::size_t t : {0, 1}) scene.triangles.push_back(scene.triangles[t]);
    EXPECT_NEAR(scene_analysis(scene).surfaces.gloss, gloss, 1e-6);
}

TEST(LightAnalysis, AreSumsOverLights) {
    Scene scene = test::tiles({{0, 0}, {2, 0}});
    scene.lights = {test::point_light({0, 1, 0}),
                    test::point_light({0, 1, 0}, 0.0f),
                    test::directional_light({0, -1, 0}),
                    test::directional_light({1, -1, 0}),
                    test::spot_light({0, 1, 0}, {0, -1, 0}, 0.3),
                    test::spot_light({0, 1, 0}, {0, -1, 0}, 0.4),
                    test::spot_light({0, 1, 0}, {0, -1, 0}, 0.5)};
    LightAnalysis analysis = scene_analysis(scene).lights;
    EXPECT_EQ(analysis.points, 1u);
    EXPECT_EQ(analysis.directional, 2u);
    EXPECT_EQ(analysis.spots, 3u);
    EXPECT_EQ(analysis.emissive_triangles, 0u);
    EXPECT_FALSE(analysis.environment);

    scene.materials.push_back(scene.materials[0]);
    scene.materials[1].emission = {1.0f, 2.0f, 3.0f};
    scene.triangles[3].material = 1;
    analysis = scene_analysis(scene).lights;
    EXPECT_EQ(analysis.emissive_triangles, 1u);
    scene.lights.clear();
    EXPECT_TRUE(scene_analysis(scene).lights.any_direct());

    // The upper half of the sphere has (2,4,6), the lower one nothing.
    scene.environment = Environment{1, 2, {glm::vec3(1, 2, 3), glm::vec3(0)}, glm::vec3(2.0f)};
    analysis = scene_analysis(scene).lights;
    EXPECT_TRUE(analysis.environment);
    scene.environment->factor = glm::vec3(0.0f);
    EXPECT_FALSE(scene_analysis(scene).lights.environment);
}

TEST(SceneAnalysis, OfGeneratedScenesAreKnown) {
    CorridorOptions closed;
    closed.door_angle = 0.0f;
    for (const Scene& scene : {cornell(), box(), corridor(closed), maze(), glossy_box()}) {
        const SceneAnalysis analysis = scene_analysis(scene);
        EXPECT_FALSE(analysis.proof.surfaces_open) << scene.name;
        EXPECT_FALSE(analysis.proof.surfaces_apart) << scene.name;
        EXPECT_FALSE(analysis.proof.lights_open) << scene.name;
        EXPECT_GT(analysis.milliseconds, 0.0);
    }
    const SceneAnalysis open = scene_analysis(cornell()), sealed = scene_analysis(box());
    EXPECT_GT(open.openness, 0.05);  // the front is missing
    EXPECT_LT(open.openness, 0.3);
    EXPECT_EQ(sealed.openness, 0.0);
    EXPECT_EQ(open.lights.emissive_triangles, 2u);
    EXPECT_EQ(sealed.lights.spots, 1u);
    EXPECT_GT(scene_analysis(glossy_box()).surfaces.gloss, 0.0);
    const SceneAnalysis walks = scene_analysis(character());
    EXPECT_TRUE(walks.motion.geometry);
    EXPECT_GT(walks.motion.moving_area, 0.0);
    EXPECT_LT(walks.motion.moving_area, 0.1);
}

TEST(SceneAnalysis, OfCollectedFilesAreKnown) {
    const std::filesystem::path folder = CLGI_SCENES_DIR;
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no scenes in " << folder;
    const auto of = [&](const char* file) { return scene_analysis(io::load_gltf(folder / file)); };
    const SceneAnalysis area = of("cornell/cornell-box.gltf"),
                        spot = of("cornell/cornell-box-spot.glb");
    EXPECT_FALSE(area.proof.surfaces_open || area.lights.moving || area.motion.geometry);
    EXPECT_EQ(area.lights.emissive_triangles, 2u);
    EXPECT_TRUE(spot.lights.moving);
    EXPECT_FALSE(spot.motion.geometry);
    const SceneAnalysis man = of("animated/CesiumMan.glb");
    EXPECT_TRUE(man.motion.geometry && man.surfaces.textures && !man.proof.surfaces_open);
    EXPECT_NEAR(man.motion.moving_area, 1.0, 1e-9);
}

TEST(SceneAnalysis, RefuseABrokenScene) {
    Scene scene = test::tiles({{0, 0}});
    scene.positions[1].y = NAN;
    EXPECT_THROW(scene_analysis(scene), InputError);
}

}  // namespace
}  // namespace clgi
