// SPDX-License-Identifier: MIT
#include "scene/sky_parts.hpp"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "scene/environment.hpp"
#include "scene/luminance.hpp"

namespace clgi {
namespace {

constexpr double brightest = 16.0;  // of the soft part, times the mean of the sphere
constexpr double least = 0.005;     // of all light, which bright parts must have

}  // namespace

SkyParts sky_parts(const Environment& environment) {
    SkyParts out{with_picture(environment), {}, {}};
    const int width = out.soft.width, height = out.soft.height;
    const auto columns = static_cast<std::size_t>(width);
    const auto level = [&](const glm::vec3& texel) {
        return luminance(glm::dvec3(texel) * glm::dvec3(environment.factor));
    };
    const auto sum = [&](const auto& of) {
        double all = 0.0;
        for (int row = 0; row < height; ++row) {
            double of_row = 0.0;
            const glm::vec3* texel = &out.soft.texels[static_cast<std::size_t>(row) * columns];
            for (int column = 0; column < width; ++column) of_row += of(level(*texel++));
            all += of_row * texel_solid_angle(width, height, row);
        }
        return all;
    };
    const double all = sum([](double l) { return l; });
    const double limit = brightest * all / (4.0 * std::numbers::pi);
    const auto beyond = [&](double l) { return std::max(l - limit, 0.0); };
    const double light = sum(beyond);
    if (!(light > least * all)) return out;
    out.bright = out.soft;
    for (std::size_t i = 0; i < out.soft.texels.size(); ++i) {
        const double here = level(out.soft.texels[i]);
        const auto share = static_cast<float>(here > limit ? limit / here : 1.0);
        out.bright.texels[i] *= 1.0f - share;
        out.soft.texels[i] *= share;
    }
    // An even disc of half angle a has a mean direction of length (1 + cos a) / 2, and
    // 2 pi (1 - cos a) steradians.
    glm::dvec3 toward(0.0);
    for (int row = 0; row < height; ++row) {
        glm::dvec3 of_row(0.0);
        for (int column = 0; column < width; ++column) {
            const auto at =
                static_cast<std::size_t>(row) * columns + static_cast<std::size_t>(column);
            const double here = level(out.bright.texels[at]);
            if (here > 0.0)
                of_row += here * environment_direction(out.bright, (column + 0.5) / width,
                                                       (row + 0.5) / height);
        }
        toward += of_row * texel_solid_angle(width, height, row);
    }
    out.found = {light / all, 4.0 * std::numbers::pi * (1.0 - glm::length(toward) / light)};
    return out;
}

}  // namespace clgi
