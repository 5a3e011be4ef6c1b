// Rooms with an object that shines. [Dachsbacher07, figures 1 and 15]
// SPDX-License-Identifier: MIT
#include <cmath>
#include <map>
#include "lab/scenes/interiors.hpp"

#include "lab/scenes/bust.hpp"
#include "lab/scenes/hollow.hpp"
#include "lab/scenes/solids.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace glossy_scene {
namespace {

constexpr int cube_cells = 16;  // 6 x 16 x 16 x 2 = 3,072 triangles

void check(const char* scene, const GlossyOptions& options) {
    generated::check_range(scene, "roughness", options.roughness, 0.05, 1.0);
    generated::check_range(scene, "metallic", options.metallic, 0.0, 1.0);
    generated::check_range(scene, "intensity", options.intensity, 0.0, 1e20);
}

std::uint32_t add_shine(Scene& scene, const glm::vec3& color, const GlossyOptions& options) {
    const std::uint32_t out = generated::add_material(scene, "glossy", color);
    scene.materials[out].roughness = options.roughness;
    scene.materials[out].metallic = options.metallic;
    scene.materials[out].specular = 1.0f;
    return out;
}

// Closed, facing inward, around (0, height / 2, 0).
void add_room(Scene& scene, const glm::dvec3& size, int cells, const glm::vec3& left,
              const glm::vec3& right, float brightness) {
    using generated::add_material;
    const std::uint32_t pale =
        add_material(scene, "walls", brightness * glm::vec3(1.0f, 0.985f, 0.95f));
    const std::uint32_t floor = add_material(scene, "floor", {0.58f, 0.56f, 0.52f});
    generated::Hollow room;
    room.cuts = {generated::even_cuts(-0.5 * size.x, 0.5 * size.x, cells),
                 generated::even_cuts(0.0, size.y, cells),
                 generated::even_cuts(-0.5 * size.z, 0.5 * size.z, cells)};
    const std::uint32_t warm = add_material(scene, "left", left);
    const std::uint32_t cool = add_material(scene, "right", right);
    room.materials = {warm, cool, floor, pale, pale, pale};
    generated::add_hollow(scene, room);
    generated::end_part(scene, "room");
}

// |x|^8 + |y|^8 + |z|^8 = 1 times half the side: grids on the faces of a cube, drawn in.
void add_round_cube(Scene& scene, const generated::Placement& at, double half,
                    std::uint32_t material) {
    const std::size_t first = scene.positions.size(), first_triangle = scene.triangles.size();
    std::map<std::array<int, 3>, std::uint32_t> vertices;
    const auto vertex = [&](const std::array<int, 3>& cell) {
        const auto [found, fresh] =
            vertices.try_emplace(cell, static_cast<std::uint32_t>(scene.positions.size()));
        if (fresh) {
            glm::dvec3 p(0.0);
            double sum = 0.0;
            for (int i = 0; i < 3; ++i) {
                // Cells narrow towards the edges, where the surface bends.
                const double share = 2.0 * cell[static_cast<std::size_t>(i)] / cube_cells - 1.0;
                p[i] = 1.3 * share - 0.3 * share * share * share;
                sum += std::pow(std::abs(p[i]), 8.0);
            }
            scene.positions.push_back(at(half * std::pow(sum, -1.0 / 8.0) * p));
        }
        return found->second;
    };
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const int side : {0, cube_cells})
            for (int i = 0; i < cube_cells; ++i)
                for (int k = 0; k < cube_cells; ++k) {
                    const auto place = [&](int a, int b) {
                        std::array<int, 3> cell{};
                        cell[axis] = side;
                        cell[(axis + 1) % 3] = side > 0 ? a : b;
                        cell[(axis + 2) % 3] = side > 0 ? b : a;
                        return vertex(cell);
                    };
                    const std::uint32_t a = place(i, k), b = place(i + 1, k),
                                        c = place(i + 1, k + 1), d = place(i, k + 1);
                    scene.triangles.push_back({{a, b, c}, material});
                    scene.triangles.push_back({{a, c, d}, material});
                }
    generated::smooth_normals_of(scene, first, first_triangle);
}

Light lamp(const glm::dvec3& from, const glm::dvec3& to, float cone, const GlossyOptions& options) {
    return generated::spot("spot", from, to, options.intensity * glm::vec3(1.0f, 0.95f, 0.87f),
                           cone);
}

}  // namespace
}  // namespace glossy_scene

Scene glossy_box(const GlossyOptions& options) {
    using namespace glossy_scene;
    check("glossy-box", options);
    Scene scene;
    scene.name = "glossy-box";
    add_room(scene, {3.0, 2.4, 3.4}, 6, {0.74f, 0.46f, 0.22f}, {0.34f, 0.56f, 0.30f}, 0.76f);
    const std::uint32_t shine = add_shine(scene, {0.26f, 0.42f, 0.86f}, options);
    add_round_cube(scene, generated::placed({0.1, 0.5, -0.45}, 0.62), 0.5, shine);
    generated::end_part(scene, "cube");
    scene.lights.push_back(lamp({-0.9, 2.25, 0.95}, {0.12, 0.45, -0.45}, 0.42f, options));
    scene.cameras.push_back(
        generated::look_at("camera", {0.35, 1.30, 1.62}, {0.0, 0.86, -0.7}, 1.12f));
    return scene;
}

Scene glossy_bust_like(const GlossyOptions& options) {
    using namespace glossy_scene;
    check("glossy-bust-like", options);
    Scene scene;
    scene.name = "glossy-bust-like";
    add_room(scene, {2.8, 2.4, 3.0}, 4, {0.78f, 0.52f, 0.34f}, {0.22f, 0.40f, 0.62f}, 0.36f);
    const std::uint32_t stone = generated::add_material(scene, "stone", {0.48f, 0.46f, 0.43f});
    const std::uint32_t shine = add_shine(scene, {0.88f, 0.62f, 0.30f}, options);
    const glm::dvec3 place(0.0, 0.0, -0.2);
    generated::add_turned(scene, generated::placed(place),
                          {{0.24, 0.0},
                           {0.24, 0.08},
                           {0.18, 0.14},
                           {0.165, 0.5},
                           {0.165, 0.80},
                           {0.21, 0.87},
                           {0.21, 0.93}},
                          18, stone);
    generated::end_part(scene, "pedestal");
    generated::add_bust(scene, generated::placed(place + glm::dvec3(0.0, 0.93, 0.0), 0.3), 1.5,
                        shine);
    generated::end_part(scene, "bust");
    scene.lights.push_back(lamp({0.95, 2.25, 1.25}, {-1.4, 1.05, 0.75}, 0.36f, options));
    scene.cameras.push_back(
        generated::look_at("camera", {0.30, 1.48, 0.98}, {-0.03, 1.37, -0.2}, 0.78f));
    return scene;
}

}  // namespace clgi
