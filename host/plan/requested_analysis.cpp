// SPDX-License-Identifier: MIT
#include "plan/requested_analysis.hpp"

namespace clgi {

SceneAnalysis requested_analysis(SceneAnalysis analysis, const PlanRequest& request) {
    LightAnalysis& lights = analysis.lights;
    if (request.lights_change) {
        lights.points += lights.dark_points;
        lights.spots += lights.dark_spots;
        lights.directional += lights.dark_directional;
        analysis.proof.lights_open = false;
    }
    for (const Effect effect : request.without) switch (effect) {
            case Effect::point_light:
                lights.points = 0;
                break;
            case Effect::spot_light:
                lights.spots = 0;
                break;
            case Effect::directional_light:
                lights.directional = 0;
                break;
            case Effect::area_light:
                lights.emission = false;
                lights.emissive_triangles = 0;
                break;
            case Effect::environment_light:
                lights.environment = false;
                break;
            case Effect::gloss:
                analysis.surfaces.gloss = analysis.surfaces.glossy_area = 0.0;
                break;
            default:
                break;
        }
    if (lights.points + lights.spots + lights.directional == 0) lights.moving = false;
    return analysis;
}

}  // namespace clgi
