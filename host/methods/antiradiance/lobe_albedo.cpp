// The albedo of the normalised modified Phong lobe (docs/materials.md).
//
// Around the mirrored direction the lobe's density is (n + 1) / (2 pi) cos^n a. It reflects what of
// this lies above the surface, each direction by (n + 2) / (n + 1) times its cosine with the
// normal: turned about the mirrored direction this cosine is A + B cos phi, A = cos a cos t, B =
// sin a sin t, and the mean of its positive part has a closed form. What is left is an integral
// over u = cos^(n + 1) a, from 0 to 1. [derived]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/passes/antiradiance_gloss.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clgi {
namespace {

constexpr int parts = 512;  // of u: an error below 1e-5

double albedo(double exponent, double cosine) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine));
    double sum = 0.0;
    for (int i = 0; i < parts; ++i) {
        const double a = std::pow((i + 0.5) / parts, 1.0 / (exponent + 1.0));
        const double level = a * cosine;
        const double swing = std::sqrt(std::max(0.0, 1.0 - a * a)) * sine;
        if (level >= swing) {
            sum += level;
            continue;
        }
        const double half = std::acos(-level / swing);  // of the turn that lies above
        sum += (half * level + swing * std::sin(half)) / glm::pi<double>();
    }
    return (exponent + 2.0) / (exponent + 1.0) * sum / parts;
}

}  // namespace

std::vector<float> lobe_albedos(double exponent) {
    if (!(exponent >= 0.0) || !std::isfinite(exponent))
        throw Error("lobe_albedos: exponent is " + std::to_string(exponent) +
                    ", at least 0 and finite needed");
    std::vector<float> out;
    for (int k = 0; k <= ALBEDO_STEPS; ++k) {
        const double at = double(k) / double(ALBEDO_STEPS);
        out.push_back(static_cast<float>(std::min(1.0, albedo(exponent, at * at))));
    }
    return out;
}

}  // namespace clgi
