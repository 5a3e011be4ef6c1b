// What load_gltf makes of correct files: geometry, materials, lights, cameras.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "gltf_draft.hpp"

namespace clgi::test {
namespace {

const Floats3 square = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};

GltfDraft square_draft(int mode, const std::vector<std::uint16_t>& indices) {
    GltfDraft draft;
    json primitive = {{"attributes", {{"POSITION", draft.vec3(square)}}}, {"mode", mode}};
    if (!indices.empty()) primitive["indices"] = draft.indices(indices);
    draft.show(primitive);
    return draft;
}

TEST(GltfModes, StripTrianglesAllFaceTheSameWay) {
    const Scene scene = square_draft(5, {}).load();
    ASSERT_EQ(scene.triangles.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t) EXPECT_EQ(winding(scene, t), glm::dvec3(0, 0, 1));
}

TEST(GltfModes, FanTrianglesShareTheFirstVertex) {
    const Scene scene = square_draft(6, {0, 1, 3, 2}).load();
    ASSERT_EQ(scene.triangles.size(), 2u);
    for (std::size_t t = 0; t < 2; ++t) EXPECT_EQ(winding(scene, t), glm::dvec3(0, 0, 1));
}

TEST(GltfModes, StitchesOfAStripAreLeftOut) {
    const Scene scene = square_draft(5, {0, 1, 2, 2, 1, 1, 3, 2}).load();
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        EXPECT_GT(glm::length(winding(scene, t)), 0.0);
    }
    EXPECT_EQ(scene.triangles.size(), 2u);
}

TEST(GltfModes, PointsAndLinesAreSkippedWithOneWarning) {
    for (const int mode : {0, 1, 2, 3}) {
        const Scene scene = square_draft(mode, {}).load();
        EXPECT_TRUE(scene.triangles.empty());
        ASSERT_GE(scene.warnings.size(), 1u);
        EXPECT_NE(scene.warnings.back().find("points or lines"), std::string::npos);
    }
}

TEST(GltfModes, UnusedVerticesAreLeftOut) {
    GltfDraft draft;
    const json attributes = {{"POSITION", draft.vec3({{0, 0, 0}, {9, 9, 9}, {1, 0, 0}, {0, 1, 0}})},
                             {"NORMAL", draft.vec3(Floats3(4, {0, 0, 1}))}};
    draft.show({{"attributes", attributes}, {"indices", draft.indices({0, 2, 3})}});
    EXPECT_EQ(draft.load().positions.size(), 3u);
}

TEST(GltfNormals, MissingOnesAreFlat) {
    const Scene scene = square_draft(5, {}).load();
    ASSERT_EQ(scene.normals.size(), 6u);
    for (const glm::vec3& normal : scene.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
}

TEST(GltfNormals, OnesWithoutDirectionComeFromTheTriangles) {
    GltfDraft draft;
    draft.show({{"attributes",
                 {{"POSITION", draft.vec3(one_triangle)},
                  {"NORMAL", draft.vec3({{0, 0, 0}, {NAN, 0, 0}, {0, 0, 2}})}}}});
    const Scene scene = draft.load();
    for (const glm::vec3& normal : scene.normals) EXPECT_EQ(normal, glm::vec3(0, 0, 1));
    EXPECT_FALSE(scene.warnings.empty());
}

TEST(GltfNodes, NegativeScaleKeepsTheFrontInFront) {
    GltfDraft draft;
    draft.show(
        {{"attributes",
          {{"POSITION", draft.vec3(one_triangle)}, {"NORMAL", draft.vec3(Floats3(3, {0, 0, 1}))}}}},
        {{"scale", {-2, 1, 1}}});
    const Scene scene = draft.load();
    EXPECT_EQ(winding(scene, 0), glm::dvec3(0, 0, 2));
    EXPECT_EQ(scene.normals[0], glm::vec3(0, 0, 1));
}

TEST(GltfNodes, TransformsCompose) {
    GltfDraft draft = triangle_draft({{"translation", {1, 0, 0}}});
    const double s = std::sqrt(0.5);
    draft.add("nodes", {{"children", {0}}, {"rotation", {0, 0, s, s}}, {"scale", {2, 2, 2}}});
    const Scene scene = draft.load();
    // (1,0,0) + (1,0,0), doubled, then a quarter turn about z; 1e-15 is the rounding of s.
    EXPECT_VEC_NEAR(corner(scene, 0, 1), glm::dvec3(0, 4, 0), 1e-14);
}

TEST(GltfNodes, AMatrixIsReadByColumns) {
    const Scene scene =
        triangle_draft({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1}}}).load();
    EXPECT_EQ(corner(scene, 0, 0), glm::dvec3(5, 6, 7));
}

