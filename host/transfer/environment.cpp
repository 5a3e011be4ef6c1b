// Weights of an environment's rows and columns, and which way its picture lies.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/passes/transfer.hpp>
#include <clgi/sh.hpp>
#include <cmath>
#include <numbers>

#include "transfer/sh_check.hpp"

namespace clgi {
namespace {

constexpr double pi = std::numbers::pi;

struct Node {
    double at, weight;  // in [-1, 1]
};

// Gauss-Legendre, positive half: exact to rounding for polynomials of sines and cosines of up to
// ten times the angle, over an eighth of pi.
constexpr Node nodes[] = {{0.1488743389816312, 0.2955242247147529},
                          {0.4333953941292472, 0.2692667193099964},
                          {0.6794095682990244, 0.2190863625159820},
                          {0.8650633666889845, 0.1494513491505806},
                          {0.9739065285171717, 0.0666713443086881}};

// Adds integral Y_lm(theta, 0) sin theta dtheta between two angles, m >= 0.
void add_moments(double from, double to, int bands, double* moments) {
    std::vector<double> y(static_cast<std::size_t>(sh::terms(bands)));
    for (const Node& node : nodes)
        for (const double side : {-1.0, 1.0}) {
            const double theta = 0.5 * (from + to) + side * node.at * 0.5 * (to - from);
            const double weight = 0.5 * (to - from) * node.weight * std::sin(theta);
            sh::evaluate({std::sin(theta), 0.0, std::cos(theta)}, bands, y.data());
            for (int l = 0; l < bands; ++l)
                for (int m = 0; m <= l; ++m)
                    moments[SH_MOMENTS(l) + m] +=
                        weight * y[static_cast<std::size_t>(sh::index(l, m))];
        }
}

std::vector<float> row_weights_of(int height, int bands) {
    std::vector<float> out;
    const int pieces = std::max(1, 8 / height);
    for (int row = 0; row < height; ++row) {
        std::vector<double> moments(SH_MOMENTS(static_cast<std::size_t>(bands)));
        for (int piece = 0; piece < pieces; ++piece)
            add_moments(pi * (row + double(piece) / pieces) / height,
                        pi * (row + double(piece + 1) / pieces) / height, bands, moments.data());
        out.insert(out.end(), moments.begin(), moments.end());
    }
    return out;
}

// The azimuth falls from column to column: from the inside, left to right is clockwise.
std::vector<float> column_weights_of(int width, std::size_t stride, int bands) {
    std::vector<float> out(static_cast<std::size_t>(2 * bands - 1) * stride, 0.0f);
    const double step = 2.0 * pi / width;
    for (int m = 0; m < bands; ++m) {
        const double half = 0.5 * m * step;
        const double arc = m == 0 ? step : step * std::sin(half) / half;
        float* cosines = out.data() + (m > 0 ? 2 * m - 1 : 0) * stride;
        for (int column = 0; column < width; ++column) {
            const double azimuth = -m * step * (column + 0.5);
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t at = 3 * static_cast<std::size_t>(column) + c;
                cosines[at] = static_cast<float>(arc * std::cos(azimuth));
                if (m > 0) cosines[stride + at] = static_cast<float>(arc * std::sin(azimuth));
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
}

std::size_t EnvironmentProjection::sums_bytes() const {
    const std::size_t blocks = (params.height + PROJECT_ROWS - 1) / PROJECT_ROWS;
    return blocks * SH_MOMENTS(static_cast<std::size_t>(bands)) * params.stride * sizeof(float);
}

std::size_t EnvironmentProjection::leaves_bytes() const {
    return params.stride / PROJECT_LEAF * static_cast<std::size_t>(sh::terms(bands)) *
           sizeof(float4);
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
