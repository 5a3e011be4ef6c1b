// The collected scenes: the real ones load as their manifest says, the broken ones are refused.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <map>
#include <sstream>

#include "gltf_draft.hpp"

namespace clgi::test {
namespace {

const std::filesystem::path scenes_folder = CLGI_SCENES_DIR;

using Row = std::vector<std::string>;

std::vector<Row> read_table(const std::filesystem::path& file) {
    std::ifstream stream(file);
    std::vector<Row> rows;
    std::string line;
    std::getline(stream, line);  // titles
    while (std::getline(stream, line)) {
        Row row;
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, '\t');) row.push_back(cell);
        rows.push_back(std::move(row));
    }
    return rows;
}

#define SKIP_WITHOUT_SCENES() \
    if (!std::filesystem::exists(scenes_folder)) GTEST_SKIP() << "no scenes at " << scenes_folder

Bounds parse_box(const std::string& text) {  // "x y z .. x y z"
    Bounds box;
    std::string dots;
    std::istringstream(text) >> box.low.x >> box.low.y >> box.low.z >> dots >> box.high.x >>
        box.high.y >> box.high.z;
    return box;
}

// Boxes that differ from the manifest's, which are of the meshes before the skin, before the
// default morph weights and before sparse values. These are after, computed with another program.
const std::map<std::string, const char*> posed_boxes = {
    {"animated/Lumberjack.glb", "-0.81053 -0.0022143 -0.61287 .. 0.47896 1.5668 0.64985"},
    {"animated/MorphPrimitivesTest/MorphPrimitivesTest.gltf", "-0.5 0 -0.5 .. 0.5 0.1 0.5"},
    {"animated/SimpleMorph/SimpleMorph.gltf", "0 0 0 .. 1 1.5 0"},
    {"odd-valid/SimpleSparseAccessor/SimpleSparseAccessor.gltf", "0 0 0 .. 6 4 0"},
    {"Animation_Skin_04.gltf", "-0.25 -0.4 -0.1 .. 0.25 0.17321 0"},
    {"Animation_Skin_05.gltf", "-0.25 -0.2 -0.1 .. 0.25 0.17321 0.19821"},
    {"Animation_Skin_06.gltf", "-0.25 -0.2 -0.1 .. 0.85 0.17321 0"},
    {"Animation_Skin_08.gltf", "-0.48 -0.3 -0.48 .. 0.48 0.3 0.48"},
    {"Animation_Skin_09.gltf", "-0.25 -0.4 -0.20313 .. 0.25 0.35811 0"},
    {"Animation_Skin_10.gltf", "-0.25 -0.5 0 .. 0.25 0.5 0.2"},
    {"Animation_Skin_11.gltf", "-0.375 -0.25 -0.1897 .. 0.375 0.45799 0"},
    {"Animation_Skin", "-0.25 -0.2 -0.1 .. 0.25 0.17321 0"},  // all the others
    // The manifest ignores EXT_mesh_gpu_instancing: 125 copies, not one.
    {"odd-valid/misc/simple-instancing.glb", "-1.667 -1.667 -1.667 .. 12.73 12.73 12.73"}};

std::string expected_box(const Row& row) {
    std::string best;
    std::string box = row[5];
    for (const auto& [key, posed] : posed_boxes) {  // the longest key that the name contains
        if (row[0].find(key) == std::string::npos || key.size() < best.size()) continue;
        best = key;
        box = posed;
    }
    return box;
}

// Files that must be refused, with the word that the message must hold.
const std::map<std::string, const char*> refused_scenes = {
    {"odd-valid/asset-generator/Compatibility/Compatibility_04.gltf", "minVersion"},
    {"odd-valid/asset-generator/Compatibility/Compatibility_05.gltf",
     "FAKE_materials_quantumRendering"},
#if !CLGI_HAS_MESHOPT
    {"needs-extension/BoxMeshopt.glb", "CLGI_MESHOPT is OFF"},
    {"needs-extension/BoxTextured-meshopt.glb", "CLGI_MESHOPT is OFF"},
    {"needs-extension/meshopt-no-fallback/meshopt-no-fallback.gltf", "CLGI_MESHOPT is OFF"},
#endif
#if !CLGI_HAS_DRACO
    {"needs-extension/bunny-draco.glb", "CLGI_DRACO is OFF"},
    {"needs-extension/heart-draco.glb", "CLGI_DRACO is OFF"},
#endif
    {"needs-extension/required-extensions-unsupported.gltf",
     "KHR_materials_pbrSpecularGlossiness"}};

