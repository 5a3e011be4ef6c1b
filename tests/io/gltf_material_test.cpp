// Materials, textures and the extensions around them.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "gltf_draft.hpp"
#include "io/png_encode.hpp"

namespace clgi::test {
namespace {

std::vector<std::uint8_t> png(int w, int h, const std::vector<std::uint8_t>& rgba) {
    return io::encode_png(w, h, rgba.data());
}

// A textured triangle with the image in a buffer view.
GltfDraft textured(const std::vector<std::uint8_t>& image, const char* slot = "baseColorTexture") {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    const std::vector<std::array<float, 2>> uvs = {{0, 0}, {1, 0}, {0, 1}};
    const int uv = draft.accessor(draft.view(uvs), 3, "VEC2", float_type);
    draft.add("images", {{"bufferView", draft.view(image)}, {"mimeType", "image/png"}});
    draft.add("textures", {{"source", 0}});
    json material;
    material["pbrMetallicRoughness"][slot] = {{"index", 0}};
    draft.add("materials", material);
    draft.show({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"material", 0}});
    draft.add("scenes", {{"nodes", {0}}});
    return draft;
}

TEST(GltfMaterials, DefaultsAreThoseOfGltf) {
    const Scene scene = triangle_draft().load();
    ASSERT_EQ(scene.materials.size(), 1u);
    EXPECT_EQ(scene.materials[0].base_color, glm::vec4(1.0f));
    EXPECT_EQ(scene.materials[0].metallic, 1.0f);
    EXPECT_EQ(scene.materials[0].roughness, 1.0f);
    EXPECT_EQ(scene.materials[0].specular, 1.0f);
    EXPECT_EQ(scene.materials[0].ior, 1.5f);
}

TEST(GltfMaterials, HaveAnIndexOfRefractionAndAStrengthOfGloss) {
    GltfDraft draft = triangle_draft();
    const auto add = [&](const char* extension, const char* name, double value) {
        json material;
        material["extensions"][extension] = {{name, value}};
        draft.add("materials", material);
    };
    add("KHR_materials_ior", "ior", 2.25);
    add("KHR_materials_specular", "specularFactor", 0.25);
    add("KHR_materials_ior", "ior", 0.0);
    add("KHR_materials_ior", "ior", 0.5);
    draft.add("materials", json::object());
    const Scene scene = draft.load();
    const float iors[] = {2.25f, 1.5f, 0.0f, 1.5f, 1.5f}, speculars[] = {1, 0.25f, 1, 1, 1};
    for (std::size_t m = 0; m < 5; ++m) {
        EXPECT_EQ(scene.materials[m].ior, iors[m]) << m;
        EXPECT_EQ(scene.materials[m].specular, speculars[m]) << m;
    }
    EXPECT_EQ(std::count_if(scene.warnings.begin(), scene.warnings.end(),
                            [](const std::string& warning) {
                                return warning.find("index of refraction") != std::string::npos;
                            }),
              1);
    json coloured;
    coloured["extensions"]["KHR_materials_specular"] = {{"specularColorFactor", {1, 0.5, 0.25}}};
    GltfDraft other = triangle_draft();
    other.add("materials", coloured);
    const std::vector<std::string> said = other.load().warnings;
    EXPECT_TRUE(std::any_of(said.begin(), said.end(), [](const std::string& warning) {
        return warning.find("only the factor is read") != std::string::npos;
    }));
    // F at normal incidence: ((n - 1) / (n + 1))^2; all of it where the index is 0.
    EXPECT_NEAR(surface_of(scene.materials[0]).z, 1.25 * 1.25 / (3.25 * 3.25), 1e-7);
    EXPECT_NEAR(surface_of(scene.materials[1]).z, 0.01, 1e-8);
    EXPECT_EQ(surface_of(scene.materials[1]).w, 0.25f);
    EXPECT_EQ(surface_of(scene.materials[2]).z, 1.0f);
    EXPECT_NEAR(surface_of(scene.materials[4]).z, 0.04, 1e-8);
}

TEST(GltfMaterials, HaveTheAlphaModeOfTheFile) {
    GltfDraft draft = triangle_draft();
    draft.add("materials", {{"alphaMode", "BLEND"}});
    draft.add("materials", {{"alphaMode", "MASK"}, {"alphaCutoff", 0.25}});
    draft.add("materials", json::object());
    const Scene scene = draft.load();
    EXPECT_EQ(scene.materials[0].alpha_mode, AlphaMode::blend);
    EXPECT_EQ(scene.materials[1].alpha_mode, AlphaMode::mask);
    EXPECT_EQ(scene.materials[1].alpha_cutoff, 0.25f);
    EXPECT_EQ(scene.materials[2].alpha_mode, AlphaMode::opaque);
    for (const std::string& warning : scene.warnings)
        EXPECT_EQ(warning.find("blend"), std::string::npos) << warning;
}

TEST(GltfMaterials, StrengthMultipliesEmission) {
    GltfDraft draft = triangle_draft();
    json material = {{"emissiveFactor", {1, 0.5, 0}}};
    material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"] = 20;
    draft.add("materials", material);
    draft.document["meshes"][0]["primitives"][0]["material"] = 0;
    const Scene scene = draft.load();
    EXPECT_EQ(scene.materials[0].emission, glm::vec3(20, 10, 0));
    EXPECT_TRUE(has_emission(scene));
}

TEST(GltfTextures, PixelsArriveAsTheyWere) {
    const std::vector<std::uint8_t> rgba = {1, 2, 3, 4, 50, 60, 70, 80};
    const Scene scene = textured(png(2, 1, rgba)).load();
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].width, 2);
    EXPECT_EQ(scene.textures[0].rgba, rgba);
    EXPECT_EQ(scene.materials[0].base_texture.texture, 0);
    EXPECT_EQ(scene.uvs.size(), 3u);
}

