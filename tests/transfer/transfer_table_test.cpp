// The table of planes: its entries, and what rounding planes costs.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "mask_tools.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Drawn;
using test::Eyes;
using test::Triangle;

CLGI_IN_BOTH_MATHS(PlaneTable);

// Every entry against its plane, bit by bit: 1, u and v as components face, face + 1, face + 2.
TEST_P(PlaneTable, HoldsTheDirectionsInFrontOfEachPlane) {
    for (const int size : {8, 32, 64}) {
        MaskOptions masks;
        masks.size = size;
        masks.planes = EdgePlanes::table;
        masks.table_size = 24;
        const cl::Buffer table = test::empty<char>(mask_table_bytes(masks));
        test::mask_passes(masks, {.math = GetParam()})
            .planes(test::device().queue, test::upload(pixel_heights(size)), table);
        const auto words = test::download<cl_uint>(table, mask_table_bytes(masks) / 4);
        const int columns = MASK_COLUMNS(size);
        std::size_t entry = 0;
        for (int face = 0; face < 3; ++face)
            for (int v = 0; v < 24; ++v)
                for (int u = 0; u < 24; ++u, ++entry) {
                    glm::dvec3 n(1.0);
                    n[(face + 1) % 3] = (2 * u + 1) / 24.0 - 1.0;
                    n[(face + 2) % 3] = (2 * v + 1) / 24.0 - 1.0;
                    std::size_t bits = 0, found = 0;
                    for (const test::Pixel& p : test::disc_pixels(size)) {
                        const double front = glm::dot(n, p.direction);
                        const bool bit =
                            words[entry * MASK_WORDS(size) + p.row / 32 * columns + p.column] >>
                                (p.row % 32) &
                            1;
                        bits += bit;
                        if (std::abs(front) > 1e-6) {
                            ASSERT_EQ(bit, front > 0) << entry;
                        }
                    }
                    for (int word = 0; word < MASK_WORDS(size); ++word)
                        found += __builtin_popcount(words[entry * MASK_WORDS(size) + word]);
                    ASSERT_EQ(found, bits) << "pixels outside the disc, " << entry;
                }
    }
    EXPECT_EQ(mask_table_bytes({.planes = EdgePlanes::table}), 6291456u);  // half of the paper's
}

// The entry that a plane is rounded to, against the plane: how many bits differ.
// Of 812, 2.364 on average for Q = 64, 1.185 for 128 and 0.576 for 256; 16, 9 and 5 at most.
TEST(PlaneTableEntries, DifferInFewBitsFromPlanesRoundedToThem) {
    test::Random random(7);
    std::vector<glm::dvec3> planes;
    for (int i = 0; i < 1500; ++i) {
        glm::dvec3 n;
        do n = glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1));
        while (glm::dot(n, n) > 1.0 || glm::dot(n, n) < 0.01);
        planes.push_back(glm::normalize(n));
    }
    const std::pair<int, std::array<double, 2>> cases[] = {
        {64, {2.364, 17}}, {128, {1.185, 10}}, {256, {0.576, 7}}};
    for (const auto& [size, expected] : cases) {
        MaskOptions masks;
        masks.planes = EdgePlanes::table;
        masks.table_size = size;
        const cl::Buffer& table = test::mask_table(masks);
        const auto words = test::download<cl_uint>(table, mask_table_bytes(masks) / 4);
        double sum = 0.0, most = 0.0;
        for (const glm::dvec3& n : planes) {
            int face = 0;
            for (int k = 1; k < 3; ++k)
                if (std::abs(n[k]) > std::abs(n[face])) face = k;
            const auto texel = [&](int k) {
                return std::clamp(static_cast<int>((n[k % 3] / n[face] + 1) / 2 * size), 0,
                                  size - 1);
            };
            const std::size_t entry =
                (std::size_t(face) * size + texel(face + 2)) * size + texel(face + 1);
            int flips = 0;
            for (const test::Pixel& p : test::disc_pixels(32)) {
                const bool bit = words[entry * 32 + p.column] >> p.row & 1;
                flips += (bit != (n[face] < 0)) != (glm::dot(n, p.direction) > 0);
            }
            sum += flips;
            most = std::max(most, double(flips));
        }
        // Of 1500 planes: three standard errors of a mean whose deviation is about its value.
        EXPECT_NEAR(sum / planes.size(), expected[0], 0.08 * expected[0]) << size;
        EXPECT_LE(most, expected[1]) << size;
    }
}

// Share of the hemisphere that a triangle covers, cosine included [Lambert]: the part above the
// horizon, so the triangle is clipped there.
double share(const Triangle& triangle) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 a = triangle[i], b = triangle[(i + 1) % 3];
        if (a.z >= 0) corners.push_back(a);
        if ((a.z >= 0) != (b.z >= 0)) corners.push_back(a + a.z / (a.z - b.z) * (b - a));
    }
    double sum = 0.0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = corners[i], b = corners[(i + 1) % corners.size()];
        const glm::dvec3 c = glm::cross(a, b);
        if (glm::length(c) > 0.0)
            sum += std::atan2(glm::length(c), glm::dot(a, b)) * c.z / glm::length(c);
    }
    return std::abs(sum) / 6.283185307179586;
}

