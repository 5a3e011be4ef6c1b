// Points of a bake beside its texels, in space: they look VPLs up and gather as texels do.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <cmath>
#include <string>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

namespace light_atlas {

void check_points(const std::vector<BakePoint>& points, const LightAtlasOptions& options) {
    if (!points.empty() && options.filling == Filling::project)
        throw Error("light-atlas: Filling::project has no points beside texels");
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3& at = points[i].position;
        const float length = glm::length(points[i].normal);
        if (!std::isfinite(at.x + at.y + at.z) || !(std::abs(length - 1.0f) < 1e-3f))
            throw Error("light-atlas: point " + std::to_string(i) +
                        " is not finite, or its normal has not the length 1");
    }
}

}  // namespace light_atlas

// Their places, and the way they face as both normals; nothing in the lanes between them and the
// texels.
void LightAtlasSolver::State::place_points() {
    static_assert(GBUFFER_POSITION == 0 && GBUFFER_NORMAL == 3 && GBUFFER_GEOMETRIC == 6);
    const std::size_t from = b.texel_count, lanes = b.texel_stride - from;
    std::vector<float> plane(lanes);
    for (int k = 0; k < GBUFFER_GEOMETRIC + 3; ++k) {
        for (std::size_t i = 0; i < bake_points.size(); ++i)
            plane[b.first_point - from + i] =
                k < GBUFFER_NORMAL ? scene.frame().to_local(bake_points[i].position)[k]
                                   : bake_points[i].normal[k % 3];
        const std::size_t row = std::size_t{b.texel_stride} * static_cast<std::size_t>(k);
        record.write(b.texels.planes, plane.data(), lanes * sizeof(float),
                     (row + from) * sizeof(float));
    }
}

}  // namespace clgi
