// Whether a triangle of texture coordinates covers the centre of a texel.
//
// Half-plane tests in double precision on the texture coordinates as they are. An edge is tested
// from its lesser to its greater end whichever triangle asks, so that two triangles that share it
// see exactly opposite signs; what lies on it goes to the side that the direction of the edge says.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>

namespace clgi {

// Twice the area of (a, b, p); exactly the negative of that of (b, a, p).
inline double doubled_area(glm::dvec2 a, glm::dvec2 b, const glm::dvec2& p) {
    const bool swapped = b.x < a.x || (b.x == a.x && b.y < a.y);
    if (swapped) std::swap(a, b);
    const double area = (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    return swapped ? -area : area;
}

class TexelCentre {
public:
    // corner: in the unit square. size: texels, its side.
    TexelCentre(const std::array<glm::dvec2, 3>& corner, int size)
        : corner_(corner),
          size_(size),
          whole_(doubled_area(corner[0], corner[1], corner[2])),
          sign_(whole_ > 0.0 ? 1.0 : -1.0) {}  // charts may be mirrored

    bool without_area() const { return whole_ == 0.0; }

    // b1, b2: weights of the second and third corner at the centre, if it is covered.
    bool covers(int column, int row, double& b1, double& b2) const {
        const glm::dvec2 centre((column + 0.5) / size_, (row + 0.5) / size_);
        double weight[3];
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dvec2& a = corner_[(k + 1) % 3];
            const glm::dvec2& b = corner_[(k + 2) % 3];
            weight[k] = sign_ * doubled_area(a, b, centre);
            if (!(weight[k] > 0.0 || (weight[k] == 0.0 && owns_edge(sign_ * (b - a)))))
                return false;
        }
        b1 = weight[1] / std::abs(whole_);
        b2 = weight[2] / std::abs(whole_);
        return true;
    }

private:
    static bool owns_edge(const glm::dvec2& along) {
        return along.y > 0.0 || (along.y == 0.0 && along.x > 0.0);
    }

    std::array<glm::dvec2, 3> corner_;
    int size_;
    double whole_, sign_;
};

}  // namespace clgi