TEST(GltfTextures, MetalAndRoughnessHaveTheirMeanAndTheirTexture) {
    // Green (roughness) averages 51, blue (metal) 102 of 255.
    GltfDraft draft =
        textured(png(2, 1, {9, 0, 204, 255, 9, 102, 0, 255}), "metallicRoughnessTexture");
    json& factors = draft.document["materials"][0]["pbrMetallicRoughness"];
    factors["roughnessFactor"] = 0.5;
    factors["metallicFactor"] = 0.25;
    // A second material reads the same texels.
    draft.document["materials"].push_back(draft.document["materials"][0]);
    const Scene scene = draft.load();
    for (const Material& material : scene.materials) {
        EXPECT_FLOAT_EQ(material.roughness, 0.1f);
        EXPECT_FLOAT_EQ(material.metallic, 0.1f);
        EXPECT_EQ(material.metallic_roughness_factor, glm::vec2(0.25f, 0.5f));
        EXPECT_EQ(material.metallic_roughness_texture.texture, 0);
    }
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_FALSE(scene.textures[0].srgb);
    EXPECT_EQ(scene.uvs.size(), 3u);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(GltfTextures, AFinishOfOneValueNeedsNoTexture) {
    // Red says nothing.
    const Scene scene =
        textured(png(2, 1, {9, 51, 102, 255, 7, 51, 102, 255}), "metallicRoughnessTexture").load();
    EXPECT_FLOAT_EQ(scene.materials[0].roughness, 0.2f);
    EXPECT_FLOAT_EQ(scene.materials[0].metallic, 0.4f);
    EXPECT_EQ(scene.materials[0].metallic_roughness_texture.texture, -1);
    EXPECT_TRUE(scene.textures.empty());
}

TEST(GltfTextures, NormalsAreLinearAndKeepTheirScale) {
    GltfDraft draft = textured(png(1, 1, {10, 200, 220, 255}));
    json& material = draft.document["materials"][0];
    material["normalTexture"] = {{"index", 0}, {"scale", -0.5}, {"texCoord", 1}};
    material["normalTexture"]["extensions"]["KHR_texture_transform"]["scale"] = {2, 3};
    const Scene scene = draft.load();
    // The same image, once as a colour and once as numbers.
    ASSERT_EQ(scene.textures.size(), 2u);
    EXPECT_TRUE(scene.textures[0].srgb);
    EXPECT_FALSE(scene.textures[1].srgb);
    const Material& read = scene.materials[0];
    EXPECT_EQ(read.normal_texture.texture, 1);
    EXPECT_EQ(read.normal_texture.uv_set, 1);
    EXPECT_EQ(read.normal_scale, -0.5f);
    EXPECT_EQ(read.normal_texture.transform[1][1], 3.0f);
}

TEST(GltfTextures, TheTransformScalesThenTurnsThenShifts) {
    GltfDraft draft = textured(png(1, 1, {0, 0, 0, 255}));
    json& info = draft.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    info["extensions"]["KHR_texture_transform"] = {
        {"offset", {0.5, 0.25}}, {"rotation", 1.5707963267948966}, {"scale", {2, 3}}};
    const glm::mat3 m = draft.load().materials[0].base_texture.transform;
    // A quarter turn counter-clockwise with v down takes u to -v and v to u. 1e-6: float cosine.
    EXPECT_VEC_NEAR(m * glm::vec3(1, 0, 1), glm::dvec3(0.5, -1.75, 1), 1e-6);
    EXPECT_VEC_NEAR(m * glm::vec3(0, 1, 1), glm::dvec3(3.5, 0.25, 1), 1e-6);
}

TEST(GltfTextures, SamplersAreKept) {
    GltfDraft draft = textured(png(1, 1, {0, 0, 0, 255}));
    draft.add("samplers", {{"wrapS", 33071}, {"wrapT", 33648}, {"magFilter", 9728}});
    draft.document["textures"][0]["sampler"] = 0;
    const Scene scene = draft.load();
    EXPECT_EQ(scene.textures[0].wrap_s, Wrap::clamp_to_edge);
    EXPECT_EQ(scene.textures[0].wrap_t, Wrap::mirrored_repeat);
    EXPECT_TRUE(scene.textures[0].nearest);
}

TEST(GltfTextures, AFormatThatIsNotReadIsWhiteWithAWarning) {
    const std::string gif("GIF89a\1\0\1\0", 10);
    const Scene scene = textured({gif.begin(), gif.end()}).load();
    EXPECT_EQ(scene.materials[0].base_texture.texture, -1);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("white"), std::string::npos);
}

