// SPDX-License-Identifier: MIT
#include "plan/presets.hpp"

#include <algorithm>

#include "plan/openness.hpp"
#include "plan/sky.hpp"

namespace clgi {
namespace {

constexpr std::size_t many_triangles = 10000;
// A probe has one bounce; with the others, indirect light was so many times as much. Of what
// nothing shadows in the probe, no more is there.
constexpr double all_bounces = 1.5, most_share = 2.0;

// Of what the picture reaches; of the whole scene, where that is not known.
double open_share(const Plan& plan) {
    return plan.reach && plan.reach->points > 0 ? plan.reach->open : plan.analysis.openness;
}

}  // namespace

bool is_fine(const Plan& plan) { return plan.analysis.surfaces.triangles > many_triangles; }

double indirect_share(const Plan& plan) {
    return plan.probe ? std::min(all_bounces * plan.probe->first_bounce, most_share) : 1.0;
}

SceneKind kind_of(const Plan& plan) {
    const bool fine = is_fine(plan);
    if (plan.method == Method::irradiance_cache && has_sky(plan))
        return fine && !sees_little(plan) ? SceneKind::fine_sky : SceneKind::skylit;
    if (!plan.on(Effect::indirect_occlusion)) return SceneKind::convex;
    if (sees_little(plan)) return SceneKind::furnished;  // what is open lies elsewhere
    if (plan.probe && indirect_share(plan) > 1.0) return SceneKind::indirect;
    if (open_share(plan) > much_open) return SceneKind::open;
    if (fine) return SceneKind::fine;
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
        case SceneKind::open:
            return "open";
        case SceneKind::indirect:
            return "indirectly lit";
        case SceneKind::skylit:
            return "skylit";
        case SceneKind::fine_sky:
            return "finely modelled, skylit";
    }
    return "";
}

