// What GGX reflects of the light that meets it in one direction, as a share of the mean over all
// directions: by that the lobes between bins are scaled, whatever the bins make of their shape.
//
// Over half vectors by D's own measure, tan^2 = alpha^2 u / (1 - u), the integral of D V over light
// that leaves the surface has V (n.l) 4 (v.h) / (n.h) left to sum.             [Walter07; derived]
// SPDX-License-Identifier: MIT
#include <clgi/shared/microfacet.h>
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/passes/antiradiance_gloss.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>

namespace clgi {
namespace {

constexpr int rings = 96, turns = 48;  // of half vectors: an error below 0.002
constexpr double least_cosine = 1e-3;  // of a viewer on the horizon

double albedo(double alpha, double cosine) {
    const double sine = std::sqrt(std::max(0.0, 1.0 - cosine * cosine)), square = alpha * alpha;
    const auto mask = [&](double c) {
        return 1.0 / (c + std::sqrt(square + (1.0 - square) * c * c));
    };
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        // 1 - u is the cube of even steps: viewers near the horizon see the steepest.
        const double step = 1.0 - (i + 0.5) / rings, rest = step * step * step;
        const double tangent = alpha * std::sqrt((1.0 - rest) / rest);
        const double up = 1.0 / std::sqrt(1.0 + tangent * tangent), flat = tangent * up;
        for (int j = 0; j < turns; ++j) {
            const double turn = glm::pi<double>() * (j + 0.5) / turns;  // the other half is equal
            const double half = sine * flat * std::cos(turn) + cosine * up;
            const double light = 2.0 * half * up - cosine;
            if (half > 0.0 && light > 0.0)
                sum += 3.0 * step * step * mask(light) * light * 4.0 * half / up;
        }
    }
    return sum * mask(cosine) / (rings * turns);
}

}  // namespace

std::vector<float> lobe_albedos(double alpha) {
    if (!(alpha >= double{MICROFACET_LEAST_ALPHA} && alpha <= 1.0))
        throw Error("lobe_albedos: alpha is " + std::to_string(alpha) + ", outside 0.01..1");
    std::vector<double> curve;
    double mean = 0.0, sum = 0.0;
    for (int k = 0; k <= ALBEDO_STEPS; ++k) {
        const double at = double(k) / double(ALBEDO_STEPS);
        curve.push_back(albedo(alpha, std::max(at * at, least_cosine)));
        // Steps are even in the root of the cosine c: 2 c dc = 4 at^3 d(at).
        const double weight = 4.0 * at * at * at * (k == ALBEDO_STEPS ? 0.5 : 1.0);
        mean += weight * curve.back();
        sum += weight;
    }
    std::vector<float> out;
    for (const double value : curve) out.push_back(static_cast<float>(value * sum / mean));
    return out;
}

}  // namespace clgi
