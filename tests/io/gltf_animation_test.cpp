// From a file's animations to poses: joints, morph targets, lights and cameras; files whose
// animations are broken load as they did before, with a line that says why they stand still.
// SPDX-License-Identifier: MIT
#include <cmath>

#include "posing.hpp"

namespace clgi {
namespace {

using test::GltfDraft;
using test::json;
using test::posed_at;
using test::strip_draft;

const double half = std::sqrt(0.5);
constexpr double near = 2e-7;  // rotations and weights are floats

TEST(GltfAnimation, AJointTurnsWhatFollowsIt) {
    const Scene bent = posed_at(strip_draft().load(), 1.0);
    EXPECT_VEC_NEAR(bent.positions[0], glm::dvec3(0, 0, 0), near);
    EXPECT_VEC_NEAR(bent.positions[2], glm::dvec3(1, 0, 0), near);  // on the axis
    EXPECT_VEC_NEAR(bent.positions[4], glm::dvec3(1, 1, 0), near);
    EXPECT_VEC_NEAR(bent.positions[5], glm::dvec3(1, 1, -1), near);
    EXPECT_VEC_NEAR(bent.normals[0], glm::dvec3(0, 1, 0), near);
    EXPECT_VEC_NEAR(bent.normals[2], glm::dvec3(-half, half, 0), near);
    EXPECT_VEC_NEAR(bent.normals[4], glm::dvec3(-1, 0, 0), near);
    const Scene eighth = posed_at(strip_draft().load(), 0.5);
    EXPECT_VEC_NEAR(eighth.positions[4], glm::dvec3(1 + half, half, 0), near);
}

TEST(GltfAnimation, TargetsMoveVerticesBeforeJointsDo) {
    GltfDraft draft = strip_draft();
    draft.document["nodes"][0]["weights"] = {2.0};
    const Scene bent = posed_at(draft.load(), 1.0);
    EXPECT_VEC_NEAR(bent.positions[5], glm::dvec3(-1, 1, -1), 2 * near);
    EXPECT_VEC_NEAR(bent.positions[1], glm::dvec3(0, 2, -1), 2 * near);
}

TEST(GltfAnimation, WeightsAreMadeToSumToOneAndMayBeZero) {
    // Halved; none at all, for the pair between; a weight that is not finite.
    const Scene scene =
        strip_draft("JOINTS_0", "WEIGHTS_0", {0.5f, 0, 0, 0, 0.5f, 0,    0, 0, 0,   0,    0, 0,
                                              0,    0, 0, 0, 0,    0.5f, 0, 0, NAN, 3.0f, 0, 0})
            .load();
    const Scene bent = posed_at(scene, 1.0);
    EXPECT_VEC_NEAR(bent.positions[4], glm::dvec3(1, 1, 0), near);
    EXPECT_VEC_NEAR(bent.positions[5], glm::dvec3(1, 1, -1), near);
    EXPECT_VEC_NEAR(bent.positions[2], glm::dvec3(1, 0, 0), near);  // stays with the node
    EXPECT_VEC_NEAR(bent.normals[2], glm::dvec3(0, 1, 0), near);
    EXPECT_EQ(scene.animation->ranges[0].influence_count, 1u);
}

// The same weights, the second four joints of which are in a set of their own.
TEST(GltfAnimation, FourMoreJointsAreReadWhereThereAreAny) {
    GltfDraft draft = strip_draft();
    json& attributes = draft.document["meshes"][0]["primitives"][0]["attributes"];
    std::vector<std::uint8_t> root(24, 0), second(24, 1);
    std::vector<float> zero(24, 0.0f), more(24, 0.0f);
    for (std::size_t v = 0; v < 6; ++v) {
        zero[4 * v] = v < 4 ? 1.0f : 0.0f;
        more[4 * v + 3] = v < 2 ? 0.0f : 1.0f;
    }
    attributes["JOINTS_0"] = draft.accessor(draft.view(root), 6, "VEC4", test::uint8_type);
    attributes["WEIGHTS_0"] = test::vec4s(draft, zero);
    attributes["JOINTS_1"] = draft.accessor(draft.view(second), 6, "VEC4", test::uint8_type);
    attributes["WEIGHTS_1"] = test::vec4s(draft, more);
    const Scene bent = posed_at(draft.load(), 1.0), one_set = posed_at(strip_draft().load(), 1.0);
    for (std::size_t v = 0; v < 6; ++v) {
        EXPECT_VEC_NEAR(bent.positions[v], one_set.positions[v], near) << v;
        EXPECT_VEC_NEAR(bent.normals[v], one_set.normals[v], near) << v;
    }
}

TEST(GltfAnimation, NormalsFollowTheInverseTranspose) {
    GltfDraft draft;
    draft.show({{"attributes",
                 {{"POSITION", draft.vec3({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})},
                  {"NORMAL", draft.vec3(test::Floats3(3, {1, 1, 1}))}}}});
    test::animate(draft, 0, "scale", test::scalars(draft, {0, 1, 2}),
                  draft.vec3({{1, 1, 1}, {1, 2, 4}, {1, 2, 0}}));
    const Scene scene = draft.load();
    EXPECT_VEC_NEAR(posed_at(scene, 1.0).normals[0], glm::normalize(glm::dvec3(1, 0.5, 0.25)),
                    1e-7);
    EXPECT_VEC_NEAR(posed_at(scene, 2.0).normals[0], glm::dvec3(0, 0, 1), 1e-7);  // flat
    EXPECT_NO_THROW(validate(posed_at(scene, 2.0)));
}

// A triangle without normals has that of its plane, in every pose.
TEST(GltfAnimation, MissingNormalsStayFlat) {
    GltfDraft draft = test::triangle_draft();
    test::animate(draft, 0, "rotation", test::scalars(draft, {0, 1}),
                  test::vec4s(draft, {0, 0, 0, 1, 1, 0, 0, 0}));
    const Scene turned = posed_at(draft.load(), 0.5);
    for (const glm::vec3& normal : turned.normals)
        EXPECT_VEC_NEAR(normal, glm::dvec3(0, -1, 0), near);
}

// A mesh that is mirrored shows its other side: normals of its own go with the surface, flat ones
// with the corners.
TEST(GltfAnimation, MirroredPosesMirrorSmoothNormalsAndTurnFlatOnes) {
    for (const bool smooth : {true, false}) {
        GltfDraft draft;
        json attributes = {{"POSITION", draft.vec3(test::one_triangle)}};
        if (smooth) attributes["NORMAL"] = draft.vec3(test::Floats3(3, {0.6f, 0, 0.8f}));
        draft.show({{"attributes", attributes}});
        test::animate(draft, 0, "scale", test::scalars(draft, {0, 1}),
                      draft.vec3({{1, 1, 1}, {-1, 1, 1}}));
        const Scene scene = draft.load(), mirrored = posed_at(scene, 1.0);
        EXPECT_VEC_NEAR(test::winding(mirrored, 0), glm::dvec3(0, 0, -1), near);
        for (std::size_t v = 0; v < 3; ++v) {
            EXPECT_VEC_NEAR(posed_at(scene, 0.0).normals[v],
                            smooth ? glm::dvec3(0.6, 0, 0.8) : glm::dvec3(0, 0, 1), near);
            EXPECT_VEC_NEAR(mirrored.normals[v],
                            smooth ? glm::dvec3(-0.6, 0, 0.8) : glm::dvec3(0, 0, -1), near);
        }
    }
}

TEST(GltfAnimation, LightsAndCamerasFollowTheirNodes) {
    GltfDraft draft;
    draft.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"spot", json::object()}}, {{"type", "point"}}};
    draft.document["extensionsUsed"] = {"KHR_lights_punctual"};
    draft.add("cameras", {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
    draft.add("nodes", {{"children", {1, 2}}});
    const json carried = {{"KHR_lights_punctual", {{"light", 0}}}};
    draft.add("nodes", {{"extensions", carried}, {"translation", {1, 0, 0}}});
    draft.add("nodes", {{"camera", 0}});
    draft.add("nodes",
              {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});  // stands still
    const auto h = static_cast<float>(half);
    test::animate(draft, 0, "rotation", test::scalars(draft, {0, 1}),
                  test::vec4s(draft, {0, 0, 0, 1, 0, h, 0, h}));
    const Scene scene = draft.load();
    ASSERT_TRUE(scene.animation);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.animation->lights.size(), 1u);
    EXPECT_EQ(scene.animation->nodes.size(), 3u);
    const Scene turned = posed_at(scene, 1.0);
    const std::size_t spot = scene.lights[0].kind == Light::Kind::spot ? 0 : 1;
    EXPECT_VEC_NEAR(turned.lights[spot].position, glm::dvec3(0, 0, -1), near);
    EXPECT_VEC_NEAR(turned.lights[spot].direction, glm::dvec3(-1, 0, 0), near);
    EXPECT_VEC_NEAR(turned.cameras[0].forward, glm::dvec3(-1, 0, 0), near);
    EXPECT_VEC_NEAR(turned.cameras[0].right, glm::dvec3(0, 0, -1), near);
    EXPECT_FALSE(motion_bounds(scene, 0));
}

