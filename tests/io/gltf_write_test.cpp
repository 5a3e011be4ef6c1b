// save_glb: what was saved loads again, and files are whole or not there.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "gltf_draft.hpp"

namespace clgi::test {
namespace {

// Two triangles far from the origin, of two materials, in two parts, textured and colored.
Scene furnished() {
    Scene scene;
    const glm::dvec3 far(1e6, 2e6, -3e6);
    for (int t = 0; t < 2; ++t) {
        for (const auto& p : one_triangle) {
            scene.positions.push_back(far + glm::dvec3(p[0] / 1024, p[1] / 1024, t));
            scene.normals.emplace_back(0, 0, 1);
            scene.uvs.emplace_back(p[0], p[1], 0.25f, 0.5f);
            scene.colors.emplace_back(0.5f, 0.25f, p[0], 1.0f);
        }
        const auto first = static_cast<std::uint32_t>(3 * t);
        scene.triangles.push_back({{first, first + 1, first + 2}, static_cast<std::uint32_t>(t)});
        scene.parts.push_back({"part " + std::to_string(t), static_cast<std::uint32_t>(t), 1});
    }
    scene.textures.push_back({"picture",
                              1,
                              2,
                              {1, 2, 3, 4, 5, 6, 7, 8},
                              Wrap::clamp_to_edge,
                              Wrap::mirrored_repeat,
                              true,
                              true});
    scene.materials.resize(2);
    scene.materials[0].name = "red";
    scene.materials[0].base_color = {0.75f, 0.1f, 0.2f, 0.5f};
    scene.materials[0].base_texture = {0, 1, glm::mat3(0, -2, 0, 3, 0, 0, 0.5, 0.25, 1)};
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].alpha_cutoff = 0.125f;
    scene.materials[1].double_sided = true;
    scene.materials[1].alpha_mode = AlphaMode::blend;
    scene.materials[1].roughness = 0.3f;
    scene.materials[1].metallic = 0.6f;
    scene.materials[1].specular = 0.75f;
    scene.materials[1].ior = 1.75f;
    scene.materials[1].emission = {17, 12, 4};
    scene.textures.push_back({"normals", 2, 1, {9, 200, 250, 255, 128, 90, 200, 255}});
    scene.textures.back().srgb = false;
    scene.textures.push_back({"finish", 1, 2, {0, 51, 102, 255, 0, 153, 204, 255}});
    scene.textures.back().srgb = false;
    scene.materials[0].normal_texture = {1, 0, glm::mat3(2, 0, 0, 0, 3, 0, 0, 0, 1)};
    scene.materials[0].normal_scale = -0.75f;
    scene.materials[0].metallic_roughness_texture = {2, 1};
    scene.materials[0].metallic_roughness_factor = {0.5f, 0.25f};
    scene.materials[0].metallic = 0.5f * 0.6f;
    scene.materials[0].roughness = 0.25f * 0.4f;

