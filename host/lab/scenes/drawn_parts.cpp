// SPDX-License-Identifier: MIT
#include "lab/scenes/drawn_parts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "lab/scenes/solids.hpp"
#include "scene/surfaces.hpp"

namespace clgi::generated {
namespace {

const Placement unmoved;

// A wall in its own coordinates: along it, up, and through it.
struct ChamberWall {
    glm::dvec3 corner, along, up, through;  // unit but for the corner
    double length, height, thickness;
};

void add_slab(Scene& scene, const ChamberWall& wall, double low, double high, double bottom,
              double top, std::uint32_t material) {
    if (!(high - low > 1e-9) || !(top - bottom > 1e-9)) return;
    add_solid(scene, wall.corner + low * wall.along + bottom * wall.up,
              {(high - low) * wall.along, (top - bottom) * wall.up, wall.thickness * wall.through},
              material);
}

void add_wall(Scene& scene, const ChamberWall& wall, const Hole* hole, std::uint32_t material) {
    if (!hole) {
        add_slab(scene, wall, 0.0, wall.length, 0.0, wall.height, material);
        return;
    }
    add_slab(scene, wall, 0.0, hole->low, 0.0, wall.height, material);
    add_slab(scene, wall, hole->high, wall.length, 0.0, wall.height, material);
    add_slab(scene, wall, hole->low, hole->high, 0.0, hole->sill, material);
    add_slab(scene, wall, hole->low, hole->high, hole->lintel, wall.height, material);
}

}  // namespace

double Draws::between(double low, double high) {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return low + (high - low) * (static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53);
}

int Draws::whole(int low, int high) {
    return std::min(high, low + static_cast<int>(between(0.0, 1.0) * (high - low + 1)));
}

glm::vec3 Draws::colour() {
    glm::vec3 out;
    for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(between(0.25, 0.8));
    return out;
}

Chamber draw_chamber(Draws& draws) {
    Chamber out;
    out.size = {draws.between(3.0, 6.0), draws.between(2.4, 3.4), draws.between(4.0, 7.0)};
    return out;
}

Hole draw_window(Draws& draws, const Chamber& chamber) {
    Hole out;
    out.wall = draws.whole(0, 3);
    const double length = out.wall < 2 ? chamber.size.z : chamber.size.x;
    const double width = draws.between(0.6, 1.8);
    out.low = draws.between(0.3, length - width - 0.3);
    out.high = out.low + width;
    out.sill = draws.between(0.7, 1.1);
    out.lintel = out.sill + draws.between(0.7, 1.2);
    return out;
}

void add_chamber(Scene& scene, Draws& draws, const Chamber& chamber,
                 const std::optional<Hole>& hole) {
    const double t = chamber.wall;
    const glm::dvec3 low = chamber.low, high = low + chamber.size;
    add_block(scene, unmoved, low - glm::dvec3(t), {high.x + t, low.y, high.z + t},
              add_material(scene, "floor", draws.colour()));
    if (chamber.roof)
        add_block(scene, unmoved, {low.x - t, high.y, low.z - t}, high + glm::dvec3(t),
                  add_material(scene, "ceiling", draws.colour()));
    const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0), z(0.0, 0.0, 1.0);
    // Walls across z stand between those across x. Both start at the chamber's corners.
    const ChamberWall walls[] = {
        {low - t * x, z, y, x, chamber.size.z, chamber.size.y, t},
        {{high.x, low.y, low.z}, z, y, x, chamber.size.z, chamber.size.y, t},
        {low - t * z, x, y, z, chamber.size.x, chamber.size.y, t},
        {{low.x, low.y, high.z}, x, y, z, chamber.size.x, chamber.size.y, t}};
    for (int k = 0; k < 4; ++k)
        add_wall(scene, walls[k], hole && hole->wall == k ? &*hole : nullptr,
                 add_material(scene, "wall", draws.colour()));
    for (const double px : {low.x - t, high.x})  // corners, so that no light comes in there
        for (const double pz : {low.z - t, high.z})
            add_block(scene, unmoved, {px, low.y, pz}, {px + t, high.y, pz + t},
                      static_cast<std::uint32_t>(scene.materials.size() - 1));
}

