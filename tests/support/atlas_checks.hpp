// What holds for every atlas layout, and the scenes that the tests of atlases make.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/atlas_layout.hpp>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "geometry.hpp"
#include "scenes.hpp"

namespace clgi::test {

constexpr std::uint32_t no_region = 0xffffffffu;

inline AtlasOptions made_charts(int size, int padding = 2, int pages = 1) {
    AtlasOptions out;
    out.size = size;
    out.uvs = AtlasUvs::charts;
    out.padding = padding;
    out.most_pages = pages;
    return out;
}

// A region for every `each` triangles.
inline std::vector<std::uint32_t> regions(const Scene& scene, std::uint32_t each) {
    std::vector<std::uint32_t> out(scene.triangles.size());
    for (std::uint32_t t = 0; t < out.size(); ++t) out[t] = each == 0 ? 0 : t / each;
    return out;
}

inline glm::dvec3 place_of(const Scene& scene, const AtlasTexel& texel) {
    const glm::dvec3 a = geometry::corner(scene, texel.triangle, 0);
    return a + double{texel.b1} * (geometry::corner(scene, texel.triangle, 1) - a) +
           double{texel.b2} * (geometry::corner(scene, texel.triangle, 2) - a);
}

// Column and row, in texels of the page.
inline glm::dvec2 corner_of(const AtlasTexel& texel, int size) {
    const auto side = static_cast<std::uint32_t>(size);
    return {texel.texel % side, texel.texel / side % side};
}

inline double area_of(const std::vector<AtlasTexel>& texels) {
    double sum = 0.0;
    for (const AtlasTexel& texel : texels) sum += double{texel.area};
    return sum;
}

// Shares of texels, in order, inside their triangles and where the uvs say; area complete.
inline void expect_sound(const Scene& scene, const AtlasLayout& atlas) {
    const double size = atlas.size, digit = size * 0x1p-20;
    std::uint32_t last = 0;
    std::size_t wrong_order = 0, wrong_place = 0, wrong_share = 0, wrong_owner = 0;
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const AtlasTexel& texel = atlas.texels[i];
        wrong_order += i > 0 && texel.texel <= last;
        last = texel.texel;
        wrong_share += !(texel.coverage > 0.0f && texel.coverage <= 1.0f && texel.area >= 0.0f);
        wrong_share += !(texel.b1 >= 0.0f && texel.b2 >= 0.0f && texel.b1 + texel.b2 <= 1.0f);
        wrong_owner += atlas.triangle_chart[texel.triangle] != texel.chart;
        const AtlasChart& chart = atlas.charts[texel.chart];
        const glm::dvec2 first = corner_of(texel, atlas.size);
        const auto page = static_cast<int>(texel.texel / (size * size));
        wrong_owner += page != chart.page || first.x < chart.column || first.y < chart.row ||
                       first.x >= chart.column + chart.width || first.y >= chart.row + chart.height;
        const glm::dvec2 a = atlas.uvs[3 * texel.triangle], b = atlas.uvs[3 * texel.triangle + 1],
                         c = atlas.uvs[3 * texel.triangle + 2];
        const glm::dvec2 at = a + double{texel.b1} * (b - a) + double{texel.b2} * (c - a) - first;
        if (texel.centre)
            wrong_place += glm::distance(at, glm::dvec2(0.5)) > digit;
        else
            wrong_place += at.x < -digit || at.y < -digit || at.x > 1 + digit || at.y > 1 + digit;
    }
    EXPECT_EQ(wrong_order, 0u);
    EXPECT_EQ(wrong_share, 0u);
    EXPECT_EQ(wrong_owner, 0u);
    EXPECT_EQ(wrong_place, 0u);
    const double whole = geometry::area(scene);
    EXPECT_NEAR(area_of(atlas.texels) + atlas.skipped_area, whole, 1e-6 * whole);
    std::set<std::uint32_t> listed;
    for (const AtlasTexel& texel : atlas.texels) listed.insert(texel.texel);
    for (const AtlasDilated& dilated : atlas.dilated)
        EXPECT_TRUE(listed.insert(dilated.texel).second) << "listed, or dilated twice";
}