const std::vector<Preset>& presets() {
    // Of pictures of 160x120 against the path tracer's indirect light, the largest of the scenes of
    // a kind (docs/plan.md), and no less than that of finer settings. Convex: two empty rooms.
    // Furnished: Cornell box, a furnished room, the corridor. Finely modelled: box with the bunny;
    // Sponza under its sun errs by some four times as much (docs/results/irradiance-cache.md).
    // Open: a yard, the office, oriental-like. Lit indirectly: the dark one of two chambers, the
    // maze; of the irradiance cache the maze and drawn slits. Skylit: drawn windows and courtyards;
    // finely modelled: Sponza, by four samples. Between measured settings of the cache some of
    // its errors are interpolated (docs/results/irradiance-cache.md). Its furnished and open scenes
    // have three quarters, its skylit ones 0.8, of errors that were measured so before light was
    // carried on between records, which took 30 to 45 % off them.
    static const std::vector<Preset> out = {
        {Method::direct, 0, 0, {0, 0, 0, 0, 0}},
        {Method::second_order, 0, 300, {0.741, 0.611, 0.791, 0.533, 0.729}},
        {Method::second_order, 0, 1000, {0.733, 0.611, 0.73, 0.488, 0.65}},
        {Method::antiradiance, 64, 500, {0.0854, 0.134, 0.351, 1.05, 0.493}},
        {Method::antiradiance, 64, 1000, {0.0879, 0.122, 0.332, 0.936, 0.424}},
        {Method::antiradiance, 128, 2000, {0.0499, 0.086, 0.279, 0.83, 0.299}},
        {Method::antiradiance, 64, 8192, {0, 0, 0.2, 0, 0}},
        {Method::antiradiance, 128, 8192, {0.0575, 0.0629, 0.183, 0.552, 0.121}},
        {Method::antiradiance, 128, 16384, {0, 0, 0.148, 0, 0}},
        {Method::antiradiance, 128, 32768, {0, 0, 0.12, 0, 0}},
        {Method::antiradiance, 208, 16384, {0.0433, 0.0484, 0.142, 0.544, 0.0964}},
        {Method::antiradiance, 512, 16384, {0.0203, 0.0417, 0, 0.541, 0.0623}},
        {Method::light_atlas, 128, 100, {0.0235, 0.207, 0, 0, 0.217}},
        {Method::light_atlas, 128, 400, {0.0144, 0.0754, 0, 0, 0.0704}},
        {Method::light_atlas, 256, 100, {0.0229, 0.208, 0, 0.523, 0.218}},
        {Method::light_atlas, 256, 400, {0.0101, 0.0681, 0, 0.487, 0.0689}},
        {Method::light_atlas, 256, 1600, {0.00532, 0.0394, 0, 0.49, 0.033}},
        {Method::light_atlas, 512, 100, {0.0212, 0.21, 0.405, 0.378, 0.221}},
        {Method::light_atlas, 512, 400, {0.0109, 0.0677, 0.294, 0.353, 0.0711}},
        {Method::light_atlas, 512, 1600, {0.00548, 0.0362, 0.161, 0.3, 0.0369}},
        {Method::light_atlas, 512, 6400, {0.00379, 0.0153, 0.134, 0.253, 0.0242}},
        {Method::dynamic_transfer, 0, 0, {0, 0, 0.05, 0.05, 0}},
        {Method::irradiance_cache, 8, 66, {0, 0, 0.175, 0, 0, 0, 0.38}},
        {Method::irradiance_cache, 8, 100, {0, 0, 0.153, 0, 0, 0, 0.33}},
        {Method::irradiance_cache, 8, 150, {0, 0, 0.139, 0, 0, 0, 0.285}},
        {Method::irradiance_cache, 8, 200, {0, 0, 0.111, 0, 0, 0, 0.25}},
        {Method::irradiance_cache, 8, 300, {0, 0, 0.102, 0, 0, 0, 0.23}},
        {Method::irradiance_cache, 8, 400, {0, 0, 0.083, 0, 0, 0, 0.22}},
        {Method::irradiance_cache, 8, 600, {0, 0, 0, 0, 0, 0, 0.2}},
        {Method::irradiance_cache, 8, 1000, {0, 0, 0, 0, 0, 0, 0.185}},
        {Method::irradiance_cache, 16, 100, {0.03, 0.09, 0.152, 0.18, 0.3, 0.08, 0.31}},
        {Method::irradiance_cache, 16, 200, {0.03, 0.06, 0.106, 0.12, 0.16, 0.056, 0.24}},
        {Method::irradiance_cache, 16, 300, {0, 0, 0.097, 0, 0, 0, 0.22}},
        {Method::irradiance_cache, 16, 400, {0, 0, 0.08, 0, 0, 0, 0.2}},
        {Method::irradiance_cache, 16, 600, {0, 0, 0.06, 0, 0, 0, 0.18}},
        {Method::irradiance_cache, 16, 1000, {0, 0, 0.05, 0, 0, 0, 0.16}},
        {Method::irradiance_cache, 24, 200, {0.03, 0.057, 0.106, 0.11, 0.16, 0.05, 0}},
        {Method::irradiance_cache, 24, 300, {0.03, 0.053, 0.092, 0.1, 0.16, 0.048, 0}},
        {Method::irradiance_cache, 32, 300, {0.03, 0.049, 0.091, 0.09, 0.16, 0.044, 0}},
        {Method::irradiance_cache, 32, 400, {0.03, 0.045, 0.08, 0.076, 0.156, 0.04, 0}},
        {Method::irradiance_cache, 32, 600, {0.03, 0.039, 0.06, 0.068, 0.134, 0.032, 0}},
        {Method::irradiance_cache, 32, 1000, {0.03, 0.034, 0.05, 0.06, 0.075, 0.026, 0}},
        {Method::irradiance_cache, 48, 1000, {0.03, 0.032, 0.049, 0.056, 0.075, 0.025, 0}},
    };
    return out;
}

}  // namespace clgi
