// The collected files that need a codec: they show what their uncompressed forms show.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "packed_scenes.hpp"

#if CLGI_HAS_DRACO
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/decode.h>
#include <draco/core/quantization_utils.h>
#endif

namespace clgi::test {
namespace {

const std::filesystem::path packed_folder =
    std::filesystem::path(CLGI_SCENES_DIR) / "needs-extension";

#define SKIP_WITHOUT_PACKED() \
    if (!std::filesystem::exists(packed_folder)) GTEST_SKIP() << "no scenes at " << packed_folder

[[maybe_unused]] std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// A cube of side 1 around the origin, each of its faces with normals of its own.
[[maybe_unused]] void expect_unit_cube(const Scene& scene, double tolerance) {
    ASSERT_EQ(scene.positions.size(), 24u);
    ASSERT_EQ(scene.triangles.size(), 12u);
    for (std::size_t i = 0; i < 24; ++i) {
        const glm::dvec3 p = scene.positions[i], n = scene.normals[i];
        EXPECT_VEC_NEAR(glm::abs(p), glm::dvec3(0.5), tolerance);
        EXPECT_NEAR(glm::dot(n, p), 0.5, tolerance);  // of the face that it is a corner of
        EXPECT_EQ(std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}), 1.0);
    }
    for (std::size_t t = 0; t < 12; ++t) {
        const glm::dvec3 n = scene.normals[scene.triangles[t].vertex[0]];
        EXPECT_NEAR(glm::dot(winding(scene, t), n), 1.0, 3.0 * tolerance) << t;
    }
}

#if CLGI_HAS_MESHOPT
TEST(GltfPackedScenes, MeshoptCubesAreCubes) {
    SKIP_WITHOUT_PACKED();
    // The scale of the node is written with nine digits, and its grid has 16383 steps.
    constexpr double tolerance = 1e-7;
    expect_unit_cube(io::load_gltf(packed_folder / "BoxMeshopt.glb"), tolerance);
    const Scene textured = io::load_gltf(packed_folder / "BoxTextured-meshopt.glb");
    expect_unit_cube(textured, tolerance);
    ASSERT_EQ(textured.textures.size(), 1u);
    // Where the texture is read: once in v, six times in u, on a grid of 4095 steps of both.
    glm::vec2 least(10.0f), most(-10.0f);
    const glm::mat3 transform = textured.materials[0].base_texture.transform;
    for (const glm::vec4& uv : textured.uvs) {
        const glm::vec3 place = transform * glm::vec3(uv.x, uv.y, 1.0f);
        least = glm::min(least, glm::vec2(place));
        most = glm::max(most, glm::vec2(place));
    }
    EXPECT_VEC_NEAR(glm::dvec3(least, 0), glm::dvec3(0), 1e-5);
    EXPECT_VEC_NEAR(glm::dvec3(most, 0), glm::dvec3(6, 1, 0), 1e-5);
}

// The file with a fallback, without it, and the fallback alone as plain glTF.
TEST(GltfPackedScenes, MeshoptAndItsFallbackShowTheSame) {
    SKIP_WITHOUT_PACKED();
    const auto with = packed_folder / "meshopt-fallback";
    const auto soup = triangle_soup(io::load_gltf(with / "meshopt-fallback.gltf"));
    EXPECT_EQ(soup.size(), 60u);
    EXPECT_EQ(soup, triangle_soup(io::load_gltf(packed_folder / "meshopt-no-fallback" /
                                                "meshopt-no-fallback.gltf")));
    // The normals of this fallback are still in the form that the filter takes, so no reader can
    // show them: both without.
    json document = json::parse(bytes_of(with / "meshopt-fallback.gltf"));
    for (json& mesh : document["meshes"]) mesh["primitives"][0]["attributes"].erase("NORMAL");
    json plain = document;
    plain["extensionsUsed"] = {"KHR_mesh_quantization"};
    for (json& view : plain["bufferViews"]) view.erase("extensions");
    for (json& buffer : plain["buffers"]) buffer.erase("extensions");
    const TempFolder folder;
    for (const char* name : {"meshopt-fallback.bin", "meshopt-fallback.fallback.bin"})
        folder.write(name, bytes_of(with / name));
    EXPECT_EQ(triangle_soup(io::load_gltf(folder.write("packed.gltf", document.dump()))),
              triangle_soup(io::load_gltf(folder.write("plain.gltf", plain.dump()))));
}
#endif

