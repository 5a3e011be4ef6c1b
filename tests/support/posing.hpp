// Small animated scenes whose poses are known in closed form.
// SPDX-License-Identifier: MIT
#pragma once

#include "gltf_draft.hpp"

namespace clgi::test {

inline int scalars(GltfDraft& draft, const std::vector<float>& values) {
    return draft.accessor(draft.view(values), values.size(), "SCALAR", float_type);
}
inline int vec4s(GltfDraft& draft, const std::vector<float>& values) {
    return draft.accessor(draft.view(values), values.size() / 4, "VEC4", float_type);
}

// Adds a clip of one channel; returns its index.
inline int animate(GltfDraft& draft, int node, const char* path, int input, int output,
                   const char* interpolation = "LINEAR") {
    const json sampler = {{"input", input}, {"output", output}, {"interpolation", interpolation}};
    const json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}};
    return draft.add("animations",
                     {{"samplers", json::array({sampler})}, {"channels", json::array({channel})}});
}

// A strip along x of three pairs of vertices at x = 0, 1 and 2, z = 0 and -1, seen from above. It
// follows a root joint at 0, the last pair a second joint at x = 1, the pair between both by half.
// One morph target lifts the vertices at z = -1 by 1. The clip turns the second joint about z by a
// quarter from 0 s to 1 s.
inline GltfDraft strip_draft(const char* joints = "JOINTS_0", const char* weights = "WEIGHTS_0",
                             const std::vector<float>& shares = {
                                 1,    0,    0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0,
                                 0.5f, 0.5f, 0, 0, 0, 1, 0, 0, 0,    1,    0, 0}) {
    GltfDraft draft;
    json attributes = {
        {"POSITION",
         draft.vec3({{0, 0, 0}, {0, 0, -1}, {1, 0, 0}, {1, 0, -1}, {2, 0, 0}, {2, 0, -1}})},
        {"NORMAL", draft.vec3(Floats3(6, {0, 1, 0}))},
        {weights, vec4s(draft, shares)}};
    std::vector<std::uint8_t> named(24, 0);
    for (std::size_t v = 0; v < 6; ++v) named[4 * v + 1] = 1;
    attributes[joints] = draft.accessor(draft.view(named), 6, "VEC4", uint8_type);
    const json target = {
        {"POSITION",
         draft.vec3({{0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 1, 0}})}};
    draft.show({{"attributes", attributes},
                {"indices", draft.indices({0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5})},
                {"targets", json::array({target})}},
               {{"skin", 0}});
    draft.add("nodes", {{"children", {2}}});                 // 1: root joint
    draft.add("nodes", {{"translation", {1.0, 0.0, 0.0}}});  // 2: the second
    std::vector<float> binds(32, 0.0f);
    for (int m = 0; m < 2; ++m)
        for (int i = 0; i < 4; ++i) binds[static_cast<std::size_t>(16 * m + 5 * i)] = 1.0f;
    binds[16 + 12] = -1.0f;
    draft.add("skins",
              {{"joints", {1, 2}},
               {"inverseBindMatrices", draft.accessor(draft.view(binds), 2, "MAT4", float_type)}});
    const auto h = static_cast<float>(std::sqrt(0.5));
    animate(draft, 2, "rotation", scalars(draft, {0, 1}), vec4s(draft, {0, 0, 0, 1, 0, 0, h, h}));
    return draft;
}

inline Scene bent_strip() { return strip_draft().load(); }

inline Scene posed_at(const Scene& scene, double time, std::size_t clip = 0) {
    return posed(scene, pose_at(*scene.animation, clip, time));
}

}  // namespace clgi::test
