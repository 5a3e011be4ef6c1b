// Rules for integrals over intervals and over the sphere, in double precision.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace clgi::test {

struct Node {
    double at, weight;
};

// Gauss-Legendre: exact for polynomials up to degree 2 count - 1.
inline std::vector<Node> gauss(int count, double from, double to) {
    std::vector<Node> out;
    for (int i = 0; i < count; ++i) {
        double x = std::cos(std::numbers::pi * (i + 0.75) / (count + 0.5)), slope = 1.0;
        for (int step = 0; step < 100; ++step) {
            double before = 1.0, p = x;
            for (int l = 2; l <= count; ++l) {
                const double next = ((2 * l - 1) * x * p - (l - 1) * before) / l;
                before = p;
                p = next;
            }
            slope = count * (x * p - before) / (x * x - 1.0);
            x -= p / slope;
            if (std::abs(p / slope) < 1e-16) break;
        }
        const double weight = 2.0 / ((1.0 - x * x) * slope * slope);
        out.push_back({0.5 * (from + to) + 0.5 * (to - from) * x, 0.5 * (to - from) * weight});
    }
    return out;
}

struct SphereNode {
    glm::dvec3 direction;
    double weight;  // steradians
};

// Exact for polynomials in x, y, z up to degree 2 count - 1.
inline std::vector<SphereNode> sphere_rule(int count) {
    std::vector<SphereNode> out;
    for (const Node& z : gauss(count, -1.0, 1.0))
        for (int k = 0; k < 2 * count; ++k) {
            const double azimuth = std::numbers::pi * k / count, ring = std::sqrt(1 - z.at * z.at);
            out.push_back({{ring * std::cos(azimuth), ring * std::sin(azimuth), z.at},
                           z.weight * std::numbers::pi / count});
        }
    return out;
}

}  // namespace clgi::test
