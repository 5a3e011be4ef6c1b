// The smooth environment that a sweep of dynamic transfer compares with.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "lab/sweep_transfer.hpp"

namespace clgi::lab {

std::vector<glm::dvec3> smoothed_light(std::vector<glm::dvec3> coefficients) {
    double smoothing = 0.0;
    for (int c = 0; c < 3; ++c) {
        std::vector<double> channel;
        for (const glm::dvec3& value : coefficients) channel.push_back(value[c]);
        if (channel.front() > 0.0)
            smoothing = std::max(smoothing, sh::least_smoothing(channel, 0.0));
    }
    const int bands = sh::bands_of(coefficients.size());
    return sh::convolve(sh::smoothing_window(smoothing, bands), std::move(coefficients));
}

// Radiance is constant over a texel, so the picture lacks some of the highest bands: with 256
// texels a turn, 5e-4 of the fifth.
Environment picture_of_light(const std::vector<glm::dvec3>& coefficients, int width) {
    constexpr double pi = std::numbers::pi;
    const int bands = sh::bands_of(coefficients.size());
    Environment out;
    out.width = width;
    out.height = width / 2;
    for (int row = 0; row < out.height; ++row)
        for (int column = 0; column < out.width; ++column) {
            const double down = pi * (row + 0.5) / out.height;
            const double across = 2 * pi * (column + 0.5) / out.width - pi;
            const std::vector<double> y =
                sh::evaluate(glm::dvec3(std::sin(down) * std::sin(across), std::cos(down),
                                        -std::sin(down) * std::cos(across)),
                             bands);
            glm::dvec3 sum(0.0);
            for (std::size_t i = 0; i < y.size(); ++i) sum += y[i] * coefficients[i];
            // Between the directions that least_smoothing looks at, rounding may be left.
            out.texels.emplace_back(glm::max(sum, glm::dvec3(0.0)));
        }
    return out;
}

bool sees_sky(const glm::dvec3& irradiance, const std::vector<glm::dvec3>& light,
              const glm::vec3& normal) {
    constexpr double least = 0.01;
    const glm::dvec3 open = sh::irradiance(light, glm::dvec3(normal));
    return irradiance.x + irradiance.y + irradiance.z > least * (open.x + open.y + open.z);
}

}  // namespace clgi::lab
