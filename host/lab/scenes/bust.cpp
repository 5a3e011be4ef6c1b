// SPDX-License-Identifier: MIT
#include "lab/scenes/bust.hpp"

#include <algorithm>
#include <cmath>

#include "lab/scenes/flesh.hpp"

namespace clgi::generated {
namespace {

constexpr std::size_t bust_vertices = 6472;

Flesh bust_flesh() {
    Flesh out;
    out.blend = 0.0085;
    const auto middle = [&](const glm::dvec3& a, const glm::dvec3& b, double p, double q) {
        out.bones.push_back({0, a, b, p, q});
    };
    const auto pair = [&](const glm::dvec3& a, const glm::dvec3& b, double p, double q) {
        out.add_pair(0, 0, a, b, p, q);
    };
    // Foot, chest, shoulders.
    middle({0.0, 0.040, -0.005}, {0.0, 0.075, 0.0}, 0.040, 0.058);
    middle({0.0, 0.030, -0.005}, {0.0, 0.031, -0.005}, 0.048, 0.048);
    pair({0.0, 0.125, -0.005}, {0.085, 0.130, -0.008}, 0.074, 0.064);
    pair({0.040, 0.105, 0.030}, {0.062, 0.108, 0.034}, 0.050, 0.046);
    pair({0.050, 0.175, -0.012}, {0.140, 0.150, -0.014}, 0.044, 0.042);
    pair({0.020, 0.185, 0.030}, {0.110, 0.178, 0.012}, 0.018, 0.018);
    // Neck.
    middle({0.0, 0.175, -0.008}, {0.0, 0.300, 0.004}, 0.050, 0.046);
    pair({0.028, 0.285, -0.018}, {0.090, 0.185, -0.022}, 0.026, 0.030);
    pair({0.040, 0.300, -0.004}, {0.012, 0.195, 0.036}, 0.014, 0.011);
    // Head.
    middle({0.0, 0.420, 0.004}, {0.0, 0.414, -0.030}, 0.076, 0.078);
    pair({0.022, 0.405, 0.010}, {0.026, 0.400, -0.03}, 0.056, 0.056);
    middle({0.0, 0.365, 0.024}, {0.0, 0.326, 0.036}, 0.058, 0.040);
    pair({0.014, 0.303, 0.052}, {0.046, 0.338, 0.004}, 0.022, 0.026);
    middle({0.0, 0.299, 0.066}, {0.0, 0.302, 0.064}, 0.0165, 0.0165);
    pair({0.036, 0.358, 0.044}, {0.044, 0.366, 0.034}, 0.025, 0.024);
    // Brow, eyes, nose, lips, ears. None is much smaller than a triangle.
    pair({0.008, 0.4060, 0.0770}, {0.046, 0.4090, 0.0560}, 0.0110, 0.0100);
    pair({0.0300, 0.3830, 0.0640}, {0.0305, 0.3830, 0.0640}, 0.0150, 0.0150);
    middle({0.0, 0.4000, 0.0850}, {0.0, 0.3560, 0.1090}, 0.0090, 0.0120);
    pair({0.0100, 0.3540, 0.0960}, {0.0105, 0.3540, 0.0950}, 0.0100, 0.0100);
    pair({0.0, 0.3330, 0.0900}, {0.0200, 0.3300, 0.0760}, 0.0075, 0.0055);
    pair({0.0, 0.3190, 0.0880}, {0.0170, 0.3215, 0.0760}, 0.0085, 0.0060);
    middle({0.0, 0.2990, 0.0780}, {0.0, 0.3000, 0.0760}, 0.0170, 0.0170);
    pair({0.084, 0.394, -0.014}, {0.077, 0.360, -0.002}, 0.0130, 0.0110);
    // Hair: drawn back to a knot.
    middle({0.0, 0.438, 0.006}, {0.0, 0.432, -0.034}, 0.078, 0.081);
    pair({0.040, 0.452, 0.044}, {0.074, 0.410, 0.006}, 0.022, 0.018);
    pair({0.050, 0.440, -0.030}, {0.040, 0.385, -0.070}, 0.040, 0.032);
    middle({0.0, 0.436, -0.126}, {0.0, 0.424, -0.132}, 0.036, 0.036);
    return out;
}

}  // namespace

void add_bust(Scene& scene, const Placement& at, double scale, std::uint32_t material) {
    const FleshMesh mesh = mesh_of(bust_flesh(), bust_vertices);
    const std::size_t first = scene.positions.size(), first_triangle = scene.triangles.size();
    const auto base = static_cast<std::uint32_t>(first);
    double low = INFINITY;
    for (const glm::dvec3& p : mesh.positions) low = std::min(low, p.y);
    for (const glm::dvec3& p : mesh.positions)
        scene.positions.push_back(at(scale * (p - glm::dvec3(0.0, low, 0.0))));
    for (const auto& [a, b, c] : mesh.triangles)
        scene.triangles.push_back({{base + a, base + b, base + c}, material});
    smooth_normals_of(scene, first, first_triangle);
}

}  // namespace clgi::generated
