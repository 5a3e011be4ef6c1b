// Radiosity of the inside of the unit cube in double precision: faces of cells, form factors from
// the middle of a cell to another cell by the contour integral.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace clgi::test {

// From a point with this normal to a polygon that lies in front of it.  [Lambert 1760]
inline double form_factor(const glm::dvec3& at, const glm::dvec3& normal,
                          const std::array<glm::dvec3, 4>& corners) {
    double sum = 0.0;
    for (std::size_t k = 0; k < 4; ++k) {
        const glm::dvec3 a = glm::normalize(corners[k] - at);
        const glm::dvec3 b = glm::normalize(corners[(k + 1) % 4] - at);
        const glm::dvec3 across = glm::cross(a, b);
        const double length = glm::length(across);
        if (length > 0.0)
            sum += std::atan2(length, glm::dot(a, b)) * glm::dot(across, normal) / length;
    }
    return std::abs(sum) / (2.0 * std::numbers::pi);
}

// Mean irradiance that each face receives by reflection when face 0 has the direct irradiance 1
// and all reflect `albedo`; `bounces` reflections. Faces are numbered as by face_of(): the one that
// lies opposite to face f is (f + 3) % 6.
inline std::array<double, 6> cube_irradiance(double albedo, int cells, int bounces) {
    struct Cell {
        int face;
        glm::dvec3 middle, normal;
        std::array<glm::dvec3, 4> corners;
    };
    std::vector<Cell> all;
    for (int face = 0; face < 6; ++face)
        for (int row = 0; row < cells; ++row)
            for (int column = 0; column < cells; ++column) {
                const int axis = face % 3, u = (axis + 1) % 3, v = (axis + 2) % 3;
                Cell cell{face, {}, glm::dvec3(0.0), {}};
                cell.normal[axis] = face < 3 ? 1.0 : -1.0;
                for (std::size_t k = 0; k < 4; ++k) {
                    cell.corners[k][axis] = face < 3 ? 0.0 : 1.0;
                    cell.corners[k][u] = (column + (k == 1 || k == 2)) / double(cells);
                    cell.corners[k][v] = (row + (k >= 2)) / double(cells);
                }
                cell.middle = 0.5 * (cell.corners[0] + cell.corners[2]);
                all.push_back(cell);
            }
    const std::size_t n = all.size();
    std::vector<double> factors(n * n, 0.0);
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i)
            if (all[i].face != all[j].face)
                factors[j * n + i] = form_factor(all[j].middle, all[j].normal, all[i].corners);
    std::vector<double> received(n, 0.0), shot(n), next(n);
    for (std::size_t i = 0; i < n; ++i) shot[i] = all[i].face == 0 ? albedo : 0.0;
    for (int k = 0; k < bounces; ++k) {
        for (std::size_t j = 0; j < n; ++j) {
            double sum = 0.0;
            for (std::size_t i = 0; i < n; ++i) sum += factors[j * n + i] * shot[i];
            received[j] += sum;
            next[j] = albedo * sum;
        }
        shot.swap(next);
    }
    std::array<double, 6> means{};
    for (std::size_t i = 0; i < n; ++i) means[static_cast<std::size_t>(all[i].face)] += received[i];
    for (double& mean : means) mean /= cells * cells;
    return means;
}

}  // namespace clgi::test
