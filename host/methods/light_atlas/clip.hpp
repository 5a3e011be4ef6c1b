// The part of a triangle that lies in the square of a texel.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <glm/glm.hpp>

namespace clgi {

struct ClippedPart {
    double area = 0.0;                      // texels^2
    glm::dvec2 centroid = glm::dvec2(0.0);  // texels, of the page
};

// Keeps what lies on one side of a line across an axis: sign * (p[axis] - bound) >= 0.
struct TexelPolygon {
    // 13 points is the most that four lines can make of a triangle, whatever the rounding.
    std::array<glm::dvec2, 16> point;
    std::size_t count = 0;

    void keep(int axis, double bound, double sign) {
        std::array<glm::dvec2, 16> kept;
        std::size_t next = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const glm::dvec2 &a = point[i], &b = point[(i + 1) % count];
            const double from = sign * (a[axis] - bound), to = sign * (b[axis] - bound);
            if (from >= 0.0) kept[next++] = a;
            if ((from > 0.0 && to < 0.0) || (from < 0.0 && to > 0.0)) {
                kept[next] = a + (from / (from - to)) * (b - a);
                kept[next++][axis] = bound;
            }
        }
        point = kept;
        count = next;
    }
};

// corner: in texels. The triangle may be wound either way.
inline ClippedPart clip_to_texel(const std::array<glm::dvec2, 3>& corner, int column, int row) {
    const glm::dvec2 first(column, row);
    TexelPolygon polygon;
    for (const glm::dvec2& c : corner) polygon.point[polygon.count++] = c - first;
    for (int axis = 0; axis < 2; ++axis) {
        polygon.keep(axis, 0.0, 1.0);
        polygon.keep(axis, 1.0, -1.0);
    }
    ClippedPart out;
    glm::dvec2 moment(0.0);
    for (std::size_t i = 2; i < polygon.count; ++i) {
        const glm::dvec2 a = polygon.point[i - 1] - polygon.point[0],
                         b = polygon.point[i] - polygon.point[0];
        const double area = 0.5 * (a.x * b.y - a.y * b.x);
        out.area += area;
        moment += area * (a + b) / 3.0;
    }
    if (out.area != 0.0) out.centroid = first + polygon.point[0] + moment / out.area;
    out.area = glm::abs(out.area);
    return out;
}

}  // namespace clgi