#if CLGI_HAS_WEBP
TEST(GltfPackedScenes, TheWebpIsTakenAndLooksLikeThePng) {
    SKIP_WITHOUT_PACKED();
    const auto file = packed_folder / "box-textured-webp.gltf";
    json document = json::parse(bytes_of(file));
    document["textures"][0].erase("extensions");
    const TempFolder folder;
    const Scene png = io::load_gltf(folder.write("png.gltf", document.dump()));
    const Scene webp = io::load_gltf(file);
    EXPECT_EQ(triangle_soup(webp), triangle_soup(png));
    ASSERT_EQ(webp.textures.size(), 1u);
    const Texture &a = webp.textures[0], &b = png.textures[0];
    ASSERT_EQ(a.rgba.size(), b.rgba.size());
    EXPECT_NE(a.rgba, b.rgba);  // it is lossy
    double sum = 0.0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i)
        sum += std::abs(int{a.rgba[i]} - int{b.rgba[i]});
    EXPECT_LT(sum / static_cast<double>(a.rgba.size()),
              0.05 * 255.0);  // two other pictures: a third
}
#endif

#if CLGI_HAS_DRACO
TEST(GltfPackedScenes, TheDracoHeartIsClosed) {
    SKIP_WITHOUT_PACKED();
    const Scene heart = io::load_gltf(packed_folder / "heart-draco.glb");
    ASSERT_EQ(heart.triangles.size(), 180u);
    glm::dvec3 sum(0.0);
    double area = 0.0;
    for (std::size_t t = 0; t < 180; ++t) {
        sum += winding(heart, t);
        area += glm::length(winding(heart, t));
    }
    // The areas of a closed surface add up to zero; positions are floats.
    EXPECT_LT(glm::length(sum), 1e-5 * area);
}

// Rounded to the grid of the stream, the original has the same triangles, each with its sense.
TEST(GltfPackedScenes, TheDracoBunnyIsTheBunnyOnItsGrid) {
    SKIP_WITHOUT_PACKED();
    const Scene packed = io::load_gltf(packed_folder / "bunny-draco.glb");
    const Scene original =
        io::load_gltf(packed_folder.parent_path() / "bunny" / "stanford-bunny.glb");

    // The grid, from the stream itself: all of the file's binary chunk.
    const std::string file = bytes_of(packed_folder / "bunny-draco.glb");
    const std::size_t start = file.find("DRACO");
    draco::DecoderBuffer buffer;
    buffer.Init(file.data() + start, file.size() - start);
    draco::Decoder decoder;
    decoder.SetSkipAttributeTransform(draco::GeometryAttribute::POSITION);
    const auto mesh = std::move(decoder.DecodeMeshFromBuffer(&buffer)).value();
    draco::AttributeQuantizationTransform grid;
    ASSERT_TRUE(
        grid.InitFromAttribute(*mesh->GetNamedAttribute(draco::GeometryAttribute::POSITION)));
    const int steps = (1 << grid.quantization_bits()) - 1;
    draco::Quantizer quantizer;
    quantizer.Init(grid.range(), steps);

    const auto on_grid = [&](const Scene& scene) {
        std::vector<std::array<std::array<int, 3>, 3>> triangles;
        for (const auto& triangle : scene.triangles) {
            std::array<std::array<int, 3>, 3> corners{};
            for (std::size_t i = 0; i < 3; ++i) {
                const glm::dvec3 p = scene.positions[triangle.vertex[i]];
                for (int axis = 0; axis < 3; ++axis) {
                    corners[i][static_cast<std::size_t>(axis)] =
                        quantizer.QuantizeFloat(static_cast<float>(p[axis]) - grid.min_value(axis));
                }
            }
            std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()),
                        corners.end());
            triangles.push_back(corners);
        }
        std::sort(triangles.begin(), triangles.end());
        return triangles;
    };
    EXPECT_EQ(packed.triangles.size(), 69451u);
    EXPECT_TRUE(on_grid(packed) == on_grid(original));
    // And what was loaded lies on the grid itself, but for the rounding of floats.
    const double step = double{grid.range()} / steps;
    for (const glm::dvec3 p : packed.positions) {
        for (int axis = 0; axis < 3; ++axis) {
            const double at = (p[axis] - double{grid.min_value(axis)}) / step;
            ASSERT_NEAR(at, std::round(at), 4.0 * 0x1p-24 * steps);
        }
    }
}
#endif

}  // namespace
}  // namespace clgi::test
