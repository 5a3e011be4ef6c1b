// What stands before tinygltf: files of which it would make something else than they say.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "gltf_draft.hpp"

namespace clgi::test {
namespace {

constexpr std::uint64_t cut_to_zero = std::uint64_t{1} << 32;  // by a cast to 32 bits

TEST(GltfGuard, WholeNumbersMayBeWrittenWithAPoint) {
    GltfDraft draft = triangle_draft();
    draft.document["nodes"][0]["mesh"] = 0.0;
    draft.document["accessors"][0]["count"] = 3.0;
    draft.document["accessors"][0]["bufferView"] = 0.0;
    draft.document["bufferViews"][0]["byteOffset"] = 0.0;
    draft.document["scenes"] = json::array({json{{"nodes", {0.0}}}});
    EXPECT_EQ(draft.load().triangles.size(), 1u);
}

TEST(GltfGuard, NumbersBeyond32BitsAreNotCut) {
    for (const char* path : {"/nodes/0/mesh", "/nodes/0/extensions/KHR_lights_punctual/light",
                             "/meshes/0/primitives/0/mode", "/accessors/0/bufferView"}) {
        GltfDraft draft = triangle_draft();
        draft.document["extensions"]["KHR_lights_punctual"]["lights"] =
            json::array({json{{"type", "point"}}});
        draft.document[json::json_pointer(path)] = cut_to_zero;
        EXPECT_NE(refusal(draft).find("4294967296"), std::string::npos) << path;
    }
    GltfDraft textured = triangle_draft();
    textured.add("textures", json::object());
    json info = {{"index", 0}};
    info["extensions"]["KHR_texture_transform"]["texCoord"] = cut_to_zero;
    textured.add("materials", {{"emissiveTexture", info}});
    EXPECT_NE(refusal(textured).find("texCoord is 4294967296"), std::string::npos);
}

TEST(GltfGuard, EntriesOfTheWrongKindAreNamed) {
    for (const json& wrong : {json(0), json("m"), json::array(), json(nullptr), json(true)}) {
        for (const char* array :
             {"materials", "meshes", "nodes", "accessors", "buffers", "images", "textures",
              "samplers", "skins", "cameras", "animations", "scenes", "bufferViews"}) {
            GltfDraft draft;
            draft.document[array] = json::array({wrong});
            EXPECT_EQ(refusal(draft).find(std::string(array) + "[0] is "),
                      refusal(draft).find(": ") + 2)
                << refusal(draft);
        }
    }
}

TEST(GltfGuard, ExtrasAndForeignExtensionsAreLeftAlone) {
    GltfDraft draft = triangle_draft();
    const json odd = {{"a", {1, nullptr, json::object()}}, {"b", -1e300}};
    for (const char* place : {"/extras", "/nodes/0/extras", "/extensions/VENDOR_x",
                              "/meshes/0/primitives/0/extensions/VENDOR_x"}) {
        draft.document[json::json_pointer(place)] = odd;
    }
    EXPECT_EQ(draft.load().triangles.size(), 1u);
}

TEST(GltfGuard, BuffersOfOneFileMayDifferInLength) {
    const TempFolder folder;
    GltfDraft draft = triangle_draft();
    folder.write("t.bin", std::string(draft.bytes.begin(), draft.bytes.end()) + "more");
    draft.document["buffers"] = json::array(
        {json{{"uri", "t.bin"}, {"byteLength", 4}}, json{{"uri", "./t.bin"}, {"byteLength", 36}}});
    draft.document["bufferViews"][0]["buffer"] = 1;
    EXPECT_EQ(refusal(folder.write("scene.gltf", draft.text())), "");
    draft.document["bufferViews"][0]["buffer"] = 0;  // whose own length still counts
    EXPECT_NE(refusal(folder.write("scene.gltf", draft.text())).find("its buffer has 4"),
              std::string::npos);
    draft.document["buffers"][1]["byteLength"] = 41;
    EXPECT_NE(refusal(folder.write("scene.gltf", draft.text())), "");
}

TEST(GltfGuard, DataUrisAreJudgedByTheirDecodedLength) {
    GltfDraft draft = triangle_draft();
    for (const std::size_t extra : {0, 1, 2, 3}) {
        std::vector<std::uint8_t> bytes = draft.bytes;
        bytes.resize(bytes.size() + extra);
        const std::string uri = "data:anything/else;base64," + base64(bytes);
        const auto with_length = [&](std::size_t length) {
            draft.document["buffers"] = json::array({json{{"uri", uri}, {"byteLength", length}}});
            return refusal(draft);
        };
        EXPECT_EQ(with_length(36), "");
        EXPECT_EQ(with_length(bytes.size()), "");
        EXPECT_NE(with_length(bytes.size() + 1).find("its byteLength is"), std::string::npos);
    }
}

// tinygltf 2.7 forgets the header of the second chunk when it compares lengths.
TEST(GltfGuard, AChunkMayNotEndBeyondTheFile) {
    const GltfDraft draft = triangle_draft();
    json document = draft.document;
    document["buffers"] = json::array({json{{"byteLength", 36}}});
    std::string text = document.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const auto word = [](std::size_t value) {
        const auto bits = static_cast<std::uint32_t>(value);
        return std::string(reinterpret_cast<const char*>(&bits), 4);
    };
    const auto glb = [&](std::size_t chunk, std::size_t there) {
        std::string binary(draft.bytes.begin(), draft.bytes.end());
        binary.resize(there);
        return "glTF" + word(2) + word(12 + 8 + text.size() + 8 + there) + word(text.size()) +
               "JSON" + text + word(chunk) + std::string("BIN\0", 4) + binary;
    };
    const TempFolder folder;
    EXPECT_EQ(refusal(folder.write("scene.glb", glb(36, 36))), "");
    for (const std::size_t missing : {4, 8, 12}) {
        EXPECT_NE(refusal(folder.write("scene.glb", glb(36, 36 - missing))).find("ends inside"),
                  std::string::npos);
    }
}

}  // namespace
}  // namespace clgi::test
