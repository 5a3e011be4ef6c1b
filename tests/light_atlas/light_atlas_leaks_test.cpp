// Light stays on its side of walls: thick, touching, thin, single-sided and coincident ones. On the
// dark side a texel has at most 1e-4 of the light of the lit one.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <functional>

#include "light_baking.hpp"
#include "math_modes.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Baked;
using test::Bakery;

using Dark = std::function<bool(const glm::dvec3& position, const glm::dvec3& normal)>;

// Of the mean light of lit texels: the mean and the most that dark ones have, and the mean of dark
// VPLs.
struct Leak {
    double mean, most, vpls;
};

Leak leak_of(const Bakery& bakery, const Baked& baked, const Dark& dark) {
    const auto is_dark = [&](const auto& point) {
        return dark(test::position(bakery.scene, point),
                    glm::normalize(test::normal_of(bakery.scene, point.triangle)));
    };
    const std::function<bool(const AtlasTexel&)> texel = is_dark;
    const std::function<bool(const VplSite&)> vpl = [&](const VplSite& site) {
        const glm::dvec3 normal = glm::normalize(test::normal_of(bakery.scene, site.triangle));
        return dark(test::position(bakery.scene, site), site.back ? -normal : normal);
    };
    const test::Spread lit = test::over_texels(bakery, baked.texels, std::not_fn(texel));
    const test::Spread leaked = test::over_texels(bakery, baked.texels, texel);
    EXPECT_GT(leaked.count, 100u);
    EXPECT_GT(lit.mean.x, 0.0);
    EXPECT_EQ(baked.status.non_finite, 0u);
    EXPECT_NEAR(baked.status.power_received + baked.status.power_lost, baked.status.power_shot,
                1e-5 * baked.status.power_shot);
    const Leak out{leaked.mean.x / lit.mean.x, leaked.most.x / lit.mean.x,
                   test::over_vpls(bakery, baked.vpls, vpl).mean.x / lit.mean.x};
    return out;
}

Leak leak_of(Math math, const Scene& scene, const Dark& dark, std::uint32_t vpls = 400) {
    const Bakery bakery(scene, {.vpls = vpls});
    return leak_of(bakery, test::bake(bakery, test::bake_options(math)), dark);
}

CLGI_IN_BOTH_MATHS(LightAtlasLeaks);

Scene grey() { return test::plain_scene(glm::vec3(0.5f)); }

TEST_P(LightAtlasLeaks, NothingThroughThickWalls) {
    for (const double thickness : {0.1, 0.01}) {
        Scene scene = grey();
        test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
        test::add_box(scene, glm::dvec3(-1.0 - thickness), glm::dvec3(1.0 + thickness), 1);
        test::add_floor(scene, 3.0, -1.6);
        scene.lights = {test::point_light({0.2, 0.3, 0.1}, 10.0f)};
        const Leak leak = leak_of(GetParam(), scene, [&](const glm::dvec3& p, const glm::dvec3&) {
            return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) > 1.0 + 0.5 * thickness;
        });
        EXPECT_EQ(leak.most, 0.0) << thickness;
        EXPECT_EQ(leak.vpls, 0.0) << thickness;
    }
}

// Two boxes side by side whose walls have no outside; their floors lie in one plane.
Scene boxes(double gap) {
    Scene scene = grey();
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    test::add_box(scene, {1.0 + gap, -1.0, -1.0}, {3.0 + gap, 1.0, 1.0}, -1);
    scene.lights = {test::point_light({0.2, 0.3, 0.1}, 10.0f)};
    return scene;
}

Dark beyond(double gap) {
    return [gap](const glm::dvec3& p, const glm::dvec3& n) {
        return std::abs(p.x - 1.0 - 0.5 * gap) < 0.5 * gap + 1e-6 ? n.x > 0.0 : p.x > 1.0;
    };
}

// The pixel of the contact line sees the floor of one box and holds a part of the next one's.
TEST_P(LightAtlasLeaks, NothingBetweenBoxesThatTouch) {
    for (const double gap : {0.0, 0.001, 0.1}) {
        const Leak leak = leak_of(GetParam(), boxes(gap), beyond(gap));
        EXPECT_LT(leak.mean, 1e-6) << gap;
        EXPECT_LT(leak.most, 1e-5) << gap;
        EXPECT_LT(leak.vpls, 1e-6) << gap;
    }
}