TEST(GltfTextures, TruncatedImagesAreRefused) {
    std::vector<std::uint8_t> image = png(16, 16, std::vector<std::uint8_t>(1024, 77));
    for (const std::size_t length : {std::size_t{12}, std::size_t{40}, image.size() - 20}) {
        const GltfDraft draft =
            textured({image.begin(), image.begin() + static_cast<long>(length)});
        EXPECT_NE(refusal(draft).find("images[0]"), std::string::npos) << length;
    }
}

TEST(GltfTextures, SizesAreJudgedBeforeDecoding) {
    std::vector<std::uint8_t> image = png(1, 1, {0, 0, 0, 255});
    image[16] = 0x40;  // the width becomes 2^30
    EXPECT_NE(refusal(textured(image)).find("1073741825x1"), std::string::npos);

    const std::vector<std::uint8_t> large = png(100, 100, std::vector<std::uint8_t>(40000));
    EXPECT_NE(refusal(textured(large), {.max_texels = 9999}).find("allowed"), std::string::npos);
    EXPECT_EQ(refusal(textured(large), {.max_texels = 10000}), "");
}

TEST(GltfTextures, ManyTexturesOfOneImageShareTheBudget) {
    GltfDraft draft = textured(png(10, 10, std::vector<std::uint8_t>(400)));
    draft.add("samplers", {{"wrapS", 33071}});
    draft.add("textures", {{"source", 0}, {"sampler", 0}});
    json second;
    second["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 1}};
    draft.add("materials", second);
    EXPECT_EQ(draft.load({.max_texels = 200}).textures.size(), 2u);
    EXPECT_NE(refusal(draft, {.max_texels = 199}), "");
}

TEST(GltfExtensions, ARequiredOneThatIsNotReadIsNamed) {
    GltfDraft draft = triangle_draft();
    draft.document["extensionsRequired"] = {"KHR_texture_basisu"};
    EXPECT_NE(
        refusal(draft).find("requires the extension KHR_texture_basisu, which clgi does not read"),
        std::string::npos);
}

TEST(GltfExtensions, CodecsOfTheBuildAreReadAndTheOthersNamed) {
    const std::tuple<const char*, const char*, bool> codecs[] = {
        {"EXT_meshopt_compression", "CLGI_MESHOPT", CLGI_HAS_MESHOPT},
        {"KHR_draco_mesh_compression", "CLGI_DRACO", CLGI_HAS_DRACO},
        {"EXT_texture_webp", "CLGI_WEBP", CLGI_HAS_WEBP}};
    for (const auto& [name, option, built] : codecs) {
        GltfDraft draft = triangle_draft();
        draft.add("scenes", {{"nodes", {0}}});
        draft.document["extensionsUsed"] = {name};
        EXPECT_TRUE(draft.load().warnings.empty()) << name;
        draft.document["extensionsRequired"] = {name};
        const std::string line = "requires the extension " + std::string(name) +
                                 ", which this build of clgi does not read: " + option + " is OFF";
        const std::string message = refusal(draft);
        EXPECT_EQ(message.find(line) != std::string::npos, !built) << message;
        EXPECT_EQ(message.empty(), built) << message;
    }
}

TEST(GltfExtensions, ABufferThatIsOnlyAFallbackHasNoData) {
    GltfDraft draft = triangle_draft();
    json buffer = {{"byteLength", draft.bytes.size()}};
    buffer["extensions"]["EXT_meshopt_compression"]["fallback"] = true;
    draft.document["buffers"] = json::array({buffer});
    const char* because = CLGI_HAS_MESHOPT ? "only a fallback buffer has" : "CLGI_MESHOPT is OFF";
    EXPECT_NE(refusal(draft).find(because), std::string::npos) << refusal(draft);
}

TEST(GltfWarnings, EqualLinesAreCounted) {
    GltfDraft draft = triangle_draft();
    json unlit;
    unlit["extensions"]["KHR_materials_unlit"] = json::object();
    for (int i = 0; i < 3; ++i) draft.add("materials", unlit);
    const Scene scene = draft.load();
    EXPECT_NE(scene.warnings.at(0).find("(3 times)"), std::string::npos);
}

TEST(PngEncode, RefusesEmptyPictures) {
    EXPECT_THROW(io::encode_png(0, 4, nullptr), Error);
    EXPECT_THROW(io::encode_png(4, -1, nullptr), Error);
}

}  // namespace
}  // namespace clgi::test
