// Files made to break a reader: each must be refused in one line, quickly, in bounded memory.
// SPDX-License-Identifier: MIT
#include <limits>

#include "gltf_draft.hpp"
#include "time_limit.hpp"

namespace clgi::test {
namespace {

using GltfHostile = TimeLimit<10>;
using GltfUri = GltfHostile;

void expect_refused(const GltfDraft& draft, const std::string& because,
                    const io::GltfOptions& options = {}) {
    const std::string message = refusal(draft, options);
    EXPECT_NE(message.find(because), std::string::npos) << "it said: " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
}

constexpr std::uint64_t huge = std::numeric_limits<std::uint64_t>::max();

TEST_F(GltfHostile, NumbersThatOverflowAreRefused) {
    const std::pair<const char*, std::uint64_t> cases[] = {
        {"count", 0},         {"count", 4},         {"count", std::uint64_t{1} << 62},
        {"count", huge},      {"byteOffset", 1},    {"byteOffset", huge - 7},
        {"byteOffset", huge}, {"bufferView", huge}, {"componentType", huge}};
    for (const auto& [key, value] : cases) {
        GltfDraft draft = triangle_draft();
        draft.document["accessors"][0][key] = value;
        expect_refused(draft, "accessors[0]");
    }
    for (const char* key : {"byteOffset", "byteLength"}) {
        for (const std::uint64_t value : {std::uint64_t{37}, huge - 7, huge}) {
            GltfDraft draft = triangle_draft();
            draft.document["bufferViews"][0][key] = value;
            expect_refused(draft, "bufferViews[0]");
        }
    }
}

TEST_F(GltfHostile, ZerosWithoutDataAreBounded) {
    GltfDraft draft = triangle_draft();
    draft.document["accessors"][0].erase("bufferView");
    draft.document["accessors"][0]["count"] = std::uint64_t{1} << 40;
    expect_refused(draft, "no data");
}

TEST_F(GltfHostile, NegativeAndFractionalIndicesAreRefused) {
    for (const json& index : {json(-1), json(0.5), json("0"), json(1e300), json(nullptr)}) {
        GltfDraft draft = triangle_draft();
        draft.document["nodes"][0]["mesh"] = index;
        expect_refused(draft, "nodes[0].mesh");
    }
}

TEST_F(GltfHostile, IndicesPastTheLastVertexAreRefused) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    draft.show({{"attributes", {{"POSITION", positions}}}, {"indices", draft.indices({0, 1, 3})}});
    expect_refused(draft, "names vertex 3, there are 3");
}

TEST_F(GltfHostile, StridesBelowTheElementAreRefused) {
    for (const int stride : {0, 4, 5, 8, 256}) {
        GltfDraft draft = triangle_draft();
        draft.document["bufferViews"][0]["byteStride"] = stride;
        EXPECT_NE(refusal(draft), "") << stride;
    }
}

TEST_F(GltfHostile, SparseIndicesMustIncreaseWithinTheCount) {
    for (const std::vector<std::uint8_t>& indices :
         {std::vector<std::uint8_t>{1, 3}, {2, 1}, {1, 1}, {0, 255}}) {
        GltfDraft draft = triangle_draft();
        draft.document["accessors"][0]["sparse"] = {
            {"count", 2},
            {"indices", {{"bufferView", draft.view(indices)}, {"componentType", 5121}}},
            {"values", {{"bufferView", draft.view(Floats3(2, {1, 1, 1}))}}}};
        expect_refused(draft, "accessors[0].sparse");
    }
}

TEST_F(GltfHostile, PositionsMustBeFinite) {
    for (const float bad : {NAN, INFINITY, -INFINITY}) {
        GltfDraft draft;
        draft.show(
            {{"attributes", {{"POSITION", draft.vec3({{0, 0, 0}, {1, bad, 0}, {0, 1, 0}})}}}});
        expect_refused(draft, "POSITION of vertex 1 is not finite");
    }
}

TEST_F(GltfHostile, TransformsThatOverflowAreRefused) {
    expect_refused(triangle_draft({{"scale", {1e300, 1, 1}}}), "overflows");
    expect_refused(triangle_draft({{"translation", {1e30, 0, 0}}}), "beyond 1e18 m");
    // NaN cannot be written in JSON; what other writers put for it is no JSON either.
    EXPECT_NE(refusal(std::string(R"({"asset":{"version":"2.0"},"nodes":[{"scale":[NaN,1,1]}]})")),
              "");
}

TEST_F(GltfHostile, CyclesAndSecondParentsAreRefused) {
    GltfDraft self = triangle_draft({{"children", {0}}});
    expect_refused(self, "cycle");

    GltfDraft pair = triangle_draft({{"children", {1}}});
    pair.add("nodes", {{"children", {0}}});
    expect_refused(pair, "cycle");

    GltfDraft diamond = triangle_draft();
    for (int i = 0; i < 2; ++i) diamond.add("nodes", {{"children", {0}}});
    expect_refused(diamond, "a child twice");
}

TEST_F(GltfHostile, AMillionNodesInOneChainLoad) {
    std::string nodes = R"({"mesh":0})";
    for (int i = 1; i < 1'000'000; ++i) nodes += ",{\"children\":[" + std::to_string(i - 1) + "]}";
    GltfDraft draft = triangle_draft();
    draft.document["nodes"] = "NODES";
    std::string text = draft.text();
    text.replace(text.find("\"NODES\""), 7, "[" + nodes + "]");
    const TempFolder folder;
    const Scene scene = io::load_gltf(folder.write("chain.gltf", text));
    EXPECT_EQ(scene.triangles.size(), 1u);
}

TEST_F(GltfHostile, MoreEntriesThanAMillionAreRefused) {
    std::string text = R"({"asset":{"version":"2.0"},"materials":[{})";
    for (std::size_t i = 0; i < (std::size_t{1} << 20); ++i) text += ",{}";
    EXPECT_NE(refusal(text + "]}").find("entries"), std::string::npos);
}

TEST_F(GltfHostile, NestingIsBounded) {
    const std::string open = R"({"asset":{"version":"2.0"},"extras":)";
    const auto nested = [&](std::size_t depth) {
        return open + std::string(depth, '[') + std::string(depth, ']') + "}";
    };
    EXPECT_EQ(refusal(nested(200)), "");
    EXPECT_NE(refusal(nested(300)).find("nested"), std::string::npos);
    EXPECT_NE(refusal(nested(5'000'000)).find("nested"), std::string::npos);
    EXPECT_NE(refusal(open + std::string(5'000'000, '[')).find("nested"), std::string::npos);
    const std::string in_a_string(1000, '[');
    EXPECT_EQ(refusal(open + "\"\\\"" + in_a_string + "\"}"), "");
}

TEST_F(GltfHostile, CopiesAreBoundedByMaxTriangles) {
    GltfDraft draft = triangle_draft();
    for (int i = 1; i < 1000; ++i) draft.add("nodes", {{"mesh", 0}});
    EXPECT_EQ(draft.load({.max_triangles = 1000}).triangles.size(), 1000u);
    expect_refused(draft, "triangles that are allowed", {.max_triangles = 999});

    // Ten thousand nodes times ten thousand primitives, all of them the same three vertices.
    GltfDraft square;
    const int positions = square.vec3(one_triangle);
    const json primitive = {{"attributes", {{"POSITION", positions}}}};
    json primitives = json::array();
    for (int i = 0; i < 10'000; ++i) primitives.push_back(primitive);
    square.document["meshes"] = json::array({json{{"primitives", primitives}}});
    for (int i = 0; i < 10'000; ++i) square.add("nodes", {{"mesh", 0}});
    expect_refused(square, "triangles that are allowed");
}

TEST_F(GltfHostile, CopiesWithoutTrianglesCostNothing) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    json primitives = json::array();
    for (int i = 0; i < 30'000; ++i) {
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"mode", 0}});
    }
    draft.document["meshes"] = json::array({json{{"primitives", primitives}}});
    for (int i = 0; i < 100'000; ++i) draft.add("nodes", {{"mesh", 0}});
    EXPECT_TRUE(draft.load().triangles.empty());
}

