// SPDX-License-Identifier: MIT
#include "lab/scenes/solids.hpp"

#include <clgi/error.hpp>
#include <cmath>

#include "scene/surfaces.hpp"

namespace clgi::generated {
namespace {

// Flat, fanned from its first corner. Corners counter-clockwise seen from the front.
void add_face(Scene& scene, const Placement& at, const std::vector<glm::dvec3>& corners,
              std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    glm::dvec3 twice(0.0);
    for (std::size_t k = 2; k < corners.size(); ++k)
        twice += glm::cross(corners[k - 1] - corners[0], corners[k] - corners[0]);
    const glm::vec3 normal(at.axes * glm::normalize(twice));
    for (const glm::dvec3& corner : corners) {
        scene.positions.push_back(at(corner));
        scene.normals.push_back(normal);
    }
    for (std::uint32_t k = 2; k < corners.size(); ++k)
        scene.triangles.push_back({{first, first + k - 1, first + k}, material});
}

}  // namespace

Placement placed(const glm::dvec3& origin, double turn) {
    const double c = std::cos(turn), s = std::sin(turn);
    return {origin, glm::dmat3({c, 0.0, -s}, {0.0, 1.0, 0.0}, {s, 0.0, c})};
}

Placement along(const glm::dvec3& origin, const glm::dvec3& direction) {
    const glm::dvec3 y = glm::normalize(direction);
    const glm::dvec3 aside = std::abs(y.x) < 0.9 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 z = glm::normalize(glm::cross(aside, y));
    return {origin, glm::dmat3(glm::cross(y, z), y, z)};
}

void add_block(Scene& scene, const Placement& at, const glm::dvec3& low, const glm::dvec3& high,
               std::uint32_t material) {
    const glm::dvec3 size = high - low;
    add_solid(scene, at(low), {at.axes[0] * size.x, at.axes[1] * size.y, at.axes[2] * size.z},
              material);
}

void add_blunt_block(Scene& scene, const Placement& at, const glm::dvec3& low,
                     const glm::dvec3& high, double edge, std::uint32_t material) {
    // The corner of face `axis` beside the corner of the block that `signs` name.
    const auto corner = [&](int axis, const glm::ivec3& signs) {
        glm::dvec3 p;
        for (int i = 0; i < 3; ++i)
            p[i] = signs[i] > 0 ? high[i] - (i == axis ? 0.0 : edge)
                                : low[i] + (i == axis ? 0.0 : edge);
        return p;
    };
    const auto add = [&](std::vector<glm::dvec3> corners, const glm::ivec3& outward) {
        const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
        if (glm::dot(normal, glm::dvec3(outward)) < 0.0)
            std::swap(corners[1], corners[corners.size() - 1]);
        add_face(scene, at, corners, material);
    };
    const int sides[] = {-1, 1};
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (const int side : sides) {
            std::vector<glm::dvec3> face;
            glm::ivec3 signs(0), outward(0);
            signs[axis] = outward[axis] = side;
            for (const auto& [a, b] :
                 {std::array{-1, -1}, std::array{1, -1}, std::array{1, 1}, std::array{-1, 1}}) {
                signs[u] = a;
                signs[v] = b;
                face.push_back(corner(axis, signs));
            }
            add(face, outward);
        }
        // The four edges along `axis`, between the faces of the other two.
        for (const int a : sides)
            for (const int b : sides) {
                glm::ivec3 low_end(0), high_end(0), outward(0);
                low_end[u] = high_end[u] = outward[u] = a;
                low_end[v] = high_end[v] = outward[v] = b;
                low_end[axis] = -1;
                high_end[axis] = 1;
                add({corner(u, low_end), corner(u, high_end), corner(v, high_end),
                     corner(v, low_end)},
                    outward);
            }
    }
    for (const int x : sides)
        for (const int y : sides)
            for (const int z : sides) {
                const glm::ivec3 signs(x, y, z);
                add({corner(0, signs), corner(1, signs), corner(2, signs)}, signs);
            }
}

