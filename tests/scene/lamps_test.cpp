// Emissive triangles that hang together are one lamp.
// SPDX-License-Identifier: MIT
#include "scene/lamps.hpp"

#include <gtest/gtest.h>

namespace clgi {
namespace {

// One of the two triangles of a quad at x.
std::array<glm::vec3, 3> part_of_quad(float x, bool upper) {
    const glm::vec3 a(x, 0.3f, 0.1f), b(x + 1.0f, 0.3f, 0.1f), c(x + 1.0f, 0.7f, 0.9f),
        d(x, 0.7f, 0.9f);
    if (upper) return {c, d, a};
    return {a, b, c};
}

TEST(Lamps, HangTogetherByCorners) {
    using Numbers = std::vector<std::uint32_t>;
    EXPECT_EQ(lamps_of({}), Numbers());
    EXPECT_EQ(lamps_of({part_of_quad(0, false), part_of_quad(3, false), part_of_quad(0, true),
                        part_of_quad(6, true), part_of_quad(3, true)}),
              Numbers({0, 1, 0, 2, 1}));
    // One corner is enough: quads side by side, of which the middle one comes last.
    EXPECT_EQ(lamps_of({part_of_quad(0, false), part_of_quad(2, true), part_of_quad(1, false),
                        part_of_quad(1, true)}),
              Numbers({0, 0, 0, 0}));
    // Rounding of floats does not part them, a thousandth does.
    auto moved = part_of_quad(0, true);
    for (glm::vec3& corner : moved) corner.x = std::nextafter(corner.x, 2.0f);
    EXPECT_EQ(lamps_of({part_of_quad(0, false), moved}), Numbers({0, 0}));
    for (glm::vec3& corner : moved) corner.x += 1e-3f;
    EXPECT_EQ(lamps_of({part_of_quad(0, false), moved}), Numbers({0, 1}));
}

}  // namespace
}  // namespace clgi
