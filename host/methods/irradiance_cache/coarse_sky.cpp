// SPDX-License-Identifier: MIT
#include "methods/irradiance_cache/coarse_sky.hpp"

#include <algorithm>
#include <cstdint>

#include "scene/environment.hpp"

namespace clgi {
void CoarseSky::add(const CoarseSky& part) {
    parts += part.parts;
    texels.insert(texels.end(), part.texels.begin(), part.texels.end());
}

CoarseSky coarse_sky(const std::optional<Environment>& environment, int columns) {
    CoarseSky out;
    if (!environment) return out;
    const Environment picture = with_picture(*environment);
    out.width = std::min(picture.width, columns);
    out.height = std::min(picture.height, columns / 2);
    std::vector<glm::dvec4> sums(static_cast<std::size_t>(out.width) * out.height, glm::dvec4(0.0));
    for (int y = 0; y < picture.height; ++y) {
        const double weight = texel_solid_angle(picture.width, picture.height, y);
        for (int x = 0; x < picture.width; ++x) {
            const int column = static_cast<int>(std::int64_t{x} * out.width / picture.width);
            const int row = static_cast<int>(std::int64_t{y} * out.height / picture.height);
            const glm::dvec3 texel(picture.texels[static_cast<std::size_t>(y) * picture.width + x]);
            sums[static_cast<std::size_t>(row) * out.width + column] +=
                weight * glm::dvec4(texel, 1.0);
        }
    }
    for (const glm::dvec4& sum : sums)
        for (int c = 0; c < 3; ++c) out.texels.push_back(static_cast<float>(sum[c] / sum.w));
    return out;
}

}  // namespace clgi