void add_bar(Scene& scene, const Placement& at, const glm::dvec3& from, const glm::dvec3& to,
             double width, std::uint32_t material) {
    const Placement bar = along(from, to - from);
    const double half = 0.5 * width;
    add_block(scene, at(bar), {-half, 0.0, -half}, {half, glm::length(to - from), half}, material);
}

void add_prism(Scene& scene, const Placement& at, const std::vector<glm::dvec2>& outline,
               double low, double high, std::uint32_t material) {
    std::vector<glm::dvec3> front, back;
    for (const glm::dvec2& p : outline) {
        front.emplace_back(p, high);
        back.insert(back.begin(), {p, low});
    }
    add_face(scene, at, front, material);
    add_face(scene, at, back, material);
    for (std::size_t k = 0; k < outline.size(); ++k) {
        const glm::dvec2 &p = outline[k], &q = outline[(k + 1) % outline.size()];
        add_face(scene, at, {{p, low}, {q, low}, {q, high}, {p, high}}, material);
    }
}

void add_carved(Scene& scene, const Placement& at, const std::vector<double>& x,
                const std::vector<double>& y, const Wood& wood, double thickness,
                const Grain& grain) {
    const int columns = static_cast<int>(x.size()) - 1, rows = static_cast<int>(y.size()) - 1;
    const auto is_wood = [&](int i, int j) {
        return i >= 0 && i < columns && j >= 0 && j < rows && wood(i, j);
    };
    for (int i = 0; i < columns; ++i)
        for (int j = 0; j < rows; ++j) {
            if (is_wood(i, j) == is_wood(i + 1, j + 1) && is_wood(i + 1, j) == is_wood(i, j + 1) &&
                is_wood(i, j) != is_wood(i + 1, j))
                throw Error("scene: carved cells " + std::to_string(i) + ", " + std::to_string(j) +
                            " touch others at a corner alone");
            if (!is_wood(i, j)) continue;
            const std::uint32_t material = grain(i, j);
            const auto u = static_cast<std::size_t>(i), v = static_cast<std::size_t>(j);
            const double x0 = x[u], x1 = x[u + 1], y0 = y[v], y1 = y[v + 1], z = thickness;
            add_face(scene, at, {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}}, material);
            add_face(scene, at, {{x0, y0, 0}, {x0, y1, 0}, {x1, y1, 0}, {x1, y0, 0}}, material);
            if (!is_wood(i - 1, j))
                add_face(scene, at, {{x0, y0, 0}, {x0, y0, z}, {x0, y1, z}, {x0, y1, 0}}, material);
            if (!is_wood(i + 1, j))
                add_face(scene, at, {{x1, y0, 0}, {x1, y1, 0}, {x1, y1, z}, {x1, y0, z}}, material);
            if (!is_wood(i, j - 1))
                add_face(scene, at, {{x0, y0, 0}, {x1, y0, 0}, {x1, y0, z}, {x0, y0, z}}, material);
            if (!is_wood(i, j + 1))
                add_face(scene, at, {{x0, y1, 0}, {x0, y1, z}, {x1, y1, z}, {x1, y1, 0}}, material);
        }
}

void add_carved(Scene& scene, const Placement& at, const std::vector<std::string>& cells,
                const glm::dvec2& cell, double thickness, std::uint32_t material) {
    std::vector<double> x, y;
    for (std::size_t i = 0; i <= cells[0].size(); ++i) x.push_back(cell.x * double(i));
    for (std::size_t j = 0; j <= cells.size(); ++j) y.push_back(cell.y * double(j));
    const Wood wood = [&](int i, int j) {
        return cells[cells.size() - 1 - static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] ==
               '#';
    };
    add_carved(scene, at, x, y, wood, thickness, [=](int, int) { return material; });
}

}  // namespace clgi::generated