// Boxes with their padding share no texel, and keep to their pages.
inline void expect_apart(const AtlasLayout& atlas, int padding) {
    const int side = atlas.size + 2 * padding;
    std::vector<bool> taken(static_cast<std::size_t>(side * side * atlas.pages));
    std::size_t twice = 0;
    for (const AtlasChart& chart : atlas.charts) {
        ASSERT_GE(chart.page, 0);
        ASSERT_LT(chart.page, atlas.pages);
        ASSERT_GE(std::min(chart.column, chart.row), 0);
        ASSERT_GE(std::min(chart.width, chart.height), 1);
        ASSERT_LE(std::max(chart.column + chart.width, chart.row + chart.height), atlas.size);
        for (int y = chart.row; y < chart.row + chart.height + 2 * padding; ++y)
            for (int x = chart.column; x < chart.column + chart.width + 2 * padding; ++x) {
                const auto at = static_cast<std::size_t>((chart.page * side + y) * side + x);
                twice += taken[at];
                taken[at] = true;
            }
    }
    EXPECT_EQ(twice, 0u);
}

// For charts of flat regions: every triangle has its size, and texels sum up to the surface.
inline void expect_true_to_scale(const Scene& scene, const AtlasLayout& atlas) {
    const double density = atlas.texels_per_metre;
    std::vector<double> wanted(atlas.charts.size()), got(atlas.charts.size());
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (atlas.triangle_chart[t] == no_region) continue;
        wanted[atlas.triangle_chart[t]] += 0.5 * glm::length(geometry::doubled_area(scene, t));
        for (std::size_t k = 0; k < 3; ++k) {
            const double side =
                glm::distance(geometry::corner(scene, t, static_cast<int>(k)),
                              geometry::corner(scene, t, static_cast<int>(k + 1) % 3));
            const double length = glm::distance(glm::dvec2(atlas.uvs[3 * t + k]),
                                                glm::dvec2(atlas.uvs[3 * t + (k + 1) % 3]));
            EXPECT_NEAR(length, side * density, atlas.size * 0x1p-22 + 1e-6 * length);
        }
    }
    for (const AtlasTexel& texel : atlas.texels)
        got[texel.chart] += double{texel.coverage} / (density * density);
    for (std::size_t i = 0; i < got.size(); ++i)
        EXPECT_NEAR(got[i], wanted[i], 1e-6 * wanted[i]) << "chart " << i;
}

inline Scene turned(Scene scene, const glm::dvec3& offset = glm::dvec3(0.0)) {
    const glm::dvec3 z = glm::normalize(glm::dvec3(1, 2, 3));
    const glm::dvec3 x = glm::normalize(glm::cross(glm::dvec3(0, 1, 0.2), z));
    const glm::dmat3 turn(x, glm::cross(z, x), z);
    for (glm::dvec3& position : scene.positions) position = turn * position + offset;
    for (glm::vec3& normal : scene.normals)
        normal = glm::vec3(glm::normalize(turn * glm::dvec3(normal)));
    return scene;
}

// Rings from pole to pole, of triangles that share their vertices' positions.
inline Scene sphere(int rings, int spokes) {
    Scene scene = plain_scene();
    const auto at = [&](int ring, int spoke) {
        const double polar = std::numbers::pi * ring / rings;
        const double azimuth = 2 * std::numbers::pi * (spoke % spokes) / spokes;
        if (ring == 0) return glm::dvec3(0, 1, 0);
        if (ring == rings) return glm::dvec3(0, -1, 0);
        return glm::dvec3(std::sin(polar) * std::cos(azimuth), std::cos(polar),
                          std::sin(polar) * std::sin(azimuth));
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int spoke = 0; spoke < spokes; ++spoke) {
            const glm::dvec3 a = at(ring, spoke), b = at(ring, spoke + 1);
            const glm::dvec3 c = at(ring + 1, spoke + 1), d = at(ring + 1, spoke);
            if (ring > 0) add_triangle(scene, a, b, c);
            if (ring < rings - 1) add_triangle(scene, a, c, d);
        }
    return scene;
}

}  // namespace clgi::test