TEST(GltfAnimation, IsNotThereWhereNothingMoves) {
    EXPECT_FALSE(test::triangle_draft().load().animation);
    GltfDraft other = test::triangle_draft();
    other.add("nodes", json::object());  // carries nothing
    test::animate(other, 1, "scale", test::scalars(other, {0, 1}),
                  other.vec3({{1, 1, 1}, {2, 2, 2}}));
    EXPECT_FALSE(other.load().animation);
    EXPECT_FALSE(strip_draft().load({.animation = false}).animation);
    EXPECT_TRUE(strip_draft().load().animation);
}

TEST(GltfAnimation, CopiesMoveWithTheirNode) {
    GltfDraft draft;
    json node;
    node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["TRANSLATION"] =
        draft.vec3({{0, 0, 0}, {0, 0, 3}});
    draft.show({{"attributes", {{"POSITION", draft.vec3(test::one_triangle)}}}}, node);
    test::animate(draft, 0, "scale", test::scalars(draft, {0, 1}),
                  draft.vec3({{1, 1, 1}, {2, 2, 2}}));
    const Scene grown = posed_at(draft.load(), 1.0);
    EXPECT_VEC_NEAR(test::corner(grown, 1, 1), glm::dvec3(2, 0, 6), 1e-6);
}

// What a broken animation says; the scene is loaded as if there were none.
std::string left_out(const GltfDraft& draft) {
    const Scene scene = draft.load();
    EXPECT_FALSE(scene.animation);
    EXPECT_EQ(scene.triangles.size(), 4u);
    return scene.warnings.empty() ? "" : scene.warnings.back();
}

