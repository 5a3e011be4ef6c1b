// From linear sRGB to CIE XYZ and L*a*b*, relative to the white of sRGB (D65).
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace clgi::lab {

// X/Xn, Y/Yn and Z/Zn of linear sRGB: white is (1, 1, 1). The primaries' chromaticities of
// IEC 61966-2-1 as exact fractions, every row over its own sum.
inline const glm::dmat3 relative_xyz_from_rgb =
    glm::transpose(glm::dmat3(glm::dvec3(10135552.0, 8788810.0, 4435075.0) / 23359437.0,
                              glm::dvec3(2613072.0, 8788810.0, 887015.0) / 12288897.0,
                              glm::dvec3(1425312.0, 8788810.0, 70074185.0) / 80288307.0));
inline const glm::dmat3 rgb_from_relative_xyz = glm::inverse(relative_xyz_from_rgb);

// CIE 15: L* 0 to 100, a* and b*.
inline glm::dvec3 lab(const glm::dvec3& relative_xyz) {
    constexpr double delta = 6.0 / 29.0;
    const auto f = [](double t) {
        return t > delta * delta * delta ? std::cbrt(t) : t / (3.0 * delta * delta) + 4.0 / 29.0;
    };
    const double x = f(relative_xyz.x), y = f(relative_xyz.y), z = f(relative_xyz.z);
    return {116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)};
}

}  // namespace clgi::lab
