// Functions around an axis, by one number a band.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/sh.hpp>
#include <cmath>
#include <numbers>

#include "methods/transfer/sh_check.hpp"

namespace clgi::sh {
namespace {

using std::numbers::pi;

}  // namespace

std::vector<double> cosine_kernel(int bands) { return power_kernel(1.0, bands); }

// I_l = integral_0^1 z^s P_l dz: I_0 = 1 / (s + 1), I_1 = 1 / (s + 2),
// I_l = I_l-2 (s - l + 2) / (s + l + 1)            [derived: by parts, from Legendre's equation]
std::vector<double> power_kernel(double exponent, int bands) {
    need_bands(bands);
    if (!(exponent >= 0.0) || !std::isfinite(exponent))
        throw Error("sh: the exponent of a power kernel is " + std::to_string(exponent) +
                    ", finite and at least 0 needed");
    std::vector<double> out(static_cast<std::size_t>(bands));
    for (int l = 0; l < bands; ++l) {
        const auto i = static_cast<std::size_t>(l);
        out[i] = l < 2 ? 2.0 * pi / (exponent + l + 1)
                       : out[i - 2] * (exponent - l + 2) / (exponent + l + 1);
    }
    return out;
}

std::vector<double> phong_kernel(double exponent, int bands) {
    std::vector<double> out = power_kernel(exponent, bands);
    for (double& k : out) k *= (exponent + 2.0) / (2.0 * pi);
    return out;
}

// integral_cos a^1 P_l dz = sin^2 a P_l'(cos a) / (l (l + 1)), which does not cancel for small a as
// (P_l-1 - P_l+1) / (2 l + 1) does; P_l'  = l P_l-1 + z P_l-1'. [derived: Legendre's equation]
std::vector<double> cap_kernel(double half_angle, int bands) {
    need_bands(bands);
    if (!(half_angle >= 0.0 && half_angle <= pi))
        throw Error("sh: the half angle of a cap is " + std::to_string(half_angle) +
                    ", 0 to pi needed");
    const double z = std::cos(half_angle), sine = std::sin(half_angle);
    const double half = std::sin(0.5 * half_angle);
    std::vector<double> out{4.0 * pi * half * half};
    double before = 0.0, p = 1.0, slope = 0.0;  // P_l-1, P_l, P_l'
    for (int l = 1; l < bands; ++l) {
        slope = l * p + z * slope;
        const double next = ((2 * l - 1) * z * p - (l - 1) * before) / l;
        before = p;
        p = next;
        out.push_back(2.0 * pi * sine * sine * slope / (l * (l + 1.0)));
    }
    return out;
}

std::vector<double> around(const glm::dvec3& direction, const std::vector<double>& kernel) {
    return convolve(kernel, evaluate(direction, static_cast<int>(kernel.size())));
}

}  // namespace clgi::sh
