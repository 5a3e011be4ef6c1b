// Every form in which a file may store keys, against functions that they interpolate exactly.
// SPDX-License-Identifier: MIT
#include <cmath>

#include "posing.hpp"

namespace clgi {
namespace {

using test::GltfDraft;
using test::json;
using test::posed_at;

constexpr double curve_error = 2e-7;  // rotations are floats

// Tangents that no key reads are -50 and the like. t^3, t^2 and -t are their own cubics.
TEST(GltfCurves, CubicTranslationsHaveTangentsBesideTheirValues) {
    GltfDraft draft = test::triangle_draft();
    const int values = draft.vec3(
        {{-50, -60, -70}, {1, 1, -1}, {3, 2, -1}, {27, 6, -1}, {27, 9, -3}, {-50, -60, -70}});
    test::animate(draft, 0, "translation", test::scalars(draft, {1, 3}), values, "CUBICSPLINE");
    const Scene scene = draft.load();
    ASSERT_TRUE(scene.animation);
    for (const double t : {1.0, 1.25, 2.0, 2.875, 3.0})
        EXPECT_VEC_NEAR(posed_at(scene, t).positions[0], glm::dvec3(t * t * t, t * t, -t), 1e-12)
            << t;
    EXPECT_EQ(posed_at(scene, 0.0).positions[0], glm::dvec3(1, 1, -1));
    EXPECT_EQ(posed_at(scene, 9.0).positions[0], glm::dvec3(27, 9, -3));
}

// Two weights: both tangents in of a key, both values, both tangents out.
TEST(GltfCurves, CubicWeightsAreGroupedByTangentsAndValues) {
    GltfDraft draft = test::triangle_draft();
    draft.document["meshes"][0]["primitives"][0]["targets"] = {
        {{"POSITION", draft.vec3(test::Floats3(3, {1, 0, 0}))}},
        {{"POSITION", draft.vec3(test::Floats3(3, {0, 1, 0}))}}};
    const int values = test::scalars(draft, {-50, -60, 1, 1, 3, 2, 27, 6, 27, 9, -50, -60});
    test::animate(draft, 0, "weights", test::scalars(draft, {1, 3}), values, "CUBICSPLINE");
    const Scene scene = draft.load();
    ASSERT_TRUE(scene.animation);
    for (const double t : {1.0, 1.5, 2.0, 2.875, 3.0})
        EXPECT_VEC_NEAR(posed_at(scene, t).positions[0], glm::dvec3(t * t * t, t * t, 0), 1e-12)
            << t;
}

TEST(GltfCurves, StepsHoldTheLastKey) {
    GltfDraft draft = test::triangle_draft();
    test::animate(draft, 0, "translation", test::scalars(draft, {0, 1, 2}),
                  draft.vec3({{1, 0, 0}, {0, 2, 0}, {0, 0, 3}}), "STEP");
    const Scene scene = draft.load();
    ASSERT_TRUE(scene.animation);
    EXPECT_EQ(posed_at(scene, 0.999).positions[0], glm::dvec3(1, 0, 0));
    EXPECT_EQ(posed_at(scene, 1.0).positions[0], glm::dvec3(0, 2, 0));
    EXPECT_EQ(posed_at(scene, 1.999).positions[0], glm::dvec3(0, 2, 0));
    EXPECT_EQ(posed_at(scene, 2.0).positions[0], glm::dvec3(0, 0, 3));
}

// max(c / 32767, -1): half a turn about -z, then a quarter about z, which is made unit.
TEST(GltfCurves, RotationsMayBeNormalisedShorts) {
    GltfDraft draft = test::triangle_draft();
    const std::vector<std::int16_t> turns = {0, 0, 0, 32767, 0, 0, -32768, 0, 0, 0, 23170, 23170};
    const int values = draft.accessor(draft.view(turns), 3, "VEC4", test::int16_type, true);
    test::animate(draft, 0, "rotation", test::scalars(draft, {0, 1, 2}), values);
    const Scene scene = draft.load();
    ASSERT_TRUE(scene.animation);
    const double half = std::sqrt(0.5);
    const std::pair<double, glm::dvec3> wanted[] = {{0.0, {1, 0, 0}},
                                                    {0.25, {half, -half, 0}},
                                                    {0.5, {0, -1, 0}},
                                                    {1.0, {-1, 0, 0}},
                                                    {2.0, {0, 1, 0}}};
    for (const auto& [time, place] : wanted)
        EXPECT_VEC_NEAR(posed_at(scene, time).positions[1], place, curve_error) << time;
}

// As if each joint stood at the origin of the mesh: (2,0,0) is two before the second joint.
TEST(GltfCurves, SkinsWithoutInverseBindMatricesHaveIdentities) {
    GltfDraft draft = test::strip_draft();
    draft.document["skins"][0].erase("inverseBindMatrices");
    const Scene bent = posed_at(draft.load(), 1.0);
    EXPECT_VEC_NEAR(bent.positions[0], glm::dvec3(0, 0, 0), curve_error);
    EXPECT_VEC_NEAR(bent.positions[2], glm::dvec3(1, 0.5, 0), curve_error);
    EXPECT_VEC_NEAR(bent.positions[4], glm::dvec3(1, 2, 0), curve_error);
    EXPECT_VEC_NEAR(bent.positions[5], glm::dvec3(1, 2, -1), curve_error);
}

}  // namespace
}  // namespace clgi
