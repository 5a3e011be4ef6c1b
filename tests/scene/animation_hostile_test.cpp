// Animations made to cost far more than their file: they must end quickly, in bounded memory.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "posing.hpp"
#include "time_limit.hpp"

namespace clgi::test {
namespace {

using AnimationHostile = TimeLimit<5>;

int keys(GltfDraft& draft, std::size_t count) {
    std::vector<float> times(count);
    for (std::size_t i = 0; i < count; ++i) times[i] = static_cast<float>(i);
    return scalars(draft, times);
}

bool says(const Scene& scene, const std::string& text) {
    return std::any_of(scene.warnings.begin(), scene.warnings.end(),
                       [&](const std::string& line) { return line.find(text) == 0; });
}

// Every range has a matrix for each joint of its skin: 80 times 2^17 of them.
TEST_F(AnimationHostile, JointsOfManyRangesAreBounded) {
    GltfDraft draft = strip_draft();
    json& mesh = draft.document["meshes"][0];
    mesh["primitives"] = std::vector<json>(80, mesh["primitives"][0]);
    draft.document["skins"][0] = {{"joints", std::vector<int>(std::size_t{1} << 17, 2)}};
    const Scene scene = draft.load();
    EXPECT_FALSE(scene.animation);
    EXPECT_TRUE(says(scene, "animation is left out: it has more than 134217728 numbers"));
    EXPECT_EQ(scene.triangles.size(), 320u);
}

// A step of the clip computes all nodes: 40,000 of them at 10,000 keys.
TEST_F(AnimationHostile, ALongChainWithManyKeysHasBounds) {
    GltfDraft draft = triangle_draft();
    for (int i = 0; i < 40'000; ++i) draft.add("nodes", {{"children", {i}}});
    animate(draft, 40'000, "translation", keys(draft, 10'000),
            draft.accessor(-1, 10'000, "VEC3", float_type), "STEP");
    const Bounds found = *motion_bounds(draft.load(), 0);
    EXPECT_GE(found.high.x, 1.0);
    EXPECT_LE(found.high.x, 1.1);
}

// A step also looks up every channel; here 20,000 drive the same node.
TEST_F(AnimationHostile, ManyChannelsWithManyKeysHaveBounds) {
    GltfDraft draft = triangle_draft();
    const json sampler = {{"input", keys(draft, 10'000)},
                          {"output", draft.accessor(-1, 10'000, "VEC3", float_type)}};
    const json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
    draft.add("animations", {{"samplers", json::array({sampler})},
                             {"channels", std::vector<json>(20'000, channel)}});
    EXPECT_GE(motion_bounds(draft.load(), 0)->high.x, 1.0);
}

// 1,000 channels share one curve of 200,000 keys.
TEST_F(AnimationHostile, ChannelsThatShareACurveWalkItOnce) {
    GltfDraft draft = triangle_draft();
    const json sampler = {{"input", keys(draft, 200'000)},
                          {"output", draft.accessor(-1, 200'000, "VEC3", float_type)}};
    const json channel = {{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}};
    draft.add("animations", {{"samplers", json::array({sampler})},
                             {"channels", std::vector<json>(1'000, channel)}});
    EXPECT_GE(motion_bounds(draft.load(), 0)->high.x, 1.0);
}

// 60,000 vertices with 10,000 sets of joints, which are two accessors without bytes.
TEST_F(AnimationHostile, SetsOfJointsAreBounded) {
    constexpr std::size_t vertices = 60'000;
    GltfDraft draft;
    json attributes = {{"POSITION", draft.accessor(-1, vertices, "VEC3", float_type)}};
    const int joints = draft.accessor(-1, vertices, "VEC4", uint8_type);
    const int weights = draft.accessor(-1, vertices, "VEC4", float_type);
    for (int set = 0; set < 10'000; ++set) {
        attributes["JOINTS_" + std::to_string(set)] = joints;
        attributes["WEIGHTS_" + std::to_string(set)] = weights;
    }
    std::vector<std::uint16_t> corners(vertices);
    for (std::size_t i = 0; i < vertices; ++i) corners[i] = static_cast<std::uint16_t>(i);
    draft.show({{"attributes", attributes}, {"indices", draft.indices(corners)}}, {{"skin", 0}});
    draft.add("skins", {{"joints", {0}}});
    EXPECT_NE(refusal(draft).find("too many sets of joints"), std::string::npos);
}

}  // namespace
}  // namespace clgi::test