// r11, 1500 random triangles, root mean square error of the share: exact planes 0.00465 (R = 16),
// 0.00161 (32), 0.00057 (64), 0.00023 (128); with tables at R = 32 0.00309 (Q = 32), 0.00216 (64),
// 0.00170 (128), 0.00166 (256).
TEST_P(PlaneTable, CostsLittleBesideTheMask) {
    test::Random random(4);
    std::vector<Triangle> triangles;
    while (triangles.size() < 1500) {
        const Triangle t = test::random_triangle(random);
        if (share(t) > 1e-4) triangles.push_back(t);
    }
    Eyes eyes;
    eyes.positions.resize(triangles.size(), eyes.positions[0]);
    eyes.normals.resize(triangles.size(), eyes.normals[0]);
    const test::Blockers blockers = test::one_each(triangles);
    const auto error = [&](int size, int table_size) {
        MaskOptions masks;
        masks.size = size;
        masks.planes = table_size ? EdgePlanes::table : EdgePlanes::exact;
        if (table_size) masks.table_size = table_size;
        const Drawn drawn = test::draw_masks(blockers, eyes, masks, {.math = GetParam()});
        const double pixels = static_cast<double>(test::disc_pixels(size).size());
        double squares = 0.0, bias = 0.0;
        for (std::size_t i = 0; i < triangles.size(); ++i) {
            const double e = drawn.count(i) / pixels - share(triangles[i]);
            squares += e * e;
            bias += e;
        }
        EXPECT_LT(std::abs(bias) / triangles.size(), 3e-4) << size << ", " << table_size;
        return std::sqrt(squares / triangles.size());
    };
    const double exact[4] = {error(16, 0), error(32, 0), error(64, 0), error(128, 0)};
    // Other triangles of about the same sizes: within a third.
    const double r11[4] = {.00465, .00161, .00057, .00023};
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(exact[k], r11[k], 0.33 * r11[k]) << k;
        std::printf("[          ] exact planes, R = %d: %.5f\n", 16 << k, exact[k]);
    }
    const double table[4] = {error(32, 32), error(32, 64), error(32, 128), error(32, 256)};
    const double r11_table[4] = {.00309, .00216, .00170, .00166};
    for (int k = 0; k < 4; ++k) {
        EXPECT_NEAR(table[k], r11_table[k], 0.33 * r11_table[k]) << k;
        std::printf("[          ] table, Q = %d: %.5f\n", 32 << k, table[k]);
    }
    EXPECT_LT(table[2], 1.15 * exact[1]);
}

// The planes of a narrow triangle's long edges are rounded apart; where they meet far from it,
// nothing is drawn (STABILITY 2.4).
TEST_P(PlaneTable, DrawsSliversNearThemselvesAlone) {
    test::Random random(23);
    std::vector<Triangle> slivers;
    while (slivers.size() < 3000) {
        const glm::dvec3 middle(random(-1, 1), random(-1, 1), random(0, 1));
        if (glm::length(middle) < 0.1) continue;
        const glm::dvec3 d = glm::normalize(middle);
        const glm::dvec3 u =
            glm::normalize(glm::cross(d, glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1))));
        const double length = random(0.02, 0.3), width = std::pow(10.0, random(-4, -2));
        const Triangle sliver = {d - 0.5 * length * u, d + 0.5 * length * u,
                                 d + width * glm::cross(d, u)};
        bool above = true;
        for (const glm::dvec3& corner : sliver) above = above && corner.z > 0.02;
        if (above) slivers.push_back(sliver);
    }
    Eyes eyes;
    eyes.positions.resize(slivers.size(), eyes.positions[0]);
    eyes.normals.resize(slivers.size(), eyes.normals[0]);
    const Drawn drawn =
        test::draw_masks(test::one_each(slivers), eyes, {.size = 32, .planes = EdgePlanes::table},
                         {.math = GetParam()});
    int pixels = 0;
    for (std::size_t i = 0; i < slivers.size(); ++i) {
        glm::dvec2 low(1.0), high(-1.0);
        for (const glm::dvec3& corner : slivers[i]) {
            low = glm::min(low, glm::dvec2(glm::normalize(corner)));
            high = glm::max(high, glm::dvec2(glm::normalize(corner)));
        }
        for (int column = 0; column < 32; ++column)
            for (int row = 0; row < 32; ++row) {
                if (!drawn.bit(i, column, row)) continue;
                ++pixels;
                const glm::dvec2 at((2 * column + 1) / 32.0 - 1, (2 * row + 1) / 32.0 - 1);
                const glm::dvec2 beyond = glm::max(low - at, at - high);
                // A pixel around the box, and half of one for the bulge of the arcs.
                EXPECT_LT(std::max(beyond.x, beyond.y), 1.6 / 16) << i;
            }
    }
    EXPECT_GT(pixels, 100);
}

}  // namespace
}  // namespace clgi