// A box with fronts inside only, lit from outside. The light outside is faint itself: of reflected
// light alone.
TEST_P(LightAtlasLeaks, NothingThroughTheBacksOfSingleSidedWalls) {
    Scene scene = grey();
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    test::add_floor(scene, 4.0, -1.5);
    test::add_quad(scene, {glm::dvec3(-4, -1.5, -4), {4, -1.5, -4}, {4, 2, -4}, {-4, 2, -4}});
    scene.lights = {test::point_light({0.2, 2.7, 0.1}, 10.0f)};
    const Leak leak = leak_of(GetParam(), scene, [](const glm::dvec3& p, const glm::dvec3&) {
        return p.y > -1.2 && p.z > -2.0;
    });
    EXPECT_LT(leak.mean, 1e-5);
    EXPECT_LT(leak.most, 1e-4);
}

// A room whose walls are cut where a wall without thickness stands: two single-sided faces at one
// place.
TEST_P(LightAtlasLeaks, NothingThroughFacesThatLieAtOnePlace) {
    Scene scene = grey();
    test::add_box(scene, glm::dvec3(-1.0), {0.0, 1.0, 1.0}, -1);
    test::add_box(scene, {0.0, -1.0, -1.0}, glm::dvec3(1.0), -1);
    scene.lights = {test::point_light({-0.5, 0.3, 0.1}, 10.0f)};
    const Leak leak = leak_of(GetParam(), scene, [](const glm::dvec3& p, const glm::dvec3& n) {
        return std::abs(p.x) < 1e-9 ? n.x > 0.0 : p.x > 0.0;
    });
    EXPECT_LT(leak.mean, 1e-6);
    EXPECT_LT(leak.most, 1e-5);
}

// A table of two such faces with a wall on it: nothing reaches the floor below.
TEST_P(LightAtlasLeaks, NothingFromTheTopToTheUndersideOfATable) {
    Scene scene = grey();
    test::add_floor(scene, 1.0);
    test::add_quad(scene, {glm::dvec3(-1, 0, -1), {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}});
    test::add_quad(scene, {glm::dvec3(-1, 0, -1), {-1, 1, -1}, {-1, 1, 1}, {-1, 0, 1}});
    test::add_floor(scene, 1.0, -1.0);
    scene.lights = {test::point_light({0.2, 0.7, 0.1}, 10.0f)};
    const Leak leak = leak_of(GetParam(), scene, [](const glm::dvec3& p, const glm::dvec3& n) {
        return p.y < -0.5 || n.y < -0.5;
    });
    EXPECT_EQ(leak.most, 0.0);
    EXPECT_EQ(leak.vpls, 0.0);
}

// A double-sided plane through a room whose walls go on: no VPL of these stands for both sides.
TEST_P(LightAtlasLeaks, NothingThroughAThinWallOnAFloorThatGoesOn) {
    Scene scene = grey();
    Material both = scene.materials[0];
    both.double_sided = true;
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    test::add_quad(scene, {glm::dvec3(0, -1, 1), {0, -1, -1}, {0, 1, -1}, {0, 1, 1}},
                   test::add_material(scene, both));
    scene.lights = {test::point_light({-0.5, 0.3, 0.1}, 10.0f)};
    // The plane's texels show its front, the lit or the dark side as it is wound.
    const Dark dark = [](const glm::dvec3& p, const glm::dvec3& n) {
        return std::abs(p.x) < 1e-9 ? n.x > 0.0 : p.x > 0.0;
    };
    for (const std::uint32_t vpls : {200u, 400u, 1600u}) {
        const Leak leak = leak_of(GetParam(), scene, dark, vpls);
        EXPECT_LT(leak.mean, 1e-5) << vpls;
        EXPECT_LT(leak.most, 1e-4) << vpls;
        EXPECT_LT(leak.vpls, 1e-5) << vpls;
    }
}

}  // namespace
}  // namespace clgi
