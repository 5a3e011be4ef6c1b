// EXT_texture_webp: the WebP goes before the other source, pixels are those that were packed.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#if CLGI_HAS_WEBP

#include <webp/encode.h>

#include "io/png_encode.hpp"
#include "packed_scenes.hpp"
#include "time_limit.hpp"

namespace clgi::test {
namespace {

using GltfWebp = TimeLimit<20>;

Bytes lossless(int w, int h, const Bytes& rgba) {
    std::uint8_t* out = nullptr;
    const std::size_t size = WebPEncodeLosslessRGBA(rgba.data(), w, h, w * 4, &out);
    const Bytes bytes(out, out + size);
    WebPFree(out);
    return bytes;
}

// Without pixels of alpha 0, whose colours encoders change.
Bytes pattern(int w, int h) {
    Bytes rgba;
    for (int i = 0; i < w * h; ++i) {
        for (const int value : {7 * i, 255 - i, i * i, 1 + i % 255})
            rgba.push_back(static_cast<std::uint8_t>(value));
    }
    return rgba;
}

GltfDraft webp_draft(const Bytes& image, const Bytes& other = {}) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    const std::vector<std::array<float, 2>> uvs = {{0, 0}, {1, 0}, {0, 1}};
    const int uv = draft.accessor(draft.view(uvs), 3, "VEC2", float_type);
    json texture;
    texture["extensions"]["EXT_texture_webp"]["source"] =
        draft.add("images", {{"bufferView", draft.view(image)}, {"mimeType", "image/webp"}});
    if (!other.empty()) {
        texture["source"] =
            draft.add("images", {{"bufferView", draft.view(other)}, {"mimeType", "image/png"}});
    }
    draft.add("textures", texture);
    json material;
    material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
    draft.add("materials", material);
    draft.show({{"attributes", {{"POSITION", positions}, {"TEXCOORD_0", uv}}}, {"material", 0}});
    draft.add("scenes", {{"nodes", {0}}});
    draft.document["extensionsUsed"] = {"EXT_texture_webp"};
    return draft;
}

TEST_F(GltfWebp, PixelsArriveAsTheyWere) {
    const Bytes rgba = pattern(13, 5);
    GltfDraft draft = webp_draft(lossless(13, 5, rgba));
    draft.document["extensionsRequired"] = {"EXT_texture_webp"};
    const Scene scene = draft.load();
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].width, 13);
    EXPECT_EQ(scene.textures[0].height, 5);
    EXPECT_EQ(scene.textures[0].rgba, rgba);
    EXPECT_EQ(scene.materials[0].base_texture.texture, 0);
    EXPECT_TRUE(scene.warnings.empty());
}

TEST_F(GltfWebp, TheWebpGoesBeforeTheOtherSource) {
    const Bytes rgba = pattern(4, 4);
    const Bytes black = io::encode_png(1, 1, Bytes{0, 0, 0, 255}.data());
    const Scene scene = webp_draft(lossless(4, 4, rgba), black).load();
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[0].rgba, rgba);
}

TEST_F(GltfWebp, MetalAndRoughnessEnterByTheirMean) {
    // Green (roughness) averages 51, blue (metal) 102 of 255.
    GltfDraft draft = webp_draft(lossless(2, 1, {9, 0, 204, 255, 9, 102, 0, 255}));
    json& material = draft.document["materials"][0]["pbrMetallicRoughness"];
    material = {{"metallicRoughnessTexture", {{"index", 0}}}};
    const Scene scene = draft.load();
    EXPECT_FLOAT_EQ(scene.materials[0].roughness, 0.2f);
    EXPECT_FLOAT_EQ(scene.materials[0].metallic, 0.4f);
}

TEST_F(GltfWebp, SourcesThatAreNotThereAreRefused) {
    GltfDraft draft = webp_draft(lossless(1, 1, pattern(1, 1)));
    draft.document["textures"][0]["extensions"]["EXT_texture_webp"]["source"] = 1;
    EXPECT_NE(refusal(draft).find("source is 1, there are 1 images"), std::string::npos);
}

TEST_F(GltfWebp, DataUrisMustSayWhatTheyAre) {
    GltfDraft draft = webp_draft(lossless(1, 1, pattern(1, 1)));
    const std::string text = base64(lossless(1, 1, pattern(1, 1)));
    draft.document["images"][0] = {{"uri", "data:image/webp;base64," + text}};
    EXPECT_EQ(refusal(draft), "");
    draft.document["images"][0] = {{"uri", "data:image/png;base64," + text}};
    EXPECT_NE(refusal(draft).find("but they are a WebP"), std::string::npos);
}

TEST_F(GltfWebp, SizesAreJudgedBeforeDecoding) {
    // One colour: a few bytes for 16 million pixels.
    const Bytes large = lossless(4096, 4096, Bytes(std::size_t{4} << 24, 200));
    EXPECT_LT(large.size(), 8192u);
    EXPECT_NE(refusal(webp_draft(large), {.max_texels = (1 << 24) - 1}).find("4096x4096 pixels"),
              std::string::npos);
    EXPECT_EQ(refusal(webp_draft(large), {.max_texels = 1 << 24}), "");
}

TEST_F(GltfWebp, DamagedImagesAreRefusedInOneLineOrLoad) {
    const auto draft_of = [](const Bytes& bytes) { return webp_draft(bytes); };
    const Bytes exact = lossless(24, 16, pattern(24, 16));
    EXPECT_GE(expect_damage_is_survived(exact, draft_of), int(exact.size()) * 9 / 10);
    std::uint8_t* out = nullptr;
    const Bytes rgba = pattern(24, 16);
    const std::size_t size = WebPEncodeRGBA(rgba.data(), 24, 16, 96, 60.0f, &out);
    const Bytes lossy(out, out + size);
    WebPFree(out);
    EXPECT_GE(expect_damage_is_survived(lossy, draft_of), int(lossy.size()) * 9 / 10);
}

}  // namespace
}  // namespace clgi::test

#endif
