// A solid of 69,451 triangles, for a box without a mesh file.
//
// Rings of vertices around the Y axis, one pole at either end; two neighbouring rings of n and m
// vertices are joined by n + m triangles. A closed surface of V vertices has 2V - 4 triangles,
// an even number: rings of 34,725 vertices together give 69,450. The last one comes from
// cutting a triangle at the lower pole in two through the middle of an edge, whose other
// triangle stays whole. The new vertex lies on that edge, so the surface remains closed.
// SPDX-License-Identifier: MIT
#include <clgi/procedural.hpp>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <numbers>

#include "lab/scenes/rooms.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace bumpy_mesh_scene {
namespace {

using std::numbers::pi;
constexpr std::uint32_t ring_vertices = 34725;  // of all rings together
constexpr int ring_count = 177;                 // makes the triangles nearly equilateral

struct Ring {
    std::uint32_t first;  // index of its first vertex
    std::uint32_t count;
};

// Distance of the surface from the centre. Star-shaped: it stays between 0.69 and 1.31.
double radius(const glm::dvec3& d) {
    return 1.0 + 0.15 * std::sin(4.0 * d.x + 0.8) * std::sin(3.6 * d.y + 0.9) +
           0.10 * std::sin(5.0 * d.z + 3.0 * d.y) +
           0.06 * std::sin(11.0 * d.x) * std::sin(9.0 * d.y + 1.0) * std::sin(10.0 * d.z + 0.6);
}

double polar_angle(int ring) { return pi * (ring + 1) / (ring_count + 1); }

// Vertices in proportion to each ring's circumference, rounded so that the total is exact.
std::vector<Ring> share_out_vertices() {
    double whole = 0.0;
    for (int ring = 0; ring < ring_count; ++ring) whole += std::sin(polar_angle(ring));
    std::vector<Ring> rings;
    double so_far = 0.0;
    std::uint32_t given = 0;
    for (int ring = 0; ring < ring_count; ++ring) {
        so_far += std::sin(polar_angle(ring));
        const auto target = static_cast<std::uint32_t>(std::lround(ring_vertices * so_far / whole));
        rings.push_back({given, target - given});
        given = target;
    }
    return rings;
}

void add_vertices(Scene& scene, const std::vector<Ring>& rings) {
    const auto add = [&](const glm::dvec3& d) { scene.positions.push_back(d * radius(d)); };
    for (int ring = 0; ring < ring_count; ++ring) {
        const double theta = polar_angle(ring);
        for (std::uint32_t i = 0; i < rings[ring].count; ++i) {
            const double phi = 2.0 * pi * i / rings[ring].count;
            add({std::sin(theta) * std::cos(phi), std::cos(theta),
                 std::sin(theta) * std::sin(phi)});
        }
    }
    add({0.0, 1.0, 0.0});
    add({0.0, -1.0, 0.0});
}

// Walks both rings at once; the one whose next vertex comes first in angle gives the triangle.
void join_rings(Scene& scene, const Ring& upper, const Ring& lower) {
    std::uint32_t i = 0, j = 0;
    while (i < upper.count || j < lower.count) {
        const std::uint32_t up = upper.first + i % upper.count;
        const std::uint32_t low = lower.first + j % lower.count;
        const bool upper_first = (i + 1) * lower.count <= (j + 1) * upper.count;
        if (j == lower.count || (i < upper.count && upper_first)) {
            ++i;
            scene.triangles.push_back({{up, upper.first + i % upper.count, low}, 0});
        } else {
            ++j;
            scene.triangles.push_back({{low, up, lower.first + j % lower.count}, 0});
        }
    }
}

void close_poles(Scene& scene, const Ring& top, const Ring& bottom) {
    const std::uint32_t north = ring_vertices, south = ring_vertices + 1;
    for (std::uint32_t i = 0; i < top.count; ++i) {
        const std::uint32_t next = top.first + (i + 1) % top.count;
        scene.triangles.push_back({{top.first + i, north, next}, 0});
    }
    for (std::uint32_t i = 0; i < bottom.count; ++i) {
        const std::uint32_t next = bottom.first + (i + 1) % bottom.count;
        scene.triangles.push_back({{bottom.first + i, next, south}, 0});
    }
}

void cut_last_triangle(Scene& scene) {
    SceneTriangle& last = scene.triangles.back();
    const auto [here, next, south] = last.vertex;
    const auto middle = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.push_back(0.5 * (scene.positions[here] + scene.positions[south]));
    last.vertex[2] = middle;
    scene.triangles.push_back({{middle, next, south}, 0});
}

}  // namespace
}  // namespace bumpy_mesh_scene

Scene bumpy_mesh() {
    using namespace bumpy_mesh_scene;
    Scene scene;
    scene.name = "bumpy mesh";
    generated::add_material(scene, "mesh", glm::vec3(0.78f, 0.77f, 0.74f));
    const std::vector<Ring> rings = share_out_vertices();
    add_vertices(scene, rings);
    for (int ring = 0; ring + 1 < ring_count; ++ring) {
        join_rings(scene, rings[ring], rings[ring + 1]);
    }
    close_poles(scene, rings.front(), rings.back());
    cut_last_triangle(scene);
    generated::smooth_normals(scene);
    generated::end_part(scene, "mesh");
    return scene;
}

}  // namespace clgi
