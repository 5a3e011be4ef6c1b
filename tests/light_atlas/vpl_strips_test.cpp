// VPLs on narrow regions: how many they have against closed forms, and where they lie.
// SPDX-License-Identifier: MIT
#include "lab/scenes/rooms.hpp"
#include "methods/light_atlas/strips.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/advanced/vpl_layout.hpp>
#include <clgi/procedural.hpp>
#include <cmath>

#include "scenes.hpp"
#include "walls.hpp"

namespace clgi {
namespace {

using test::position;

Region region_of(double area, bool double_sided = false) {
    Region out;
    out.area = area;
    out.double_sided = double_sided;
    return out;
}

// The density that one rectangle among much else is given; VPLs of a quarter of a square metre.
double density_of(double length, double width, double most) {
    std::vector<Region> regions{region_of(1e9), region_of(length * width)};
    raise_density(regions, {4e4, length}, 0.25, most);
    EXPECT_EQ(regions[0].density, 1.0);
    return regions[1].density;
}

TEST(RaiseDensity, GoesAsTheInverseSquareOfTheWidth) {
    EXPECT_NEAR(density_of(2.0, 0.1, 1000.0), 25.0, 1e-12);
    EXPECT_NEAR(density_of(1.0, 0.05, 1000.0), 100.0, 1e-12);
    EXPECT_EQ(density_of(1.0, 0.05, 20.0), 20.0);
    EXPECT_EQ(density_of(1.0, 0.05, 1.0), 1.0);
    EXPECT_NEAR(density_of(2.0, 0.49, 20.0), 0.25 / (0.49 * 0.49), 1e-12);
    EXPECT_EQ(density_of(3.0, 0.51, 20.0), 1.0);  // wider than VPLs are apart
    EXPECT_EQ(density_of(0.39, 0.1, 20.0), 1.0);  // less than four times as long as wide
    EXPECT_NEAR(density_of(0.41, 0.1, 20.0), 20.0, 1e-12);
}

TEST(RaiseDensity, LeavesThreeQuartersOfAllVplsToTheShareByArea) {
    // 10 m^2 of strips on 100 m^2: 20 times as dense they would take 200 of 290.
    std::vector<Region> regions{region_of(90.0), region_of(4.0), region_of(3.0, true)};
    raise_density(regions, {9.0, 80.0, 60.0}, 1.0, 20.0);
    double even = 0.0, all = 0.0;
    for (const Region& r : regions) {
        const double area = (r.double_sided ? 2.0 : 1.0) * r.area;
        even += area;
        all += area * r.density;
    }
    EXPECT_EQ(regions[0].density, 1.0);
    EXPECT_EQ(regions[1].density, regions[2].density);
    EXPECT_NEAR((all - even) / all, 0.25, 1e-12);
}

TEST(StretchOf, MakesCellsTenTimesAsLongAsWideAtMost) {
    EXPECT_EQ(stretch_of({2.0, 0.1, 0.0}), glm::dvec3(1.0, 10.0, 1.0));
    EXPECT_EQ(stretch_of({0.1, 2.0, 0.3}), glm::dvec3(10.0, 1.0, 1.0));
    EXPECT_EQ(stretch_of({0.5, 2.0, 0.0}), glm::dvec3(4.0, 1.0, 1.0));
    EXPECT_EQ(stretch_of({2.0, 0.0, 0.0}), glm::dvec3(1.0));
}

// A floor of 16 m^2 and a strip of 2 m by 5 cm beside it.
Scene floor_and_strip() {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 2.0);
    test::add_quad(scene, {glm::dvec3(3, 0, 0), {5, 0, 0}, {5, 0.05, 0}, {3, 0.05, 0}});
    return scene;
}

struct Shares {
    std::vector<VplSite> floor, strip;
};

Shares shares_of(const VplLayout& layout) {
    Shares out;
    for (const VplSite& vpl : layout.vpls)
        (vpl.triangle < 2 ? out.floor : out.strip).push_back(vpl);
    return out;
}

TEST(VplsOnStrips, AreAsManyAsTheDensitySays) {
    const Scene scene = floor_and_strip();
    const Patches patches = make_patches(scene);
    for (const std::uint32_t n : {200u, 400u, 1000u, 6000u})
        for (const double most : {1.0, 5.0, 20.0}) {
            const VplLayout layout = place_vpls(
                scene, patches, {.count = n, .samples_per_vpl = 30, .gap_density = most});
            EXPECT_EQ(layout.vpls.size(), n);
            const double density = std::max(1.0, std::min(most, 16.1 / n / (0.05 * 0.05)));
            const double weight = 16.0 + 0.1 * density;
            const Shares shares = shares_of(layout);
            EXPECT_NEAR(double(shares.strip.size()), std::max(1.0, 0.1 * density / weight * n),
                        0.51)
                << n << " " << most;
            // The samples too, and all together they are as many as wanted.
            double on_strip = 0.0, area = 0.0;
            for (const VplSite& vpl : shares.strip) on_strip += vpl.sample_count;
            EXPECT_NEAR(on_strip, 0.1 * density / weight * n * 30, 0.51) << n << " " << most;
            EXPECT_NEAR(double(layout.samples.size()), 30.0 * n, 1.0);
            // A_j = m_j C_r.
            for (const VplSite& vpl : shares.strip) {
                EXPECT_NEAR(vpl.area, vpl.sample_count * 0.1 / on_strip, 1e-6 * vpl.area);
                area += double{vpl.area};
            }
            EXPECT_NEAR(area, 0.1, 1e-7);
        }
}

TEST(VplsOnStrips, LieSideBySideInLongCells) {
    const Scene scene = floor_and_strip();
    const Patches patches = make_patches(scene);
    const VplLayout layout =
        place_vpls(scene, patches, {.count = 400, .samples_per_vpl = 30, .gap_density = 20.0});
    const Shares shares = shares_of(layout);
    // Evenly spread, and samples belong to the nearest, where the strip is ten times as wide.
    const glm::dvec3 stretch(1.0, 10.0, 1.0);
    std::vector<glm::dvec3> places;
    double lowest = 1.0, highest = 0.0;
    for (const VplSite& vpl : shares.strip) {
        const glm::dvec3 p = position(scene, vpl);
        places.push_back(stretch * p);
        lowest = std::min(lowest, p.y);
        highest = std::max(highest, p.y);
    }
    ASSERT_GT(places.size(), 30u);
    EXPECT_GT(test::least_distance(places, 1.0), 0.5);
    EXPECT_LT(lowest, 0.0125);  // in each of at least four rows
    EXPECT_GT(highest, 0.0375);
    for (std::size_t v = 0; v < places.size(); ++v)
        for (std::uint32_t i = 0; i < shares.strip[v].sample_count; ++i) {
            const glm::dvec3 p =
                stretch * position(scene, layout.samples[shares.strip[v].first_sample + i]);
            for (const glm::dvec3& other : places)
                EXPECT_LE(glm::length(p - places[v]), glm::length(p - other) * (1 + 1e-9) + 1e-12);
        }
    // The floor is as even as ever.
    std::vector<glm::dvec3> floor;
    for (const VplSite& vpl : shares.floor) floor.push_back(position(scene, vpl));
    EXPECT_GT(test::least_distance(floor, 16.0), 0.5);
}

// Both sides of the gap at the hinge of a door, and nothing but narrow regions, become denser.
TEST(VplsOnStrips, AreDenseOnTheEdgesOfDoors) {
    const Scene scene = corridor();
    const Patches patches = make_patches(scene);
    const auto per_area = [&](double most) {
        const VplLayout layout = place_vpls(scene, patches, {.gap_density = most});
        EXPECT_EQ(layout.vpls.size(), 1600u);
        double leaves = 0.0, jambs = 0.0, rest = 0.0;
        for (const VplSite& vpl : layout.vpls) {
            const double area = patches.patches[patches.triangle_patch[vpl.triangle]].area;
            (std::abs(area - 0.0812) < 1e-4  ? leaves
             : std::abs(area - 0.246) < 1e-4 ? jambs
                                             : rest) += 1.0;
        }
        return glm::dvec3(leaves / (12 * 0.0812), jambs / (12 * 0.246), rest);
    };
    const glm::dvec3 even = per_area(1.0), dense = per_area(20.0);
    EXPECT_GT(dense.x, 4.0 * even.x);  // one each before, which is more than their share
    EXPECT_GT(dense.y, 10.0 * even.y);
    EXPECT_GT(dense.z, 0.8 * even.z);
}

}  // namespace
}  // namespace clgi
