// Light stays on its side of walls: thick, touching, thin, single-sided and coincident ones. What
// leaks is one pixel of a hemicube along the line where a wall stands on a floor that goes on, and
// the patch of a VPL that lies on both sides of a wall.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <cmath>
#include <functional>

#include "light_baking.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using test::Baked;
using test::Bakery;

using Dark = std::function<bool(const glm::dvec3& position, const glm::dvec3& normal)>;

// Of the mean light of lit texels: the mean and the most that dark ones have, and dark VPLs.
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

Leak leak_of(const Scene& scene, const Dark& dark, std::uint32_t vpls = 400, int size = 0) {
    const Bakery bakery(scene, {.vpls = vpls});
    LightAtlasOptions options = test::bake_options();
    if (size > 0) options.hemicube_size = size;
    return leak_of(bakery, test::bake(bakery, options), dark);
}

Scene grey() { return test::plain_scene(glm::vec3(0.5f)); }

TEST(LightAtlasLeaks, NothingThroughThickWalls) {
    for (const double thickness : {0.1, 0.01}) {
        Scene scene = grey();
        test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
        test::add_box(scene, glm::dvec3(-1.0 - thickness), glm::dvec3(1.0 + thickness), 1);
        test::add_floor(scene, 3.0, -1.6);
        scene.lights = {test::point_light({0.2, 0.3, 0.1}, 10.0f)};
        const Leak leak = leak_of(scene, [&](const glm::dvec3& p, const glm::dvec3&) {
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

// A VPL that looks along the floor into the next box sees, in the pixel of the contact line, the
// plane of that floor. Finer pixels leak less.
TEST(LightAtlasLeaks, LittleBetweenBoxesThatTouch) {
    for (const double gap : {0.0, 0.001}) {
        const Leak leak = leak_of(boxes(gap), beyond(gap));
        EXPECT_LT(leak.mean, 2e-4) << gap;
        EXPECT_LT(leak.most, 1e-3) << gap;
        EXPECT_LT(leak.vpls, 4e-4) << gap;
    }
    const Leak apart = leak_of(boxes(0.1), beyond(0.1));
    EXPECT_LT(apart.most, 1e-4);
    const Leak fine = leak_of(boxes(0.0), beyond(0.0), 400, 512);
    EXPECT_LT(fine.most, 1e-4);
    EXPECT_LT(fine.mean, 1e-5);
}

// A box with fronts inside only, lit from outside. The pixels of its outline let in a little of the
// light outside, which is faint itself: of reflected light alone.
TEST(LightAtlasLeaks, LittleThroughTheBacksOfSingleSidedWalls) {
    Scene scene = grey();
    test::add_box(scene, glm::dvec3(-1.0), glm::dvec3(1.0), -1);
    test::add_floor(scene, 4.0, -1.5);
    test::add_quad(scene, {glm::dvec3(-4, -1.5, -4), {4, -1.5, -4}, {4, 2, -4}, {-4, 2, -4}});
    scene.lights = {test::point_light({0.2, 2.7, 0.1}, 10.0f)};
    const Leak leak = leak_of(
        scene, [](const glm::dvec3& p, const glm::dvec3&) { return p.y > -1.2 && p.z > -2.0; });
    EXPECT_LT(leak.mean, 4e-3);
    EXPECT_LT(leak.most, 0.025);
}

// A room whose walls are cut where a wall without thickness stands: two single-sided faces at one
// place.
TEST(LightAtlasLeaks, LittleThroughFacesThatLieAtOnePlace) {
    Scene scene = grey();
    test::add_box(scene, glm::dvec3(-1.0), {0.0, 1.0, 1.0}, -1);
    test::add_box(scene, {0.0, -1.0, -1.0}, glm::dvec3(1.0), -1);
    scene.lights = {test::point_light({-0.5, 0.3, 0.1}, 10.0f)};
    const Leak leak = leak_of(scene, [](const glm::dvec3& p, const glm::dvec3& n) {
        return std::abs(p.x) < 1e-9 ? n.x > 0.0 : p.x > 0.0;
    });
    EXPECT_LT(leak.mean, 1e-4);
    EXPECT_LT(leak.most, 1e-3);
}

// A table of two such faces with a wall on it: nothing reaches the floor below.
TEST(LightAtlasLeaks, NothingFromTheTopToTheUndersideOfATable) {
    Scene scene = grey();
    test::add_floor(scene, 1.0);
    test::add_quad(scene, {glm::dvec3(-1, 0, -1), {1, 0, -1}, {1, 0, 1}, {-1, 0, 1}});
    test::add_quad(scene, {glm::dvec3(-1, 0, -1), {-1, 1, -1}, {-1, 1, 1}, {-1, 0, 1}});
    test::add_floor(scene, 1.0, -1.0);
    scene.lights = {test::point_light({0.2, 0.7, 0.1}, 10.0f)};
    const Leak leak = leak_of(
        scene, [](const glm::dvec3& p, const glm::dvec3& n) { return p.y < -0.5 || n.y < -0.5; });
    EXPECT_EQ(leak.most, 0.0);
    EXPECT_EQ(leak.vpls, 0.0);
}

// A double-sided plane through a room whose walls go on: VPLs of these stand for both sides. They
// become smaller with their number.
TEST(LightAtlasLeaks, ThroughAThinWallFallWithTheNumberOfVpls) {
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
    const Leak few = leak_of(scene, dark, 400), many = leak_of(scene, dark, 1600);
    EXPECT_LT(few.mean, 0.0075);
    EXPECT_LT(many.mean, 0.006);
    EXPECT_LT(many.mean, 0.9 * few.mean);
}

}  // namespace
}  // namespace clgi