TEST(GltfNodes, ZeroScaleFlattens) {
    const Scene scene = triangle_draft({{"scale", {1, 0, 1}}}).load();
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_NO_THROW(validate(scene));
}

TEST(GltfNodes, TheChosenSceneAloneIsLoaded) {
    GltfDraft draft = triangle_draft();
    draft.add("nodes", {{"mesh", 0}, {"translation", {0, 0, 5}}});
    draft.add("scenes", {{"nodes", {0}}});
    draft.add("scenes", {{"nodes", {0, 1}}});
    draft.document["scene"] = 1;
    EXPECT_EQ(draft.load().triangles.size(), 2u);
    EXPECT_EQ(draft.load({.scene = 0}).triangles.size(), 1u);
    EXPECT_THROW(draft.load({.scene = 2}), InputError);
}

TEST(GltfNodes, InstancesBecomePartsOfTheirOwn) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    const int places = draft.vec3({{0, 0, 0}, {0, 0, 3}});
    json node;
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] = places;
    draft.show({{"attributes", {{"POSITION", positions}}}}, node);
    const Scene scene = draft.load();
    ASSERT_EQ(scene.parts.size(), 2u);
    EXPECT_EQ(corner(scene, scene.parts[1].first_triangle, 0), glm::dvec3(0, 0, 3));
}

