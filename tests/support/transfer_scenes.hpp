// Scenes under an environment, and what their vertices receive.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <cmath>
#include <map>

#include "device.hpp"
#include "scenes.hpp"

namespace clgi::test {

inline void light_by(Scene& scene, const glm::vec3& radiance) {
    scene.environment.emplace();
    scene.environment->factor = radiance;
}

// Radiance of (1 + s . axis) times a colour: a picture of this many texels a turn.
inline void light_by_gradient(Scene& scene, const glm::vec3& colour, const glm::dvec3& axis,
                              int width = 128) {
    constexpr double pi = 3.14159265358979323846;
    Environment sky;
    sky.width = width;
    sky.height = width / 2;
    sky.factor = colour;
    for (int row = 0; row < sky.height; ++row)
        for (int column = 0; column < width; ++column) {
            const double down = pi * (row + 0.5) / sky.height;
            const double across = 2 * pi * (column + 0.5) / width - pi;
            const glm::dvec3 s(std::sin(down) * std::sin(across), std::cos(down),
                               -std::sin(down) * std::cos(across));
            sky.texels.emplace_back(static_cast<float>(1.0 + glm::dot(s, axis)));
        }
    scene.environment = std::move(sky);
}

// A sphere of 20 * 4^level triangles with the sphere's own normals.
inline void add_sphere(Scene& scene, const glm::dvec3& centre, double radius, int level,
                       std::uint32_t material = 0) {
    const double t = (1 + std::sqrt(5.0)) / 2;
    std::vector<glm::dvec3> points = {{-1, t, 0}, {1, t, 0}, {-1, -t, 0}, {1, -t, 0},
                                      {0, -1, t}, {0, 1, t}, {0, -1, -t}, {0, 1, -t},
                                      {t, 0, -1}, {t, 0, 1}, {-t, 0, -1}, {-t, 0, 1}};
    for (glm::dvec3& point : points) point = glm::normalize(point);
    std::vector<glm::uvec3> faces = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
    for (int i = 0; i < level; ++i) {
        std::map<std::pair<unsigned, unsigned>, unsigned> middles;
        const auto middle = [&](unsigned a, unsigned b) {
            const auto [at, made] = middles.try_emplace({std::min(a, b), std::max(a, b)},
                                                        static_cast<unsigned>(points.size()));
            if (made) points.push_back(glm::normalize(points[a] + points[b]));
            return at->second;
        };
        std::vector<glm::uvec3> finer;
        for (const glm::uvec3& f : faces) {
            const unsigned ab = middle(f.x, f.y), bc = middle(f.y, f.z), ca = middle(f.z, f.x);
            for (const glm::uvec3& part : {glm::uvec3(f.x, ab, ca), glm::uvec3(f.y, bc, ab),
                                           glm::uvec3(f.z, ca, bc), glm::uvec3(ab, bc, ca)})
                finer.push_back(part);
        }
        faces = std::move(finer);
    }
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (const glm::dvec3& point : points) {
        scene.positions.push_back(centre + radius * point);
        scene.normals.emplace_back(point);
    }
    for (const glm::uvec3& f : faces)
        scene.triangles.push_back({{first + f.x, first + f.y, first + f.z}, material});
}

// Spheres and boxes of many colours, upright or on an edge, on a ground of two triangles.
inline Scene heap_of_solids(std::uint64_t seed) {
    Random random(seed);
    Scene scene = plain_scene({0.7f, 0.66f, 0.6f});
    add_floor(scene, 4.0);
    const auto colour = [&] {
        Material material;
        for (int c = 0; c < 3; ++c) material.base_color[c] = static_cast<float>(random(0.15, 0.85));
        return add_material(scene, material);
    };
    for (int i = 0; i < 4; ++i) {
        const double radius = random(0.3, 0.6), x = random(-1.6, 1.6), z = random(-1.6, 1.6);
        const std::uint32_t material = colour();
        add_sphere(scene, {x, radius, z}, radius, 3, material);
    }
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t material = colour();
        const std::size_t first = scene.positions.size();
        const double w = random(0.2, 0.5), h = random(0.2, 0.5), d = random(0.2, 0.5);
        add_box(scene, {-w, -h, -d}, {w, h, d}, 1, material);
        const double turn = random(0, 3), tilt = i % 2 ? 0.0 : random(0.1, 0.6);
        const double x = random(-1.6, 1.6), z = random(-1.6, 1.6);
        const double lift = h * std::cos(tilt) + w * std::sin(tilt);
        for (std::size_t v = first; v < scene.positions.size(); ++v) {
            const auto moved = [&](glm::dvec3 p) {
                p = {p.x * std::cos(tilt) - p.y * std::sin(tilt),
                     p.x * std::sin(tilt) + p.y * std::cos(tilt), p.z};
                return glm::dvec3(p.x * std::cos(turn) + p.z * std::sin(turn), p.y,
                                  p.z * std::cos(turn) - p.x * std::sin(turn));
            };
            scene.positions[v] = moved(scene.positions[v]) + glm::dvec3(x, lift, z);
            scene.normals[v] = glm::vec3(moved(glm::dvec3(scene.normals[v])));
        }
    }
    scene.cameras = {camera_at({2.2, 2.8, 4.6}, {0, 0.2, 0}, 0.75f)};
    return scene;
}

// The irradiance of receivers, lux: vertices of the device in its order, then other sides.
inline std::vector<glm::dvec3> irradiance_of(const DynamicTransferSolver& solver,
                                             const DeviceScene& scene) {
    const std::size_t stride = solver.receivers().stride;
    const auto values = download<float>(solver.irradiance(), 3 * stride);
    std::vector<glm::dvec3> out;
    for (std::size_t i = 0; i < solver.receivers().count; ++i)
        out.push_back(scene.frame().exposure *
                      glm::dvec3(values[i], values[stride + i], values[2 * stride + i]));
    return out;
}

}  // namespace clgi::test
