// Which records' surroundings lobes look up, and how much each counts.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/passes/cache.hpp>
#include <cmath>

#include "glossy_records.hpp"
#include "math_modes.hpp"
#include "shading.hpp"
#include "shares_by_hand.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(GlossRecords);

// Between two records what both have around them counts by their weights; of records that were met
// nothing does, and where there is no other, irradiance by the lobe's mean albedo.
TEST_P(GlossRecords, CountRecordsByTheirWeights) {
    const Material metal = test::finished(1.0f, 0.5f, 1.0f);
    const glm::dvec3 up(0, 1, 0), left(1.0, 2.0, 4.0), right(5.0, 1.0, 0.5);
    Glossy in({metal}, {{{-1, 0, 0}, up}, {{1, 0, 0}, up}}, 8);
    in.fill(0, left);
    in.fill(1, right);
    const std::vector<Point> points = {{{0, 0, 0}}, {{-1, 0, 0}}, {{1, 0, 0}}};
    const LobeAlbedo albedo = lobe_albedo(metal, up, up);
    const double whole = albedo.white + albedo.tint;
    const std::vector<glm::dvec3> both = in.reflected(points);
    const std::vector<glm::dvec3> wanted = {whole * 0.5 * (left + right), whole * left,
                                            whole * right};
    for (std::size_t p = 0; p < 3; ++p)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(both[p][c], wanted[p][c], 0.02 * wanted[p][c]) << p;

    in.of = {1, 1, 1, 8};
    in.words.clear();
    in.fill(0, left);
    in.around = cl::Buffer();
    for (const glm::dvec3& found : in.reflected(points))
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], whole * left[c], 0.02 * whole * left[c]);

    in.of = {0, 2, 0, 8};
    in.words.clear();
    in.around = cl::Buffer();
    const Reflectance means = reflectance(metal);
    for (const glm::dvec3& found : in.reflected(points, 3.0f))
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found[c], 3.0 / pi * double{means.coat + means.lobe}, 1e-5);
}

// Of neighbouring pixels one has a record that was seen, and one none but those that were met.
TEST_P(GlossRecords, ReflectIrradianceWhereNothingElseIsKnown) {
    const Material metal = test::finished(0.8f, 0.5f, 1.0f);
    const glm::dvec3 up(0, 1, 0), aside(1, 0, 0), light(1.0, 2.0, 4.0), base(0.8, 0.5, 0.2);
    Glossy in({metal}, {{{0, 0, 0}, up}, {{0, 0, 0}, aside}}, 8);
    in.of = {1, 1, 1, 8};
    in.fill(0, light);
    const LobeAlbedo albedo = lobe_albedo(metal, up, up);
    const Reflectance means = reflectance(metal);
    const std::vector<glm::dvec3> found =
        in.reflected({{{0, 0, 0}, aside, base}, {{0, 0, 0}, up, base}});
    for (int c = 0; c < 3; ++c) {
        const double even = double{means.coat} + double{means.lobe} * base[c];
        const double known = (albedo.white + albedo.tint * base[c]) * light[c];
        EXPECT_NEAR(found[0][c], even / pi, 1e-5);
        EXPECT_NEAR(found[1][c], known, 0.02 * known);
    }
}

// Of records that pixels see, one that was met, and refined ones, each with its own colour.
TEST_P(GlossRecords, FindWhatEachRecordHasAroundIt) {
    const Material metal = test::finished(1.0f, 0.5f, 1.0f);
    const glm::dvec3 up(0, 1, 0);
    const std::vector<glm::dvec3> places = {
        {-1, 0, 0}, {0.4, 0, 0.5}, {0.2, 0, -0.6}, {1, 0, 0}, {0.5, 0, 1.1}};
    const std::vector<glm::dvec3> colours = {{1, 2, 4}, {5, 1, 0.5}, {}, {0.2, 7, 1}, {3, 0.1, 9}};
    std::vector<test::RecordPlace> records;
    for (const glm::dvec3& place : places) records.push_back({place, up});
    Glossy in({metal}, records, 8);
    in.of = {2, 1, 4, 8};
    for (std::uint32_t slot = 0; slot < 4; ++slot)
        in.fill(slot, colours[slot < 2 ? slot : slot + 1]);
    const std::vector<Point> points = {
        {{0.1, 0, 0.1}}, {{-0.6, 0, 0.2}}, {{0.9, 0, 0.1}}, {{0.45, 0, 0.8}}};
    const LobeAlbedo albedo = lobe_albedo(metal, up, up);
    const std::vector<glm::dvec3> found = in.reflected(points);
    for (std::size_t p = 0; p < points.size(); ++p) {
        const std::vector<glm::dvec3> normals(places.size(), up);
        const std::vector<double> share = carried_by_hand(
            shares_by_hand(places, normals, points[p].place, up), places, points[p].place);
        glm::dvec3 wanted(0.0);
        for (std::size_t i = 0; i < places.size(); ++i) wanted += share[i] * colours[i];
        wanted *= (albedo.white + albedo.tint) / (1.0 - share[2]);
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[p][c], wanted[c], 0.02 * wanted[c]) << p;
    }
}

}  // namespace
}  // namespace clgi