void add_furniture(Scene& scene, Draws& draws, const Chamber& chamber, float roughness) {
    const int count = draws.whole(2, 5);
    for (int k = 0; k < count; ++k) {
        const std::uint32_t material = add_material(scene, "thing", draws.colour());
        scene.materials[material].roughness = roughness;
        if (roughness < 1.0f) {
            scene.materials[material].metallic = 0.5f;
            scene.materials[material].specular = 1.0f;
        }
        const double turn = draws.between(0.0, std::numbers::pi);
        const glm::dvec3 at(chamber.low.x + draws.between(0.2, 0.8) * chamber.size.x, chamber.low.y,
                            chamber.low.z + draws.between(0.4, 0.85) * chamber.size.z);
        const double half = draws.between(0.15, 0.45), height = draws.between(0.3, 1.2);
        switch (draws.whole(0, 2)) {
            case 0:
                add_block(scene, placed(at + glm::dvec3(0.0, 1e-3, 0.0), turn),
                          {-half, 0.0, -0.7 * half}, {half, height, 0.7 * half}, material);
                break;
            case 1:
                add_cushion(scene, placed(at + glm::dvec3(0.0, half + 1e-3, 0.0), turn),
                            glm::dvec3(half, half, 0.8 * half), 3.0, 20, 12, material);
                break;
            default:  // a table: a plate on a leg
                add_block(scene, placed(at + glm::dvec3(0.0, 0.6 * height + 0.01, 0.0), turn),
                          {-half, 0.0, -half}, {half, 0.05, half}, material);
                add_block(scene, placed(at + glm::dvec3(0.0, 1e-3, 0.0), turn), {-0.05, 0.0, -0.05},
                          {0.05, 0.6 * height, 0.05}, material);
        }
    }
}

void add_lamp(Scene& scene, const Chamber& chamber, const glm::dvec2& share, double side,
              float radiance) {
    const std::uint32_t material = add_material(scene, "lamp", glm::vec3(0.0f));
    scene.materials[material].emission = radiance * glm::vec3(1.0f, 0.93f, 0.8f);
    const double x = chamber.low.x + share.x * (chamber.size.x - side),
                 z = chamber.low.z + share.y * (chamber.size.z - side),
                 y = chamber.low.y + chamber.size.y - 0.01;
    add_quad(scene,
             {glm::dvec3(x, y, z), {x + side, y, z}, {x + side, y, z + side}, {x, y, z + side}},
             material);
}

void add_view(Scene& scene, Draws& draws, const Chamber& chamber) {
    const glm::dvec3 eye = chamber.low +
                           chamber.size * glm::dvec3(draws.between(0.3, 0.7), 0.0, 0.06) +
                           glm::dvec3(0.0, draws.between(1.3, 1.8), 0.0);
    const glm::dvec3 at = chamber.low +
                          chamber.size * glm::dvec3(draws.between(0.3, 0.7), 0.0, 0.9) +
                          glm::dvec3(0.0, draws.between(0.6, 1.4), 0.0);
    scene.cameras.push_back(look_at("camera", eye, at, 1.0f));
    scene.cameras.back().near = 0.01f;  // whatever lies around the chamber
}

void add_ground(Scene& scene, Draws& draws, const Chamber& chamber, double extent, double relief) {
    const std::uint32_t material = add_material(scene, "ground", draws.colour());
    const glm::dvec3 middle = chamber.low + 0.5 * chamber.size;
    const double y = chamber.low.y - chamber.wall - 0.05;
    const int side = relief > 0.0 ? 64 : 8;
    // Cells grow with the distance; the innermost one lies under the chamber and is flat.
    std::vector<double> cuts;
    for (int k = 0; k <= side; ++k) {
        const double s = 2.0 * k / side - 1.0;
        cuts.push_back(std::copysign(extent * std::pow(std::abs(s), relief > 0.0 ? 3.0 : 1.0), s));
    }
    std::vector<double> heights;
    for (const double z : cuts)
        for (const double x : cuts) {
            const double far = std::max(std::abs(x), std::abs(z)), free = chamber.size.z + 1.0;
            const double rise = std::clamp((far - free) / (0.2 * extent), 0.0, 1.0);
            heights.push_back(relief * rise * draws.between(-0.3, 1.0));
        }
    const auto at = [&](int i, int j) {
        return glm::dvec3(middle.x + cuts[static_cast<std::size_t>(i)],
                          y + heights[static_cast<std::size_t>(j * (side + 1) + i)],
                          middle.z + cuts[static_cast<std::size_t>(j)]);
    };
    const auto add_triangle = [&](const std::array<glm::dvec3, 3>& corners) {
        const glm::dvec3 n =
            glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
        const auto first = static_cast<std::uint32_t>(scene.positions.size());
        for (const glm::dvec3& corner : corners) {
            scene.positions.push_back(corner);
            scene.normals.push_back(glm::vec3(n));
        }
        scene.triangles.push_back({{first, first + 1, first + 2}, material});
    };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            add_triangle({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            add_triangle({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
}

}  // namespace clgi::generated
