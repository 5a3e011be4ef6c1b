// SPDX-License-Identifier: MIT
#include "scene/environment.hpp"

#include <cmath>
#include <numbers>

namespace clgi {

using std::numbers::pi;

Environment with_picture(Environment environment) {
    if (!environment.texels.empty()) return environment;
    environment.width = environment.height = 1;
    environment.texels.assign(1, glm::vec3(1.0f));
    return environment;
}

double texel_solid_angle(int width, int height, int row) {
    // cos a - cos b, without its cancellation near the poles.
    const double middle = pi * (row + 0.5) / height, half = 0.5 * pi / height;
    return 2.0 * std::sin(middle) * std::sin(half) * 2.0 * pi / width;
}

glm::dvec3 environment_direction(const Environment& environment, double u, double v) {
    const double across = (u - 0.5) * 2.0 * pi - double{environment.rotation}, down = v * pi;
    return {std::sin(down) * std::sin(across), std::cos(down), -std::sin(down) * std::cos(across)};
}

glm::dvec3 environment_fluence(const Environment& environment) {
    glm::dvec3 sum(0.0);
    const Environment whole = with_picture(environment);
    const glm::vec3* texel = whole.texels.data();
    for (int row = 0; row < whole.height; ++row) {
        glm::dvec3 of_row(0.0);
        for (int column = 0; column < whole.width; ++column) of_row += glm::dvec3(*texel++);
        sum += of_row * texel_solid_angle(whole.width, whole.height, row);
    }
    return sum * glm::dvec3(whole.factor);
}

}  // namespace clgi
