// save_glb keeps animation: what was saved loads again and is in the same place at all times.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>

#include "posing.hpp"

namespace clgi::test {
namespace {

// The corners of a triangle with their normals. Parts may change places in a file; a part is found
// again by its first appearance in the sorted list.
struct Soup {
    std::vector<std::array<glm::dvec3, 6>> triangles;
};

Soup soup_of(const Scene& scene) {
    Soup soup;
    for (const SceneTriangle& triangle : scene.triangles) {
        std::array<glm::dvec3, 6> one;
        for (std::size_t k = 0; k < 3; ++k) {
            one[k] = scene.positions[triangle.vertex[k]];
            one[3 + k] = glm::dvec3(scene.normals[triangle.vertex[k]]);
        }
        soup.triangles.push_back(one);
    }
    return soup;
}

// Which triangle of `after` each triangle of `before` is: those of parts that stand still come
// first in a file.
std::vector<std::size_t> order_in_file(const Scene& scene) {
    std::vector<bool> moves(scene.triangles.size());
    for (const PosedRange& range : scene.animation->ranges) {
        const Part& part = scene.parts[range.part];
        std::fill_n(moves.begin() + part.first_triangle, part.triangle_count, true);
    }
    std::vector<std::size_t> order;
    for (const bool moving : {false, true})
        for (std::size_t t = 0; t < moves.size(); ++t)
            if (moves[t] == moving) order.push_back(t);
    return order;
}

void expect_same(const Scene& before, const Scene& after, const std::vector<std::size_t>& order,
                 double near, const std::string& where) {
    ASSERT_EQ(before.triangles.size(), after.triangles.size()) << where;
    const Soup a = soup_of(before), b = soup_of(after);
    double worst = 0.0, worst_normal = 0.0;
    for (std::size_t t = 0; t < order.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto& from = a.triangles[order[t]];
            worst = std::max(worst, glm::length(from[k] - b.triangles[t][k]));
            // Normals of slivers turn with the last bit of a position.
            const double area = glm::length(glm::cross(from[1] - from[0], from[2] - from[0]));
            if (area > 1e-3 * near)
                worst_normal =
                    std::max(worst_normal, glm::length(from[3 + k] - b.triangles[t][3 + k]));
        }
    EXPECT_LE(worst, near) << where;
    EXPECT_LE(worst_normal, 1e-5) << where;
}

// The same poses before the first key, between keys and after the last.
void expect_kept(const Scene& before, const std::string& name) {
    const Scene after = reload(before);
    ASSERT_TRUE(after.animation) << name;
    const Animation &from = *before.animation, &to = *after.animation;
    ASSERT_EQ(from.clips.size(), to.clips.size()) << name;
    EXPECT_EQ(from.ranges.size(), to.ranges.size()) << name;
    EXPECT_EQ(from.skins.size(), to.skins.size()) << name;
    EXPECT_EQ(from.nodes.size(), to.nodes.size()) << name;
    EXPECT_EQ(before.positions.size(), after.positions.size()) << name;
    const std::vector<std::size_t> order = order_in_file(before);
    const Bounds box = bounds(before);
    // Positions are rounded once more where they stand still: half a unit of 2^-24.
    const double near = 2 * 0x1p-24 * glm::length(box.high - box.low);
    for (std::size_t clip = 0; clip < from.clips.size(); ++clip) {
        const double duration = from.clips[clip].duration;
        EXPECT_EQ(from.clips[clip].name, to.clips[clip].name) << name;
        EXPECT_EQ(duration, to.clips[clip].duration) << name;
        for (const double share : {-0.1, 0.0, 0.13, 0.5, 0.77, 1.0, 1.1}) {
            const std::string where =
                name + ", clip " + std::to_string(clip) + " at " + std::to_string(share * duration);
            expect_same(posed_at(before, share * duration, clip),
                        posed_at(after, share * duration, clip), order, near, where);
        }
    }
    expect_same(before, after, order, near, name + " at rest");
}

TEST(SaveGlbAnimation, KeepsASkinWithMorphTargets) { expect_kept(bent_strip(), "strip"); }

TEST(SaveGlbAnimation, KeepsASecondSetOfJoints) {
    GltfDraft draft = strip_draft();
    // Both sets name the joints; the second has the smaller shares.
    json& attributes = draft.document["meshes"][0]["primitives"][0]["attributes"];
    std::vector<float> shares(24, 0.0f);
    for (std::size_t v = 0; v < 6; ++v) shares[4 * v + 1] = 0.25f;
    attributes["JOINTS_1"] = attributes["JOINTS_0"];
    attributes["WEIGHTS_1"] = vec4s(draft, shares);
    const Scene scene = draft.load();
    ASSERT_GT(scene.animation->ranges[0].influence_count, 2u);
    expect_kept(scene, "two sets");
}

TEST(SaveGlbAnimation, KeepsFiveInfluencesOfAVertex) {
    Scene scene = bent_strip();
    Animation& animation = *scene.animation;
    PosedRange& range = animation.ranges[0];
    // Two joints, named in turn five times with shares that differ.
    range.influence_count = 5;
    animation.influences.clear();
    const float shares[5] = {0.4f, 0.05f, 0.1f, 0.25f, 0.2f};
    for (std::uint32_t i = 0; i < 5; ++i)
        for (std::uint32_t v = 0; v < range.vertex_count; ++v)
            animation.influences.push_back({(i + v) % 2, shares[i]});
    const Scene after = reload(scene);
    const std::vector<std::size_t> order = order_in_file(scene);
    for (const double time : {0.0, 0.4, 1.0})
        expect_same(posed_at(scene, time), posed_at(after, time), order, 1e-6, "five");
}

TEST(SaveGlbAnimation, KeepsEveryInterpolation) {
    for (const char* interpolation : {"STEP", "LINEAR", "CUBICSPLINE"}) {
        const bool cubic = std::string(interpolation) == "CUBICSPLINE";
        GltfDraft draft = triangle_draft({{"translation", {1.0, 2.0, 3.0}}});
        const int times = scalars(draft, {0.25f, 1.0f, 2.0f});
        Floats3 values = {{0, 0, 0}, {1, 0.5f, 0}, {-1, 2, 0.25f}};
        if (cubic)
            values = {{9, 9, 9}, {0, 0, 0},    {1, 2, 3},      {3, 2, 1}, {1, 0.5f, 0},
                      {0, 1, 0}, {1, 0, 0.5f}, {-1, 2, 0.25f}, {9, 9, 9}};
        animate(draft, 0, "translation", times, draft.vec3(values), interpolation);
        animate(draft, 0, "scale", times, draft.vec3(values), interpolation);
        const auto h = static_cast<float>(std::sqrt(0.5));
        std::vector<float> turns = {0, 0, 0, 1, 0, h, 0, h, h, 0, 0, h};
        if (cubic) {
            std::vector<float> keys;
            for (std::size_t key = 0; key < 3; ++key) {
                keys.insert(keys.end(), {0.1f, 0.2f, 0.0f, 0.3f});
                keys.insert(keys.end(), turns.begin() + 4 * key, turns.begin() + 4 * key + 4);
                keys.insert(keys.end(), {0.5f, 0.0f, 0.25f, 0.125f});
            }
            turns = keys;
        }
        animate(draft, 0, "rotation", times, vec4s(draft, turns), interpolation);
        expect_kept(draft.load(), interpolation);
    }
}

TEST(SaveGlbAnimation, KeepsMorphTargetsWithNormals) {
    GltfDraft draft;
    const json attributes = {{"POSITION", draft.vec3(one_triangle)},
                             {"NORMAL", draft.vec3(Floats3(3, {0, 0, 1}))}};
    const json lift = {{"POSITION", draft.vec3({{0, 0, 1}, {0, 0, 0}, {0, 0, 2}})},
                       {"NORMAL", draft.vec3({{0.5f, 0, 0}, {0, 0, 0}, {0, 0.25f, 0}})}};
    const json push = {{"POSITION", draft.vec3({{1, 0, 0}, {0, 3, 0}, {0, 0, 0}})}};
    draft.show({{"attributes", attributes}, {"targets", json::array({lift, push})}},
               {{"weights", {0.5, 0.25}}});
    animate(draft, 0, "weights", scalars(draft, {0, 1}), scalars(draft, {0, 1, 1, 0}));
    expect_kept(draft.load(), "morph");
}

TEST(SaveGlbAnimation, KeepsFlatNormalsAndMirrors) {
    GltfDraft draft = triangle_draft({{"scale", {-1.0, 2.0, 1.0}}, {"name", "mirror"}});
    animate(draft, 0, "translation", scalars(draft, {0, 1}), draft.vec3({{0, 0, 0}, {1, 2, 3}}));
    const Scene scene = draft.load();
    ASSERT_TRUE(scene.animation->ranges[0].flat);
    expect_kept(scene, "flat");
    const Scene after = reload(scene);
    EXPECT_TRUE(after.animation->ranges[0].flat);
    EXPECT_EQ(after.triangles[0].vertex[1], scene.triangles[0].vertex[1]);
    EXPECT_EQ(after.parts[0].name, "mirror");
}

TEST(SaveGlbAnimation, KeepsCopies) {
    GltfDraft draft = triangle_draft();
    const int places = draft.vec3({{0, 0, 0}, {5, 0, 0}, {0, 7, 0}});
    draft.document["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
    draft.document["nodes"][0]["extensions"] = {
        {"EXT_mesh_gpu_instancing", {{"attributes", {{"TRANSLATION", places}}}}}};
    animate(draft, 0, "translation", scalars(draft, {0, 1}), draft.vec3({{0, 0, 0}, {1, 2, 3}}));
    const Scene scene = draft.load();
    ASSERT_EQ(scene.animation->ranges.size(), 3u);
    const Scene after = reload(scene);
    ASSERT_EQ(after.animation->ranges.size(), 3u);
    const std::vector<std::size_t> order = {0, 1, 2};
    for (const double time : {0.0, 0.5, 1.0})
        expect_same(posed_at(scene, time), posed_at(after, time), order, 1e-6, "copies");
}

// A vertex that follows its own node by half, which no file says in these words.
TEST(SaveGlbAnimation, KeepsVerticesBetweenAJointAndTheirNode) {
    Scene scene = bent_strip();
    Animation& animation = *scene.animation;
    PosedRange& range = animation.ranges[0];
    animation.nodes[range.node].translation = {0.0, 0.5, 0.0};
    range.influence_count = 2;
    animation.influences.clear();
    for (std::uint32_t i = 0; i < 2; ++i)
        for (std::uint32_t v = 0; v < range.vertex_count; ++v)
            animation.influences.push_back({i == 0 ? 1u : 2u, 0.5f});
    const Scene after = reload(scene);
    const std::vector<std::size_t> order = order_in_file(scene);
    for (const double time : {0.0, 0.4, 1.0})
        expect_same(posed_at(scene, time), posed_at(after, time), order, 1e-6, "own node");
}

TEST(SaveGlbAnimation, KeepsLightsAndCamerasThatNodesCarry) {
    GltfDraft draft = triangle_draft();
    draft.document["extensionsUsed"] = {"KHR_lights_punctual"};
    draft.document["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "spot"}, {"name", "lamp"}, {"spot", json::object()}, {"intensity", 3.0}},
        {{"type", "point"}, {"name", "still"}}};
    draft.document["cameras"] = {{{"type", "perspective"},
                                  {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}},
                                  {"name", "eye"}}};
    draft.add("nodes", {{"children", {2}}, {"translation", {0.0, 1.0, 0.0}}});
    draft.add("nodes", {{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    draft.add("nodes", {{"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
    const auto h = static_cast<float>(std::sqrt(0.5));
    animate(draft, 1, "rotation", scalars(draft, {0, 1}), vec4s(draft, {0, 0, 0, 1, 0, h, 0, h}));
    const Scene before = draft.load(), after = reload(before);
    ASSERT_TRUE(after.animation);
    ASSERT_EQ(after.animation->lights.size(), 1u);
    ASSERT_EQ(after.animation->cameras.size(), 1u);
    ASSERT_EQ(after.lights.size(), 2u);
    for (const double time : {0.0, 0.3, 1.0}) {
        const Scene a = posed_at(before, time), b = posed_at(after, time);
        for (const Light& light : a.lights) {
            const auto same =
                std::find_if(b.lights.begin(), b.lights.end(),
                             [&](const Light& other) { return other.name == light.name; });
            ASSERT_NE(same, b.lights.end()) << light.name;
            EXPECT_VEC_NEAR(same->position, light.position, 1e-12);
            EXPECT_VEC_NEAR(same->direction, light.direction, 1e-6);
            EXPECT_EQ(same->kind, light.kind);
        }
        EXPECT_VEC_NEAR(a.cameras[0].forward, b.cameras[0].forward, 1e-6);
        EXPECT_VEC_NEAR(a.cameras[0].position, b.cameras[0].position, 1e-12);
    }
}

TEST(SaveGlbAnimation, SeveralLightsOfANodeAreKept) {
    GltfDraft draft = triangle_draft();
    animate(draft, 0, "translation", scalars(draft, {0, 1}), draft.vec3({{0, 0, 0}, {1, 2, 3}}));
    Scene scene = draft.load();
    for (std::uint32_t i = 0; i < 3; ++i) {
        Light light;
        light.name = std::to_string(i);
        scene.lights.push_back(light);
        scene.animation->lights.push_back({i, 0});
    }
    const Scene after = reload(scene);
    ASSERT_EQ(after.lights.size(), 3u);
    for (const Light& light : posed_at(after, 1.0).lights)
        EXPECT_VEC_NEAR(light.position, glm::dvec3(1, 2, 3), 1e-12);
}

TEST(SaveGlbAnimation, ClipsThatMoveNothingKeepTheirNumber) {
    Scene scene = bent_strip();
    scene.animation->clips.insert(scene.animation->clips.begin(),
                                  AnimationClip{"nothing", 0, {}, {}});
    const Scene after = reload(scene);
    ASSERT_EQ(after.animation->clips.size(), 2u);
    EXPECT_EQ(after.animation->clips[0].name, "nothing");
    expect_same(posed_at(scene, 0.5, 1), posed_at(after, 0.5, 1), {0, 1, 2, 3}, 1e-6, "clip 1");
    expect_same(scene, posed_at(after, 0.5, 0), {0, 1, 2, 3}, 1e-6, "clip 0");
}

// The format holds clips still by a key; where every node has a matrix, by one of a node more.
TEST(SaveGlbAnimation, ClipsKeepTheirNumberWhereEveryNodeHasAMatrix) {
    GltfDraft draft =
        triangle_draft({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1}}});
    draft.document["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", draft.vec3(Floats3(3, {0, 0, 1}))}}};
    draft.add("nodes", json::object());  // carries nothing
    const int times = scalars(draft, {0, 1});
    const int moves = draft.vec3({{0, 0, 0}, {1, 0, 0}});
    animate(draft, 1, "translation", times, moves);
    animate(draft, 0, "weights", times, scalars(draft, {0, 1}));
    animate(draft, 1, "translation", times, moves);
    for (std::size_t i = 0; i < 3; ++i)
        draft.document["animations"][i]["name"] = "clip " + std::to_string(i);
    const Scene before = draft.load(), after = reload(before);
    ASSERT_EQ(before.animation->nodes.size(), 1u);
    ASSERT_TRUE(before.animation->nodes[0].matrix);
    ASSERT_EQ(after.animation->clips.size(), 3u);
    EXPECT_EQ(after.animation->nodes.size(), 1u);
    for (std::size_t clip = 0; clip < 3; ++clip) {
        EXPECT_EQ(after.animation->clips[clip].name, "clip " + std::to_string(clip));
        EXPECT_VEC_NEAR(posed_at(after, 1.0, clip).positions[0],
                        glm::dvec3(2, 0, clip == 1 ? 1 : 0), 0.0);
    }
}

// Readers make quaternions unit; the format asks writers for it.
TEST(SaveGlbAnimation, RotationsAreWrittenUnit) {
    for (const char* interpolation : {"STEP", "LINEAR"}) {
        GltfDraft draft = triangle_draft({{"rotation", {0, 0, 3, 4}}});
        draft.document["nodes"][0]["children"] = {1};
        draft.add("nodes", {{"mesh", 0}, {"rotation", {0, 0, 0, 0}}});  // turns nothing
        animate(draft, 0, "rotation", scalars(draft, {0, 1, 2}),
                vec4s(draft, {0, 0, 3, 4, 0, 0.5f, 0, 0, 0, 0, 0, 0}), interpolation);
        animate(draft, 0, "translation", scalars(draft, {0, 1}),
                draft.vec3({{0, 0, 0}, {0, 0, 7}}));
        const Scene scene = draft.load();
        expect_kept(scene, interpolation);
        const Scene after = reload(scene);
        const std::vector<AnimatedNode>& nodes = after.animation->nodes;
        ASSERT_EQ(nodes.size(), 2u);
        EXPECT_NEAR(nodes[0].rotation.z, 0.6, 1e-12);
        EXPECT_NEAR(nodes[0].rotation.w, 0.8, 1e-12);
        EXPECT_EQ(nodes[1].rotation, glm::dquat(1, 0, 0, 0));
        const std::vector<float> unit = {0, 0, 0.6f, 0.8f, 0, 1, 0, 0, 0, 0, 0, 1};
        EXPECT_EQ(after.animation->clips[0].curves[0].values, unit);
        const std::vector<float> places = {0, 0, 0, 0, 0, 7};
        EXPECT_EQ(after.animation->clips[1].curves[0].values, places);
    }
}

TEST(SaveGlbAnimation, RefusesTrianglesThatShareMovingVertices) {
    Scene scene = bent_strip();
    scene.triangles.push_back(scene.triangles[0]);  // of no part
    const TempFolder folder;
    try {
        io::save_glb(scene, folder.path() / "refused.glb");
        FAIL() << "was written";
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("triangle 4 names vertex"), std::string::npos)
            << error.what();
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path() / "refused.glb"));
}

TEST(SaveGlbAnimation, RefusesAMatrixThatIsNotAffine) {
    Scene scene = bent_strip();
    scene.animation->nodes[0].matrix = glm::dmat4(2.0);
    EXPECT_THROW(reload(scene), InputError);
}

TEST(SaveGlbAnimation, CollectedFilesSurviveIt) {
    const std::filesystem::path scenes = CLGI_SCENES_DIR;
    if (!std::filesystem::exists(scenes)) GTEST_SKIP() << "no scenes at " << scenes;
    for (const char* file :
         {"animated/AnimatedMorphCube/AnimatedMorphCube.gltf",
          "animated/AnimatedMorphSphere/AnimatedMorphSphere.gltf",
          "animated/BoxAnimated/BoxAnimated.gltf", "animated/CesiumMan.glb", "animated/Fox.glb",
          "animated/InterpolationTest/InterpolationTest.gltf", "animated/Lumberjack.glb",
          "animated/MorphStressTest.gltf", "animated/RiggedSimple/RiggedSimple.gltf",
          "animated/SimpleMorph/SimpleMorph.gltf", "bunny/bunny-skinned.glb",
          "odd-valid/CesiumMan-weights-not-normalised/CesiumMan.gltf",
          "odd-valid/RiggedFigure-weights-not-normalised/RiggedFigure.gltf",
          "odd-valid/asset-generator/Animation_Skin/Animation_Skin_01.gltf",
          "odd-valid/asset-generator/Animation_Skin/Animation_Skin_05.gltf",
          "odd-valid/asset-generator/Animation_Skin/Animation_Skin_08.gltf",
          "odd-valid/asset-generator/Animation_Skin/Animation_Skin_10.gltf",
          "odd-valid/misc/singleBlendshapeCube_sparse.glb"}) {
        const Scene scene = io::load_gltf(scenes / file);
        ASSERT_TRUE(scene.animation) << file;
        expect_kept(scene, file);
    }
}

}  // namespace
}  // namespace clgi::test