TEST(GltfAccessors, StridedAndSparseAndQuantizedAgreeWithPlain) {
    const Scene plain = triangle_draft().load();

    GltfDraft strided;
    const std::vector<std::array<float, 5>> wide = {
        {0, 0, 0, 8, 8}, {1, 0, 0, 8, 8}, {0, 1, 0, 8, 8}};
    const int wide_view = strided.view(wide, 20);
    strided.show(
        {{"attributes", {{"POSITION", strided.accessor(wide_view, 3, "VEC3", float_type)}}}});

    GltfDraft sparse;
    const int zeros = sparse.accessor(-1, 3, "VEC3", float_type);
    sparse.document["accessors"][zeros]["sparse"] = {
        {"count", 2},
        {"indices",
         {{"bufferView", sparse.view(std::vector<std::uint8_t>{1, 2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", sparse.view(Floats3{{1, 0, 0}, {0, 1, 0}})}}}};
    sparse.show({{"attributes", {{"POSITION", zeros}}}});

    GltfDraft quantized;
    quantized.document["extensionsUsed"] = {"KHR_mesh_quantization"};
    const std::vector<std::array<std::int8_t, 4>> bytes = {
        {0, 0, -128, 0}, {127, 0, 0, 0}, {0, 127, 0, 0}};
    const int bytes_view = quantized.view(bytes, 4);
    quantized.show({{"attributes",
                     {{"POSITION", quantized.accessor(bytes_view, 3, "VEC3", int8_type, true)}}}},
                   {{"scale", {1, 1, 0}}});  // flattens the -128, which must read as -1

    for (const GltfDraft& draft : {strided, sparse, quantized}) {
        const Scene scene = draft.load();
        ASSERT_EQ(scene.triangles.size(), 1u);
        for (int i = 0; i < 3; ++i) EXPECT_EQ(corner(scene, 0, i), corner(plain, 0, i));
    }
}

TEST(GltfAccessors, QuantizedPositionsNeedTheExtension) {
    GltfDraft draft;
    const int view = draft.view(std::vector<std::uint8_t>(12), 4);
    draft.show({{"attributes", {{"POSITION", draft.accessor(view, 3, "VEC3", int8_type)}}}});
    EXPECT_NE(refusal(draft).find("format"), std::string::npos);
}

TEST(GltfAccessors, ColorsAreReadInEveryFormat) {
    const auto first_color = [](auto make) {
        GltfDraft draft;
        const int positions = draft.vec3(one_triangle);
        draft.show({{"attributes", {{"POSITION", positions}, {"COLOR_0", make(draft)}}}});
        return draft.load().colors.at(0);
    };
    EXPECT_EQ(first_color([](GltfDraft& d) {
                  return d.vec3(Floats3(3, {0.5f, 2.0f, -1.0f}));
              }),
              glm::vec4(0.5f, 1.0f, 0.0f, 1.0f));
    EXPECT_EQ(first_color([](GltfDraft& d) {
                  const std::vector<std::uint8_t> bytes(12, 51);
                  return d.accessor(d.view(bytes), 3, "VEC4", uint8_type, true);
              }),
              glm::vec4(0.2f));
    EXPECT_EQ(first_color([](GltfDraft& d) {
                  const std::vector<std::uint16_t> words(12, 65535);
                  return d.accessor(d.view(words, 8), 3, "VEC3", uint16_type, true);
              }),
              glm::vec4(1.0f));
}

TEST(GltfSkins, WeightsAreMadeToSumToOne) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    const int joints =
        draft.accessor(draft.view(std::vector<std::uint8_t>{0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0}), 3,
                       "VEC4", uint8_type);
    const std::vector<std::array<float, 4>> halves(3, {3, 1, 0, 0});
    const int weights = draft.accessor(draft.view(halves), 3, "VEC4", float_type);
    draft.show(
        {{"attributes", {{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}}}},
        {{"skin", 0}, {"translation", {100, 0, 0}}});  // which a skinned mesh ignores
    draft.add("nodes", json::object());
    draft.add("nodes", {{"translation", {0, 0, 4}}});
    draft.add("skins", {{"joints", {1, 2}}});
    EXPECT_EQ(corner(draft.load(), 0, 1), glm::dvec3(1, 0, 1));
}

TEST(GltfMorph, TheNodesWeightsGoBeforeTheMeshs) {
    GltfDraft draft;
    const int positions = draft.vec3(one_triangle);
    const int raised = draft.vec3(Floats3(3, {0, 0, 8}));
    draft.show({{"attributes", {{"POSITION", positions}}},
                {"targets", json::array({json{{"POSITION", raised}}})}});
    draft.document["meshes"][0]["weights"] = {0.5};
    EXPECT_EQ(corner(draft.load(), 0, 0), glm::dvec3(0, 0, 4));
    draft.document["nodes"][0]["weights"] = {0.25};
    EXPECT_EQ(corner(draft.load(), 0, 0), glm::dvec3(0, 0, 2));
}

TEST(GltfLights, ComeInThreeKinds) {
    GltfDraft draft;
    json& lights = draft.document["extensions"]["KHR_lights_punctual"]["lights"];
    lights.push_back({{"type", "directional"}, {"intensity", 3.0}, {"color", {1, 0.5, 0}}});
    lights.push_back({{"type", "point"}, {"range", 7.0}});
    const double wide = std::numbers::pi / 2;
    lights.push_back({{"type", "spot"}, {"spot", {{"outerConeAngle", wide}}}});
    for (int i = 0; i < 3; ++i) {
        json node = {{"translation", {0, i, 0}}, {"rotation", {1, 0, 0, 0}}};  // -z becomes +z
        node["extensions"]["KHR_lights_punctual"]["light"] = i;
        draft.add("nodes", node);
    }
    const Scene scene = draft.load();
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].kind, Light::Kind::directional);
    EXPECT_EQ(scene.lights[0].intensity, glm::vec3(3.0f, 1.5f, 0.0f));
    EXPECT_VEC_NEAR(scene.lights[0].direction, glm::dvec3(0, 0, 1), 1e-7);
    EXPECT_EQ(scene.lights[1].range, 7.0f);
    EXPECT_EQ(scene.lights[1].position, glm::dvec3(0, 1, 0));
    EXPECT_FLOAT_EQ(scene.lights[2].outer_angle, std::numbers::pi_v<float> / 2);
}

TEST(GltfCameras, LookAlongMinusZAlsoWhenMirrored) {
    GltfDraft draft;
    draft.add("cameras",
              {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}});
    draft.add("cameras", {{"type", "orthographic"},
                          {"orthographic", {{"xmag", 4}, {"ymag", 3}, {"znear", 0}, {"zfar", 9}}}});
    draft.add("nodes", {{"camera", 0}, {"translation", {1, 2, 3}}, {"scale", {-1, 1, 1}}});
    draft.add("nodes", {{"camera", 1}});
    const Scene scene = draft.load();
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].position, glm::dvec3(1, 2, 3));
    EXPECT_EQ(scene.cameras[0].forward, glm::vec3(0, 0, -1));
    EXPECT_EQ(scene.cameras[0].right, glm::vec3(1, 0, 0));
    EXPECT_EQ(scene.cameras[0].vertical_fov, 0.5f);
    EXPECT_EQ(scene.cameras[1].kind, Camera::Kind::orthographic);
    EXPECT_EQ(scene.cameras[1].half_height, 3.0f);
}

}  // namespace
}  // namespace clgi::test
