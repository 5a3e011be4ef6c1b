// How much the light of an atlas jumps where charts cut a smooth surface.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/advanced/atlas_light.hpp>
#include <clgi/error.hpp>
#include <functional>
#include <limits>

#include "atlas_checks.hpp"

namespace clgi {
namespace {

using Vectors = std::vector<glm::vec3>;

// Two quads that meet along an edge of 2 m on the y axis; the second is turned by an angle about
// it.
Scene hinge(double angle, bool smooth = true) {
    Scene scene = test::plain_scene();
    const double c = std::cos(angle), s = std::sin(angle);
    test::add_quad(scene, {glm::dvec3(-1.5, 0, 0), {0, 0, 0}, {0, 2, 0}, {-1.5, 2, 0}});
    test::add_quad(scene, {glm::dvec3(0, 0, 0), {c, 0, s}, {c, 2, s}, {0, 2, 0}});
    if (smooth)
        for (glm::vec3& normal : scene.normals) normal = glm::vec3(0, 0, 1);
    return scene;
}

// Both triangles of a quad in a chart.
AtlasLayout charts_of(const Scene& scene, int size) {
    return make_atlas(scene, test::regions(scene, 2), test::made_charts(size));
}

Vectors light_of(const AtlasLayout& atlas, const std::function<double(const AtlasTexel&)>& at) {
    Vectors out;
    for (const AtlasTexel& texel : atlas.texels)
        out.emplace_back(static_cast<float>(at(texel)) * glm::vec3(1.0f, 0.5f, 0.25f));
    return out;
}

double mean_of(const AtlasLayout& atlas, const Vectors& light) {
    double sum = 0.0, area = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        sum += double{atlas.texels[i].area} * double{light[i].r};
        area += double{atlas.texels[i].area};
    }
    return sum / area;
}

// One side has twice the light of the other: the jump is the same everywhere, over the mean.
TEST(AtlasSeams, AreTheJumpOverTheMean) {
    const Scene scene = hinge(0.2);
    const AtlasLayout atlas = charts_of(scene, 64);
    const auto light =
        light_of(atlas, [](const AtlasTexel& texel) { return texel.triangle < 2 ? 3.0 : 6.0; });
    const AtlasSeams seams = atlas_seams(scene, atlas, light);
    EXPECT_NEAR(seams.length, 2.0, 1e-12);
    const double wanted = 3.0 / mean_of(atlas, light);
    EXPECT_NEAR(seams.difference, wanted, 1e-6 * wanted);  // floats
    EXPECT_NEAR(seams.worst, wanted, 1e-6 * wanted);
}

// The jump grows along the edge from 0 to 4: its square has a mean of 16 / 3, and 3.96 is exceeded
// on a hundredth.
TEST(AtlasSeams, AreARootMeanSquareAlongTheEdge) {
    const Scene scene = hinge(0.0);
    const AtlasLayout atlas = charts_of(scene, 400);
    const auto light = light_of(atlas, [&](const AtlasTexel& texel) {
        const double y = test::place_of(scene, texel).y;
        return texel.triangle < 2 ? 5.0 : 5.0 + 2.0 * y;
    });
    const AtlasSeams seams = atlas_seams(scene, atlas, light);
    const double mean = mean_of(atlas, light);
    // The ends of the edge lie half a texel beyond the outermost centres: 1 % of a 200th each.
    EXPECT_NEAR(seams.difference, std::sqrt(16.0 / 3.0) / mean, 0.003);
    EXPECT_NEAR(seams.worst, 3.96 / mean, 0.01);
}

TEST(AtlasSeams, OfContinuousLightVanishWithTheTexels) {
    double last = 1.0;
    for (const int size : {32, 128, 512}) {
        const Scene scene = hinge(0.1);
        const AtlasLayout atlas = charts_of(scene, size);
        const auto light = light_of(atlas, [&](const AtlasTexel& texel) {
            const glm::dvec3 p = test::place_of(scene, texel);
            return 2.0 + 0.5 * p.x + 0.2 * p.y;
        });
        const double now = atlas_seams(scene, atlas, light).difference;
        EXPECT_GT(now, 0.0);
        EXPECT_LT(now, 0.4 * last);
        last = now;
    }
}

TEST(AtlasSeams, AreOnlyWhereTheSurfaceIsSmooth) {
    const auto length = [](const Scene& scene, std::uint32_t triangles_a_region) {
        const AtlasLayout atlas =
            make_atlas(scene, test::regions(scene, triangles_a_region), test::made_charts(64));
        return atlas_seams(scene, atlas, Vectors(atlas.texels.size(), glm::vec3(1.0f))).length;
    };
    EXPECT_NEAR(length(hinge(0.0), 2), 2.0, 1e-12);
    EXPECT_NEAR(length(hinge(0.5), 2), 2.0, 1e-12);          // 28.6 degrees
    EXPECT_EQ(length(hinge(0.55), 2), 0.0);                  // 31.5
    EXPECT_EQ(length(hinge(0.2, false), 2), 0.0);            // normals of the faces
    EXPECT_NEAR(length(hinge(0.015, false), 2), 2.0, 1e-9);  // 0.86 degrees
    EXPECT_EQ(length(hinge(0.0), 0), 0.0);                   // one chart for both
    // Each triangle alone: the diagonals too.
    EXPECT_NEAR(length(hinge(0.0), 1), 2.0 + std::hypot(1.5, 2.0) + std::hypot(1.0, 2.0), 1e-9);
}

TEST(AtlasSeams, OfDarknessAreNone) {
    const Scene scene = hinge(0.0);
    const AtlasLayout atlas = charts_of(scene, 16);
    const AtlasSeams seams = atlas_seams(scene, atlas, Vectors(atlas.texels.size()));
    EXPECT_EQ(seams.difference, 0.0);
    EXPECT_EQ(seams.worst, 0.0);
    EXPECT_THROW(atlas_seams(scene, atlas, Vectors(1)), Error);
    EXPECT_THROW(atlas_seams(test::plain_scene(), atlas, Vectors(atlas.texels.size())), Error);
}

TEST(AtlasSeams, OfNumbersThatAreNotFiniteAreNoNumber) {
    const Scene scene = hinge(0.0);
    const AtlasLayout atlas = charts_of(scene, 16);
    Vectors light(atlas.texels.size(), glm::vec3(1.0f));
    light[7].g = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(std::isfinite(atlas_seams(scene, atlas, light).difference));
}

// A jump of a quarter nearly vanishes; texels that are not read at the edge stay what they were,
// and the two sides give way alike.
TEST(StitchedSeams, AgreeWhereTheSurfaceIsSmooth) {
    const Scene scene = hinge(0.1);
    const AtlasLayout atlas = charts_of(scene, 64);
    const auto light =
        light_of(atlas, [](const AtlasTexel& texel) { return texel.triangle < 2 ? 3.0 : 4.0; });
    const Vectors stitched = stitched_seams(scene, atlas, light);
    const AtlasSeams before = atlas_seams(scene, atlas, light),
                     after = atlas_seams(scene, atlas, stitched);
    EXPECT_LT(after.difference, 0.1 * before.difference);
    EXPECT_GT(before.difference, 0.2);
    int changed = 0;
    double sum = 0.0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double x = test::place_of(scene, atlas.texels[i]).x;
        sum += double{stitched[i].r} - double{light[i].r};
        if (std::abs(x) * atlas.texels_per_metre > 2.0) {
            ASSERT_EQ(stitched[i], light[i]);
        } else {
            changed += stitched[i] != light[i];
            ASSERT_GT(stitched[i].r, 2.9f);
            ASSERT_LT(stitched[i].r, 4.1f);
            ASSERT_NEAR(stitched[i].g, 0.5 * stitched[i].r, 1e-5);
        }
    }
    EXPECT_GT(changed, 60);
    EXPECT_NEAR(sum / changed, 0.0, 0.05);
}