TEST(GltfAnimation, BrokenOnesAreLeftOutWithALine) {
    GltfDraft draft = strip_draft();
    json& sampler = draft.document["animations"][0]["samplers"][0];
    sampler["input"] = test::scalars(draft, {1, 1});
    EXPECT_EQ(left_out(draft),
              "animation is left out: animation: clip 0, curve 0 has key times "
              "that do not rise at key 1");
    sampler["input"] = test::scalars(draft, {0, 1});
    sampler["interpolation"] = "BEZIER";
    EXPECT_EQ(left_out(draft),
              "animation is left out: clip 0: interpolation is BEZIER, none of "
              "LINEAR, STEP, CUBICSPLINE");
    sampler["interpolation"] = "LINEAR";
    draft.document["nodes"][2] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 1}}};
    EXPECT_EQ(left_out(draft), "an animation channel of a node that has a matrix is left out");
}

// Keys without a number, and times.
TEST(GltfAnimation, NumbersThatAreNotFiniteAreLeftOutWithALine) {
    for (const float bad : {NAN, INFINITY}) {
        GltfDraft draft = strip_draft();
        json& sampler = draft.document["animations"][0]["samplers"][0];
        sampler["output"] = test::vec4s(draft, {0, 0, 0, 1, 0, bad, 0, 1});
        EXPECT_EQ(left_out(draft),
                  "animation is left out: animation: clip 0, curve 0 has values that are not "
                  "finite");
        draft = strip_draft();
        draft.document["animations"][0]["samplers"][0]["input"] = test::scalars(draft, {0, bad});
        EXPECT_EQ(left_out(draft),
                  "animation is left out: animation: clip 0, curve 0 has key times that do not "
                  "rise at key 1");
    }
    // Other uses of the same numbers are refused as before.
    GltfDraft shared = test::triangle_draft();
    const int bad = shared.vec3({{0, 0, 0}, {NAN, 0, 0}, {0, 1, 0}});
    shared.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = bad;
    test::animate(shared, 0, "scale", test::scalars(shared, {0, 1, 2}), bad);
    EXPECT_NE(test::refusal(shared).find("POSITION of vertex 1 is not finite"), std::string::npos);
    shared.document["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = 0;
    EXPECT_EQ(test::refusal(shared), "");
    const json places = {{"attributes", {{"TRANSLATION", bad}}}};
    shared.document["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"] = places;
    EXPECT_NE(test::refusal(shared).find("element 1 is not finite"), std::string::npos);
    GltfDraft skin = strip_draft();
    std::vector<float> binds(32, 0.0f);
    binds[17] = NAN;
    const int matrices = skin.accessor(skin.view(binds), 2, "MAT4", test::float_type);
    skin.document["skins"][0]["inverseBindMatrices"] = matrices;
    json& samplers = skin.document["animations"][0]["samplers"];
    json unused = samplers[0];
    unused["output"] = matrices;
    samplers.push_back(unused);
    EXPECT_NE(test::refusal(skin).find("element 1 is not finite"), std::string::npos);
}

// What glTF 2.0, section 3.11, allows: floats; of rotations and weights normalised integers too.
TEST(GltfAnimation, KeysInOtherFormatsAreRefused) {
    const auto refused = [](const char* path, const auto& numbers, std::size_t count,
                            const char* type, int component, bool normalized) {
        GltfDraft draft = strip_draft();
        const int values = draft.accessor(draft.view(numbers), count, type, component, normalized);
        const int node = std::string(path) == "weights" ? 0 : 2;
        test::animate(draft, node, path, test::scalars(draft, {0, 1}), values);
        return test::refusal(draft);
    };
    const std::vector<float> floats(32, 1.0f);
    const std::vector<std::int16_t> shorts(8, 20000);
    const std::vector<std::uint32_t> longs(8, 1);
    const auto expect = [](const std::string& message, const char* because) {
        EXPECT_NE(message.find(because), std::string::npos) << "it said: " << message;
    };
    const char* shape = "key values of the wrong shape";
    const char* format = "key values of a format that is not allowed";
    expect(refused("translation", floats, 2, "MAT3", test::float_type, false), shape);
    expect(refused("scale", floats, 2, "MAT3", test::float_type, false), shape);
    expect(refused("rotation", floats, 2, "MAT4", test::float_type, false), shape);
    expect(refused("translation", shorts, 2, "VEC3", test::int16_type, true), format);
    expect(refused("scale", shorts, 2, "VEC3", test::int16_type, false), format);
    expect(refused("rotation", shorts, 2, "VEC4", test::int16_type, false), format);
    expect(refused("rotation", longs, 2, "VEC4", test::uint32_type, true), format);
    expect(refused("weights", shorts, 2, "SCALAR", test::int16_type, false), format);
    EXPECT_EQ(refused("rotation", shorts, 2, "VEC4", test::int16_type, true), "");
    EXPECT_EQ(refused("weights", shorts, 2, "SCALAR", test::uint16_type, true), "");
    EXPECT_EQ(refused("translation", floats, 2, "VEC3", test::float_type, false), "");
}

// Nine scales, each on top of the last, overflow: the third column is infinite, the place is not.
TEST(GltfAnimation, LightsAndCamerasStayWhereTheirNodeOverflows) {
    for (const float scale : {3e38f, -3e38f}) {
        GltfDraft draft = test::triangle_draft();
        draft.document["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}};
        draft.document["extensionsUsed"] = {"KHR_lights_punctual"};
        draft.add("cameras",
                  {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}});
        const int times = test::scalars(draft, {0, 1});
        const int values = draft.vec3({{1, 1, 1}, {scale, scale, scale}});
        for (int node = 1; node <= 9; ++node) {
            draft.add("nodes", {{"children", {node + 1}}});
            test::animate(draft, node, "scale", times, values);
        }
        json& last = draft.document["nodes"][9];
        last = {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}};
        json& clips = draft.document["animations"];
        for (int node = 2; node <= 9; ++node) {
            json channel = clips[static_cast<std::size_t>(node - 1)]["channels"][0];
            clips[0]["channels"].push_back(channel);
        }
        const Scene scene = draft.load();
        ASSERT_TRUE(scene.animation);
        const Scene late = posed_at(scene, 1.0);
        EXPECT_EQ(late.lights[0].direction, glm::vec3(0, 0, -1));
        EXPECT_EQ(late.cameras[0].forward, glm::vec3(0, 0, -1));
        EXPECT_EQ(late.cameras[0].right, glm::vec3(1, 0, 0));
        EXPECT_NO_THROW(validate(late));
        EXPECT_VEC_NEAR(posed_at(scene, 0.1).lights[0].direction, glm::dvec3(0, 0, -1), near);
    }
}

// 2^20 keys that the 40 samplers of a clip share: more numbers than the file has bytes. The first
// 31 have become curves when the budget ends.
TEST(GltfAnimation, HasABudgetOfNumbers) {
    GltfDraft draft = strip_draft();
    std::vector<float> times(std::size_t{1} << 20);
    for (std::size_t i = 0; i < times.size(); ++i) times[i] = static_cast<float>(i);
    const int input = test::scalars(draft, times);
    const int output = draft.accessor(-1, times.size(), "VEC3", test::float_type);
    json& clip = draft.document["animations"][0];
    for (int sampler = 1; sampler <= 40; ++sampler) {
        clip["samplers"].push_back({{"input", input}, {"output", output}});
        clip["channels"].push_back(
            {{"sampler", sampler}, {"target", {{"node", 2}, {"path", "scale"}}}});
    }
    EXPECT_EQ(left_out(draft), "animation is left out: it has more than 134217728 numbers");
}

}  // namespace
}  // namespace clgi
