// Light atlases at their default settings against the path tracer, at places spread over the atlas.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/reference.hpp>
#include <cmath>

#include "apart.hpp"
#include "light_baking.hpp"
#include "rooms.hpp"

namespace clgi {
namespace {

using test::Baked;
using test::Bakery;

// Energy within 3 %, root mean square error at most 10 % of the mean, over about a thousand texels.
// beyond: only places with a larger x.
void expect_reference(const Scene& scene, double beyond = -1.0) {
    const Bakery bakery(scene, {.vpls = VplOptions().count, .atlas = AtlasOptions().size});
    const LightAtlasOptions options;
    const Baked baked = test::bake(bakery, options);
    std::vector<reference::Place> places;
    std::vector<std::size_t> texels;
    const std::size_t step = bakery.atlas.texels.size() / 1000;
    for (std::size_t i = step / 2; i < bakery.atlas.texels.size(); i += step) {
        const AtlasTexel& texel = bakery.atlas.texels[i];
        const glm::dvec3 at = test::position(bakery.scene, texel);
        if (!texel.centre || at.x < beyond) continue;
        const glm::vec3 normal(glm::normalize(test::normal_of(bakery.scene, texel.triangle)));
        places.push_back({at, normal, normal});
        texels.push_back(i);
    }
    reference::Options tracing;
    tracing.effects.emission = tracing.effects.direct = false;
    tracing.samples = 768;
    const reference::PathTracer tracer(bakery.scene);
    test::Twice truth;
    truth.first = tracer.irradiance(places, tracing).values;
    tracing.seed = 2;
    truth.second = tracer.irradiance(places, tracing).values;
    std::vector<glm::vec3> found;
    for (const std::size_t texel : texels) found.push_back(baked.texels[texel]);
    const test::Apart result = test::apart(found, truth);
    testing::Test::RecordProperty("rel_rmse", std::to_string(result.high));
    EXPECT_GT(places.size(), 300u);
    EXPECT_NEAR(result.energy, 1.0, 0.03);
    EXPECT_LT(result.high, 0.1);
    EXPECT_EQ(baked.status.non_finite, 0u);
}

TEST(LightAtlasReference, FurnishedRoom) {
    expect_reference(test::furnished_room(7));
    expect_reference(test::furnished_room(11));
}

TEST(LightAtlasReference, ChambersJoinedByASlit) { expect_reference(test::chambers()); }

// Alone in the dark chamber, where all light comes through the slit.
TEST(LightAtlasReference, TheChamberBehindTheSlit) { expect_reference(test::chambers(), 2.06); }

}  // namespace
}  // namespace clgi
