// SPDX-License-Identifier: MIT
#include "plan/rungs.hpp"

namespace clgi {
namespace {

constexpr std::size_t many_triangles = 20000;
constexpr double much_leaves = 0.3;

}  // namespace

SceneKind kind_of(const Plan& plan) {
    const SceneFacts& facts = plan.facts;
    if (!plan.on(Effect::indirect_occlusion)) return SceneKind::convex;
    if (facts.openness > much_leaves) return SceneKind::outdoors;
    if (facts.surfaces.triangles > many_triangles) return SceneKind::fine;
    return SceneKind::furnished;
}

const char* name_of(SceneKind kind) {
    switch (kind) {
        case SceneKind::convex:
            return "convex";
        case SceneKind::furnished:
            return "furnished";
        case SceneKind::fine:
            return "finely modelled";
        case SceneKind::outdoors:
            return "open";
    }
    return "";
}

const std::vector<Rung>& rungs() {
    // Of pictures of 160x120 against a path tracer, the largest of the scenes of a kind
    // (docs/effects.md). Convex: two empty rooms. Furnished: Cornell box, a furnished room, two
    // chambers, the corridor. Finely modelled: box with the bunny. Open: the office, of which 25 %
    // are edges of direct shadows that no setting here mends.
    static const std::vector<Rung> out = {
        {Method::direct, 0, 0, {0, 0, 0, 0}},
        {Method::second_order, 0, 300, {0.69, 0.79, 0.21, 0.46}},
        {Method::second_order, 0, 1000, {0.68, 0.79, 0.194, 0.46}},
        {Method::antiradiance, 64, 500, {0.091, 0.097, 0.067, 0.31}},
        {Method::antiradiance, 64, 1000, {0.093, 0.097, 0.066, 0.304}},
        {Method::antiradiance, 128, 2000, {0.056, 0.061, 0.06, 0.285}},
        {Method::antiradiance, 128, 8192, {0.065, 0.059, 0.059, 0.267}},
        {Method::antiradiance, 208, 16384, {0.049, 0.049, 0, 0}},
        {Method::antiradiance, 512, 16384, {0.028, 0.043, 0, 0}},
        {Method::light_atlas, 128, 100, {0.04, 0.114, 0, 0}},
        {Method::light_atlas, 128, 400, {0.035, 0.058, 0, 0}},
        {Method::light_atlas, 256, 100, {0.04, 0.114, 0, 0.278}},
        {Method::light_atlas, 256, 400, {0.034, 0.048, 0, 0.26}},
        {Method::light_atlas, 256, 1600, {0.033, 0.047, 0, 0.254}},
        {Method::light_atlas, 512, 100, {0.04, 0.114, 0.108, 0}},
        {Method::light_atlas, 512, 400, {0.034, 0.048, 0.087, 0}},
        {Method::light_atlas, 512, 1600, {0.033, 0.045, 0.065, 0.252}},
        {Method::light_atlas, 512, 6400, {0.032, 0.037, 0.061, 0}},
        {Method::dynamic_transfer, 0, 0, {0, 0, 0.05, 0.05}},
    };
    return out;
}

}  // namespace clgi