TEST(GltfScenes, LoadAsTheManifestSays) {
    SKIP_WITHOUT_SCENES();
    const std::vector<Row> rows = read_table(scenes_folder / "MANIFEST.tsv");
    EXPECT_GE(rows.size(), 90u);
    for (const Row& row : rows) {
        SCOPED_TRACE(row[0]);
        if (const auto refused = refused_scenes.find(row[0]); refused != refused_scenes.end()) {
            EXPECT_NE(refusal(scenes_folder / row[0]).find(refused->second), std::string::npos);
            continue;
        }
        const Scene scene = io::load_gltf(scenes_folder / row[0]);
        EXPECT_NO_THROW(validate(scene));
        const bool instanced = row[0] == "odd-valid/misc/simple-instancing.glb";
        // Files that need an extension are counted in the manifest only if tinygltf decodes them.
        const std::string& placed = row[3].empty() ? row[4] : row[3];
        EXPECT_EQ(scene.triangles.size(), std::stoul(placed) * (instanced ? 125 : 1));

        const std::string text = expected_box(row);
        if (text.empty()) continue;
        const Bounds box = parse_box(text);
        const Bounds found = bounds(scene);
        // The tables have four digits, of numbers no larger than the box.
        const double tolerance = 1e-3 * glm::length(box.high - box.low) + 1e-6;
        EXPECT_VEC_NEAR(found.low, box.low, tolerance);
        EXPECT_VEC_NEAR(found.high, box.high, tolerance);
    }
}

TEST(GltfScenes, GiveDefaultCamerasThatSeeThem) {
    SKIP_WITHOUT_SCENES();
    const Scene bunny = io::load_gltf(scenes_folder / "bunny/stanford-bunny.glb");
    const Bounds bunny_box = bounds(bunny);
    const Camera outside = default_camera(bunny);
    EXPECT_GT(outside.position.z, bunny_box.high.z);

    for (const char* room :
         {"sponza/sponza.glb", "cornell/cornell-box.gltf", "house/small-house.glb"}) {
        const Scene scene = io::load_gltf(scenes_folder / room);
        const Bounds box = bounds(scene);
        const Camera inside = default_camera(scene);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GT(inside.position[axis], box.low[axis]) << room;
            EXPECT_LT(inside.position[axis], box.high[axis]) << room;
        }
    }
}

TEST(GltfScenes, BrokenOnesAreRefusedInOneLineOrLoadWhole) {
    SKIP_WITHOUT_SCENES();
    const std::filesystem::path folder = scenes_folder / "malformed";
    const std::vector<Row> rows = read_table(folder / "EXPECTED.tsv");
    EXPECT_GE(rows.size(), 250u);
    for (const Row& row : rows) {
        SCOPED_TRACE(row[0]);
        const std::clock_t start = std::clock();
        const std::string& kind = row[4];
        std::string message;
        try {
            const Scene scene = io::load_gltf(folder / row[0]);
            EXPECT_NO_THROW(validate(scene));
            EXPECT_EQ(kind, "semantic") << "loaded";
        } catch (const InputError& error) {
            message = error.what();
            EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 0);
            EXPECT_EQ(message.find((folder / row[0]).string() + ": "), 0u) << message;
        }
        EXPECT_LT(std::clock() - start, 10 * CLOCKS_PER_SEC);
    }
}

// Every prefix and every single-byte damage of a small GLB must be survived.
TEST(GltfScenes, DamagedBytesNeverDoMoreThanThrow) {
    SKIP_WITHOUT_SCENES();
    const TempFolder folder;
    for (const char* name : {"odd-valid/misc/zero-sized-bin-chunk-issue-440.glb",
                             "odd-valid/misc/singleBlendshapeCube_sparse.glb"}) {
        std::ifstream stream(scenes_folder / name, std::ios::binary);
        const std::string intact{std::istreambuf_iterator<char>(stream), {}};
        const auto survive = [&](const std::string& bytes) {
            const auto file = folder.write("damaged.glb", bytes);
            try {
                validate(io::load_gltf(file, {.max_triangles = 100'000}));
            } catch (const InputError&) {
            }
        };
        for (std::size_t length = 0; length < intact.size(); length += 3) {
            survive(intact.substr(0, length));
        }
        for (std::size_t at = 0; at < intact.size(); ++at) {
            for (const char byte : {'\0', '9', '\xff'}) {
                std::string damaged = intact;
                damaged[at] = byte;
                survive(damaged);
            }
        }
    }
}

}  // namespace
}  // namespace clgi::test
