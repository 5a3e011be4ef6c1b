// SPDX-License-Identifier: MIT
#include "methods/antiradiance/sky.hpp"

#include <algorithm>

#include "scene/environment.hpp"

namespace clgi {

std::vector<glm::dvec3> sky_row(const std::optional<Environment>& environment,
                                const DirectionBins& bins) {
    std::vector<glm::dvec3> sums(bins.directions.size(), glm::dvec3(0.0));
    if (!environment) return sums;
    const Environment picture = with_picture(*environment);
    // Places at which texels are looked up: enough that each bin gets some.
    const int repeat = std::max(1, 256 / std::min(picture.width, 2 * picture.height));
    std::vector<double> weights(sums.size(), 0.0);
    for (int y = 0; y < picture.height * repeat; ++y) {
        const int row = y / repeat;
        const double weight = texel_solid_angle(picture.width * repeat, picture.height * repeat, y);
        for (int x = 0; x < picture.width * repeat; ++x) {
            const glm::dvec3 from =
                environment_direction(picture, (x + 0.5) / (picture.width * repeat),
                                      (y + 0.5) / (picture.height * repeat));
            const auto bin = static_cast<std::size_t>(bins.nearest(-from));
            const auto texel = static_cast<std::size_t>(row) * picture.width + x / repeat;
            sums[bin] += weight * glm::dvec3(picture.texels[texel]);
            weights[bin] += weight;
        }
    }
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (weights[i] > 0.0) sums[i] *= glm::dvec3(picture.factor) / weights[i];
    return sums;
}

}  // namespace clgi
