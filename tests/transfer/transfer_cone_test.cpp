// What masks take to lie in the tangent plane: heights that rounding of the receiver's place makes.
// SPDX-License-Identifier: MIT
#include <cmath>

#include "mask_tools.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Blockers;
using test::Eyes;

CLGI_IN_BOTH_MATHS(Cone);

// A receiver on one axis, far from the origin, which looks along that axis, and a small triangle
// around it so many spacings of floats above its plane. Below four roundings of the place (2^-22 of
// it) the triangle lies in the plane, on whichever axis; above it hides nearly the whole sky.
TEST_P(Cone, LiesInThePlaneBelowTheRoundingOfAnyCoordinate) {
    const float far = 0.875f, spacing = 0x1p-24f;  // of floats from 1/2 to 1
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {1.0f, -1.0f})
            for (const int spacings : {1, 3, 8}) {
                glm::vec4 position(0.0f, 0.0f, 0.0f, 1.0f), normal(0.0f);
                position[axis] = sign * far;
                normal[axis] = 1.0f;
                const Eyes eyes{{position}, {normal}};
                test::Triangle triangle;
                for (int k = 0; k < 3; ++k) {
                    const double turn = 0.4 + 2.0 * k * 3.14159265358979 / 3;
                    triangle[static_cast<std::size_t>(k)][axis] =
                        double{sign * far} + spacings * double{spacing};
                    // An elevation of 2^-24 / 1e-4 and more, far above 2^-16.
                    triangle[static_cast<std::size_t>(k)][(axis + 1) % 3] = 1e-4 * std::cos(turn);
                    triangle[static_cast<std::size_t>(k)][(axis + 2) % 3] = 1e-4 * std::sin(turn);
                }
                const int blocked =
                    test::draw_masks(Blockers({triangle}), eyes, {}, {.math = GetParam()}).count(0);
                // 3.5 spacings are 2^-22 of 7/8.
                const std::string label = std::to_string(axis) + ", " + std::to_string(spacings);
                if (spacings < 4) {
                    EXPECT_EQ(blocked, 0) << label;
                } else {
                    EXPECT_GT(blocked, 400) << label;
                }
            }
}

}  // namespace
}  // namespace clgi