    Light spot;
    spot.name = "lamp";
    spot.kind = Light::Kind::spot;
    spot.position = far;
    spot.direction = glm::normalize(glm::vec3(0.1f, -1.0f, 0.2f));
    spot.intensity = {3, 2, 1};
    spot.range = 9;
    spot.inner_angle = 0.25f;
    spot.outer_angle = 0.5f;
    scene.lights.push_back(spot);
    Camera camera;
    camera.name = "eye";
    camera.position = far + glm::dvec3(0, 0, 5);
    camera.near = 0.5f;
    scene.cameras.push_back(camera);
    camera.kind = Camera::Kind::orthographic;
    camera.half_height = 2.5f;
    camera.forward = {1, 0, 0};
    camera.right = {0, 0, 1};
    scene.cameras.push_back(camera);
    return scene;
}

TEST(SaveGlb, KeepsGeometryFarFromTheOrigin) {
    const Scene before = furnished();
    const Scene after = reload(before);
    ASSERT_EQ(after.triangles.size(), before.triangles.size());
    for (std::size_t t = 0; t < 2; ++t) {
        EXPECT_EQ(after.triangles[t].material, before.triangles[t].material);
        for (int i = 0; i < 3; ++i) {
            // Float relative to the centre: 2^-25 of half a metre. About 1e6 it would be 0.06 m.
            EXPECT_VEC_NEAR(corner(after, t, i), corner(before, t, i), 3e-8);
        }
    }
    EXPECT_EQ(after.uvs, before.uvs);
    EXPECT_EQ(after.colors, before.colors);
    EXPECT_EQ(after.normals, before.normals);
    ASSERT_EQ(after.parts.size(), 2u);
    EXPECT_EQ(after.parts[1].name, "part 1");
}

TEST(SaveGlb, KeepsMaterialsAndTextures) {
    const Scene before = furnished();
    const Scene after = reload(before);
    ASSERT_EQ(after.materials.size(), 2u);
    const Material& red = after.materials[0];
    EXPECT_EQ(red.name, "red");
    EXPECT_EQ(red.base_color, before.materials[0].base_color);
    EXPECT_EQ(red.alpha_mode, AlphaMode::mask);
    EXPECT_EQ(red.alpha_cutoff, 0.125f);
    EXPECT_EQ(after.materials[1].alpha_mode, AlphaMode::blend);
    EXPECT_EQ(red.base_texture.uv_set, 1);
    for (int column = 0; column < 3; ++column) {
        // Through an angle and back: a few units in the last place of 3.
        EXPECT_VEC_NEAR(red.base_texture.transform[column],
                        before.materials[0].base_texture.transform[column], 1e-6);
    }
    EXPECT_TRUE(after.materials[1].double_sided);
    EXPECT_EQ(after.materials[1].roughness, 0.3f);
    EXPECT_EQ(after.materials[1].metallic, 0.6f);
    EXPECT_EQ(after.materials[1].specular, 0.75f);
    EXPECT_EQ(after.materials[1].ior, 1.75f);
    EXPECT_EQ(red.specular, 0.0f);
    EXPECT_EQ(red.ior, 1.5f);
    EXPECT_VEC_NEAR(after.materials[1].emission, before.materials[1].emission, 2e-6);

    EXPECT_EQ(red.normal_scale, -0.75f);
    EXPECT_EQ(red.normal_texture.transform[1], glm::vec3(0.0f, 3.0f, 0.0f));
    EXPECT_EQ(red.metallic_roughness_texture.uv_set, 1);
    EXPECT_EQ(red.metallic_roughness_factor, before.materials[0].metallic_roughness_factor);
    EXPECT_FLOAT_EQ(red.metallic, before.materials[0].metallic);
    EXPECT_FLOAT_EQ(red.roughness, before.materials[0].roughness);

    ASSERT_EQ(after.textures.size(), 3u);
    const Texture& normals = after.textures[static_cast<std::size_t>(red.normal_texture.texture)];
    const Texture& finish =
        after.textures[static_cast<std::size_t>(red.metallic_roughness_texture.texture)];
    EXPECT_EQ(normals.rgba, before.textures[1].rgba);
    EXPECT_EQ(finish.rgba, before.textures[2].rgba);
    EXPECT_FALSE(normals.srgb || finish.srgb);
    EXPECT_EQ(after.textures[0].rgba, before.textures[0].rgba);
    EXPECT_EQ(after.textures[0].name, "picture");
    EXPECT_EQ(after.textures[0].wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(after.textures[0].wrap_t, Wrap::mirrored_repeat);
    EXPECT_TRUE(after.textures[0].nearest);
    EXPECT_TRUE(after.warnings.empty());
}

TEST(SaveGlb, KeepsEmissionOfAnyBrightness) {
    for (const float brightness : {1e-30f, 1e-13f, 1e-7f, 0.5f, 1.0f, 1e9f}) {
        Scene scene = furnished();
        scene.materials[0].emission = glm::vec3(1.0f, 0.5f, 0.0f) * brightness;
        // A quotient and a product of doubles: exact once rounded to float, or one unit beside it.
        EXPECT_VEC_NEAR(reload(scene).materials[0].emission, scene.materials[0].emission,
                        brightness * 1.2e-7);
    }
}

TEST(SaveGlb, KeepsLightsAndCameras) {
    const Scene before = furnished();
    const Scene after = reload(before);
    ASSERT_EQ(after.lights.size(), 1u);
    EXPECT_EQ(after.lights[0].name, "lamp");
    EXPECT_EQ(after.lights[0].position, before.lights[0].position);
    EXPECT_VEC_NEAR(after.lights[0].direction, before.lights[0].direction, 1e-6);
    EXPECT_VEC_NEAR(after.lights[0].intensity, before.lights[0].intensity, 1e-6);
    EXPECT_EQ(after.lights[0].range, 9.0f);
    EXPECT_EQ(after.lights[0].inner_angle, 0.25f);
    EXPECT_EQ(after.lights[0].outer_angle, 0.5f);
    ASSERT_EQ(after.cameras.size(), 2u);
    EXPECT_EQ(after.cameras[0].near, 0.5f);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(after.cameras[i].kind, before.cameras[i].kind);
        EXPECT_EQ(after.cameras[i].position, before.cameras[i].position);
        EXPECT_VEC_NEAR(after.cameras[i].forward, before.cameras[i].forward, 1e-6);
        EXPECT_VEC_NEAR(after.cameras[i].up, before.cameras[i].up, 1e-6);
    }
    EXPECT_EQ(after.cameras[1].half_height, 2.5f);
}

TEST(SaveGlb, EveryKindOfLightPointsWhereItDid) {
    Scene scene;
    for (const glm::vec3 direction : {glm::vec3(0, -1, 0), glm::vec3(0, 1, 0), glm::vec3(0, 0, -1),
                                      glm::vec3(0, 0, 1), glm::vec3(0.6f, 0, -0.8f)}) {
        Light light;
        light.kind = Light::Kind::directional;
        light.direction = direction;
        scene.lights.push_back(light);
    }
    scene.lights.emplace_back();  // a point light
    const Scene after = reload(scene);
    ASSERT_EQ(after.lights.size(), 6u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_VEC_NEAR(after.lights[i].direction, scene.lights[i].direction, 1e-6);
    }
    EXPECT_EQ(after.lights[5].kind, Light::Kind::point);
}

TEST(SaveGlb, AnEmptySceneLoadsAgain) {
    const Scene after = reload(Scene());
    EXPECT_TRUE(after.triangles.empty());
    EXPECT_TRUE(after.lights.empty());
}

TEST(SaveGlb, TrianglesOutsideAnyPartAreKept) {
    Scene scene = furnished();
    scene.parts.erase(scene.parts.begin());
    EXPECT_EQ(reload(scene).triangles.size(), 2u);
    scene.parts.clear();
    EXPECT_EQ(reload(scene).triangles.size(), 2u);
    scene.parts = {{"all", 0, 2}, {"again", 1, 1}};
    EXPECT_EQ(reload(scene).triangles.size(), 2u);
}

TEST(SaveGlb, NamesThatAreNotUtf8DoNotHinderIt) {
    Scene scene = furnished();
    scene.materials[0].name = "\xff\xfe";
    EXPECT_NO_THROW(reload(scene));
}

TEST(SaveGlb, AFailureLeavesTheOldFileAndNothingElse) {
    const TempFolder folder;
    const auto file = folder.write("saved.glb", "old");
    Scene broken = furnished();
    broken.triangles[0].vertex[0] = 99;
    EXPECT_THROW(io::save_glb(broken, file), InputError);
    EXPECT_EQ(std::filesystem::file_size(file), 3u);

    std::filesystem::create_directories(folder.path() / "taken.glb/inner");
    EXPECT_THROW(io::save_glb(furnished(), folder.path() / "taken.glb"), InputError);
    EXPECT_THROW(io::save_glb(furnished(), folder.path() / "missing/saved.glb"), InputError);
    std::size_t entries = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
        (void)entry;
        ++entries;
    }
    EXPECT_EQ(entries, 2u);  // the old file and the folder in the way
}

