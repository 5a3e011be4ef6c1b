// Weights of an environment's rows and columns, and which way its picture lies.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/sh.hpp>
#include <clgi/passes/transfer.hpp>
#include <cmath>
#include <numbers>

#include "methods/transfer/sh_check.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// Of an angle from `middle - half` to `middle + half`: the integral of cos(k a), or of sin(k a).
double cosine_integral(int k, double middle, double half) {
    return 2.0 * std::cos(k * middle) * (k == 0 ? half : std::sin(k * half) / k);
}
double sine_integral(int k, double middle, double half) {
    return k == 0 ? 0.0 : 2.0 * std::sin(k * middle) * std::sin(k * half) / k;
}

// integral of wave(theta) sin theta dtheta, as half a sum of two waves.
std::vector<float> row_weights_of(int height, int bands) {
    std::vector<float> out;
    const double half = 0.5 * pi / height;
    for (int row = 0; row < height; ++row) {
        const double middle = pi * (row + 0.5) / height;
        for (int k = 0; k < bands; ++k) {
            out.push_back(static_cast<float>(
                0.5 * (sine_integral(k + 1, middle, half) - sine_integral(k - 1, middle, half))));
            if (k > 0)
                out.push_back(static_cast<float>(0.5 * (cosine_integral(k - 1, middle, half) -
                                                        cosine_integral(k + 1, middle, half))));
        }
    }
    return out;
}

// Y_lm(theta, 0) as waves: by samples in number twice the waves', which is exact.
std::vector<float> waves_of(int bands) {
    std::vector<float> out(static_cast<std::size_t>(SH_MOMENT(bands, 0) * bands), 0.0f);
    const int samples = 2 * bands;
    std::vector<double> sums(out.size(), 0.0);
    for (int j = 0; j < samples; ++j) {
        const double theta = pi * (j + 0.5) / samples;
        const auto y = sh::evaluate({std::sin(theta), 0.0, std::cos(theta)}, bands);
        for (int l = 0; l < bands; ++l)
            for (int m = 0; m <= l; ++m)
                for (int k = m % 2; k <= l; ++k) {
                    const double wave = m % 2 == 0 ? std::cos(k * theta) : std::sin(k * theta);
                    sums[static_cast<std::size_t>(SH_MOMENT(l, m) * bands + k)] +=
                        (k == 0 ? 1.0 : 2.0) / samples * wave *
                        y[static_cast<std::size_t>(sh::index(l, m))];
                }
    }
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(sums[i]);
    return out;
}

// The azimuth falls from column to column: from the inside, left to right is clockwise.
std::vector<float> column_weights_of(int width, std::size_t stride, int bands) {
    std::vector<float> out(SH_WAVES(static_cast<std::size_t>(bands)) * stride, 0.0f);
    const double half = pi / width;
    for (int column = 0; column < width; ++column) {
        const double azimuth = -2.0 * half * (column + 0.5);
        for (std::size_t c = 0; c < 3; ++c) {
            float* weight = out.data() + 3 * static_cast<std::size_t>(column) + c;
            *weight = static_cast<float>(cosine_integral(0, azimuth, half));
            for (int m = 1; m < bands; ++m) {
                *(weight += stride) = static_cast<float>(cosine_integral(m, azimuth, half));
                *(weight += stride) = static_cast<float>(sine_integral(m, azimuth, half));
            }
        }
    }
    return out;
}

}  // namespace

EnvironmentProjection::EnvironmentProjection(int width, int height, int count) : bands(count) {
    sh::need_bands(bands);
    if (width < 1 || width > 65536 || height < 1 || height > 65536)
        throw Error("transfer: a picture of " + std::to_string(width) + "x" +
                    std::to_string(height) + " texels, 1x1 to 65536x65536 needed");
    const auto leaves = (3 * static_cast<std::uint32_t>(width) + PROJECT_LEAF - 1) / PROJECT_LEAF;
    params = {glm::vec4(1.0f), static_cast<std::uint32_t>(width),
              static_cast<std::uint32_t>(height), leaves * PROJECT_LEAF, 0};
    row_weights = row_weights_of(height, bands);
    column_weights = column_weights_of(width, params.stride, bands);
    waves = waves_of(bands);
}

std::size_t EnvironmentProjection::sums_bytes() const {
    const std::size_t blocks = (params.height + PROJECT_ROWS - 1) / PROJECT_ROWS;
    return blocks * SH_WAVES(static_cast<std::size_t>(bands)) * params.stride * sizeof(float);
}

std::size_t EnvironmentProjection::leaves_bytes() const {
    const auto slots = static_cast<std::size_t>(bands);
    return params.stride / PROJECT_LEAF * SH_WAVES(slots) * slots * sizeof(float4);
}

std::vector<float> environment_rotation(double angle, int bands) {
    if (!std::isfinite(angle)) throw Error("transfer: the environment's rotation is not finite");
    // The picture's x, y, z are the world's z, x, y, turned about +Y.
    const double c = std::cos(angle), s = std::sin(angle);
    const glm::dmat3 turn(glm::dvec3(s, 0, c), glm::dvec3(c, 0, -s), glm::dvec3(0, 1, 0));
    const std::vector<double> blocks = sh::Rotation(turn, bands).blocks();
    return {blocks.begin(), blocks.end()};
}

std::vector<DirectionalLight> directional_lights(const DeviceScene& scene) {
    std::vector<DirectionalLight> out;
    for (const Light& light : scene.lights())
        if (light.kind == Light::Kind::directional)
            out.push_back({glm::vec4(-glm::normalize(light.direction), 0.0f),
                           glm::vec4(glm::dvec3(light.intensity) / scene.frame().exposure, 0.0f)});
    return out;
}

}  // namespace clgi