TEST_F(GltfHostile, OneTriangleOfManyVerticesCopiedOftenIsQuick) {
    GltfDraft draft;
    const int positions = draft.vec3(Floats3(200'000, {1, 2, 3}));
    const int indices = draft.indices({0, 1, 60'000});
    draft.show({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
    for (int i = 0; i < 50'000; ++i) draft.add("nodes", {{"mesh", 0}});
    EXPECT_EQ(draft.load().positions.size(), 150'003u);
}

TEST_F(GltfHostile, ManyAccessorsOnTheSameBytesAreBounded) {
    GltfDraft draft;
    const int view = draft.view(Floats3(500'000, {1, 2, 3}));
    json primitives = json::array();
    for (int i = 0; i < 20'000; ++i) {
        const int positions = draft.accessor(view, 500'000, "VEC3", float_type);
        primitives.push_back({{"attributes", {{"POSITION", positions}}}, {"mode", 0}});
    }
    draft.document["meshes"] = json::array({json{{"primitives", primitives}}});
    expect_refused(draft, "too many elements");
}

TEST_F(GltfHostile, ManyMaterialsOfOneLargeImageAreQuick) {
    GltfDraft draft;
    std::vector<std::uint8_t> image(8 << 20);
    std::memcpy(image.data(), "GIF89a", 6);  // not read, so only looked at
    draft.add("images", {{"uri", "data:image/gif;base64," + base64(image)}});
    draft.add("textures", {{"source", 0}});
    for (int i = 0; i < 20'000; ++i) {
        json material;
        material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", 0}};
        draft.add("materials", material);
    }
    EXPECT_EQ(draft.load().materials.size(), 20'000u);
}

TEST_F(GltfHostile, LongNamesAreNotMultiplied) {
    GltfDraft draft = triangle_draft({{"name", std::string(1'000'000, 'n')}});
    EXPECT_LE(draft.load().parts.at(0).name.size(), 128u);
}

TEST_F(GltfHostile, MessagesAreOneLineWhateverTheFileSays) {
    GltfDraft draft = triangle_draft();
    draft.document["extensionsRequired"] = {"line\nbreak\r\x1b[2J" + std::string(10'000, 'x')};
    const std::string message = refusal(draft);
    EXPECT_EQ(message.find_first_of("\n\r\x1b"), std::string::npos);
    EXPECT_LT(message.size(), 400u);
}

// Buffers in files: what a uri may name.
GltfDraft external(const std::string& uri) {
    GltfDraft draft = triangle_draft();
    draft.document["buffers"] = json::array({json{{"uri", uri}, {"byteLength", 36}}});
    return draft;
}

std::string bytes_of_triangle() {
    const GltfDraft draft = triangle_draft();
    return {draft.bytes.begin(), draft.bytes.end()};
}

TEST_F(GltfUri, FilesInTheFolderAreReadWhateverTheirName) {
    const TempFolder folder;
    const std::pair<const char*, const char*> cases[] = {
        {"a.bin", "a.bin"},        {"with space.bin", "with space.bin"},
        {"b c.bin", "b%20c.bin"},  {"sub/d.bin", "sub/d.bin"},
        {"e.bin", "sub/../e.bin"}, {"f%20g.bin", "f%20g.bin"},
        {"100%.bin", "100%.bin"},  {"\xc3\xa9.bin", "%C3%A9.bin"},
        {"a+b.bin", "a+b.bin"}};
    for (const auto& [name, uri] : cases) {
        folder.write(name, bytes_of_triangle());
        EXPECT_EQ(refusal(folder.write("scene.gltf", external(uri).text())), "") << uri;
    }
}

TEST_F(GltfUri, FilesOutsideTheFolderAreRefused) {
    const TempFolder folder;
    const std::string outside = folder.write("outside.bin", bytes_of_triangle()).string();
    folder.write("scene/inside.bin", bytes_of_triangle());
    std::filesystem::create_symlink(outside, folder.path() / "scene/link.bin");
    std::filesystem::create_directory_symlink(folder.path(), folder.path() / "scene/up");
    for (const std::string& uri :
         {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
          std::string("%2E%2E%2Foutside.bin"), std::string("sub/../../outside.bin"), outside,
          "file://" + outside, "file:" + outside, "//" + outside, std::string("link.bin"),
          std::string("up/outside.bin"), std::string("../scene/../outside.bin"),
          std::string("http://localhost/inside.bin"), std::string("\\\\host\\inside.bin"),
          std::string("C:\\inside.bin"), std::string("inside.bin%00.png"), std::string("")}) {
        const std::string message = refusal(folder.write("scene/scene.gltf", external(uri).text()));
        EXPECT_NE(message.find("is not a file in the folder"), std::string::npos)
            << uri << ": " << message;
    }
    EXPECT_EQ(refusal(folder.write("scene/scene.gltf", external("inside.bin").text())), "");
}

TEST_F(GltfUri, FoldersAndPipesAreNotRead) {
    const TempFolder folder;
    std::filesystem::create_directory(folder.path() / "folder.bin");
    ASSERT_EQ(mkfifo((folder.path() / "pipe.bin").c_str(), 0600), 0);
    for (const char* uri : {"folder.bin", "pipe.bin", ".", "missing.bin"}) {
        EXPECT_NE(refusal(folder.write("scene.gltf", external(uri).text())), "") << uri;
    }
    EXPECT_NE(refusal(folder.path()), "");
    EXPECT_NE(refusal(folder.path() / "no-such-file.gltf"), "");
}

TEST_F(GltfUri, ManyBuffersInOneFileReadItOnce) {
    const TempFolder folder;
    folder.write("large.bin", std::string(8 << 20, '\0'));
    GltfDraft draft;
    for (int i = 0; i < 20'000; ++i) {
        draft.add("buffers", {{"uri", "large.bin"}, {"byteLength", 8 << 20}});
    }
    EXPECT_EQ(refusal(folder.write("scene.gltf", draft.text())), "");  // read each time: minutes
}

TEST_F(GltfUri, LargeDataUrisLoad) {
    GltfDraft draft;
    draft.show({{"attributes", {{"POSITION", draft.vec3(Floats3(3'000'000, {1, 2, 3}))}}}});
    EXPECT_EQ(draft.load().triangles.size(), 1'000'000u);
}

}  // namespace
}  // namespace clgi::test