TEST(SaveGlb, CollectedScenesSurviveIt) {
    const std::filesystem::path scenes = CLGI_SCENES_DIR;
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no scenes at " << scenes;
    for (const char* name : {"cornell/cornell-box.gltf", "lightmap-uv/bevy-CornellBox.glb",
                             "animated/CesiumMan.glb", "house/small-house.glb"}) {
        SCOPED_TRACE(name);
        const Scene before = io::load_gltf(scenes / name);
        const Scene after = reload(before);
        ASSERT_EQ(after.triangles.size(), before.triangles.size());
        EXPECT_EQ(after.materials.size(), before.materials.size());
        EXPECT_EQ(after.textures.size(), before.textures.size());
        EXPECT_EQ(after.lights.size(), before.lights.size());
        EXPECT_EQ(after.cameras.size(), before.cameras.size());
        const double size = glm::length(bounds(before).high - bounds(before).low);
        double worst = 0.0;
        for (std::size_t t = 0; t < before.triangles.size(); ++t) {
            for (int i = 0; i < 3; ++i) {
                worst = std::max(worst, glm::length(corner(after, t, i) - corner(before, t, i)));
            }
        }
        EXPECT_LE(worst, size * 1e-7);  // float, relative to the centre: half a unit of 2^-24
    }
}

}  // namespace
}  // namespace clgi::test