TEST(StitchedSeams, LeaveShadowsAndHardEdgesAsTheyAre) {
    const auto jump = [](const AtlasTexel& texel) { return texel.triangle < 2 ? 3.0 : 4.0; };
    const auto shadow = [](const AtlasTexel& texel) { return texel.triangle < 2 ? 0.01 : 4.0; };
    const auto stays = [](const Scene& scene, const auto& of) {
        const AtlasLayout atlas = charts_of(scene, 32);
        const Vectors light = light_of(atlas, of);
        return stitched_seams(scene, atlas, light) == light;
    };
    EXPECT_TRUE(stays(hinge(0.0), shadow));
    EXPECT_TRUE(stays(hinge(0.6), jump));
    EXPECT_TRUE(stays(hinge(0.0), [](const AtlasTexel&) { return 0.0; }));
    EXPECT_FALSE(stays(hinge(0.0), jump));
}

TEST(StitchedSeams, KeepWhatIsNotFiniteWhereItIs) {
    const Scene scene = hinge(0.0);
    const AtlasLayout atlas = charts_of(scene, 32);
    Vectors light =
        light_of(atlas, [](const AtlasTexel& texel) { return texel.triangle < 2 ? 3.0 : 4.0; });
    // At the edge, half way along it.
    std::size_t bad = 0;
    double nearest = 1e9;
    for (std::size_t i = 0; i < light.size(); ++i) {
        const double away = glm::distance(test::place_of(scene, atlas.texels[i]), {0, 1, 0});
        if (away < nearest) {
            nearest = away;
            bad = i;
        }
    }
    light[bad].g = std::numeric_limits<float>::quiet_NaN();
    const Vectors stitched = stitched_seams(scene, atlas, light);
    int changed = 0;
    for (std::size_t i = 0; i < light.size(); ++i) {
        ASSERT_EQ(std::isfinite(stitched[i].g), i != bad);
        changed += i != bad && stitched[i] != light[i];
    }
    EXPECT_GT(changed, 20);
    EXPECT_THROW(stitched_seams(scene, atlas, Vectors(1)), Error);
}

}  // namespace
}  // namespace clgi
