// Light atlases of closed spaces against closed forms: every order of reflection, and their sum;
// the balance of power in closed and open scenes.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/procedural.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "cube_radiosity.hpp"
#include "light_baking.hpp"
#include "math_modes.hpp"

namespace clgi {
namespace {

using test::Baked;
using test::Bakery;
using test::Spread;

CLGI_IN_BOTH_MATHS(LightAtlas);

// Every value within `share` of what is wanted, channel by channel.
void expect_all(const Spread& found, const glm::dvec3& wanted, double share,
                const std::string& what) {
    EXPECT_GT(found.count, 0u) << what;
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(found.least[c], wanted[c], share * wanted[c]) << what << ", channel " << c;
        EXPECT_NEAR(found.most[c], wanted[c], share * wanted[c]) << what << ", channel " << c;
    }
}

// What was shot has arrived or is lost, and nothing that was received was forgotten.
void expect_balance(const LightAtlasStatus& status, const std::string& what) {
    EXPECT_EQ(status.non_finite, 0u) << what;
    const double shot = status.power_shot;
    EXPECT_NEAR(status.power_received + status.power_lost, shot, 1e-5 * shot) << what;
    EXPECT_GE(status.power_lost, -1e-6 * shot) << what;
}

// A sphere with a point light in its middle. All walls alike, so radiosity is rho E / (1 - rho).
Scene sphere(const glm::vec3& albedo, const glm::vec3& intensity) {
    Scene scene = furnace({.light = LightSource::point, .albedo = 0.5f});
    for (Material& material : scene.materials) material.base_color = glm::vec4(albedo, 1.0f);
    scene.lights[0].intensity = intensity;
    return scene;
}

// 1 %: facets make the sphere 0.3 % smaller; a texel at an edge between charts is 0.6 % off.
TEST_P(LightAtlas, OfASphereHoldsAllOrdersOfReflection) {
    const glm::dvec3 light(1.0, 0.25, 3.0);
    for (const glm::dvec3& rho : {glm::dvec3(0.0, 0.2, 0.5), glm::dvec3(0.8, 0.95, 0.2)}) {
        const Bakery bakery(sphere(glm::vec3(rho), glm::vec3(light)));
        const Baked baked = test::bake(bakery, test::converged(GetParam()));
        const std::string what = "reflectances from " + std::to_string(rho.x);
        const glm::dvec3 all = light / (1.0 - rho);
        expect_all(test::over_vpls(bakery, baked.vpls), all, 0.01, what + ", VPLs");
        expect_all(test::over_texels(bakery, baked.texels), rho * all, 0.01, what + ", texels");
        expect_balance(baked.status, what);
        EXPECT_EQ(baked.status.power_lost, 0.0);
        EXPECT_TRUE(baked.status.transport_kept);
    }
}

TEST_P(LightAtlas, OfASphereHoldsAsManyBouncesAsAskedFor) {
    const glm::dvec3 rho(0.5, 0.25, 0.9);
    const Bakery bakery(sphere(glm::vec3(rho), glm::vec3(1.0f)));
    for (const std::uint32_t k : {1u, 2u, 3u, 6u}) {
        LightAtlasOptions options = test::bake_options(GetParam());
        options.bounces = k;
        const Baked baked = test::bake(bakery, options);
        glm::dvec3 sum(0.0);
        for (std::uint32_t i = 0; i < k; ++i) sum = 1.0 + rho * sum;
        const std::string what = std::to_string(k) + " bounces";
        expect_all(test::over_vpls(bakery, baked.vpls), sum, 0.01, what + ", VPLs");
        expect_all(test::over_texels(bakery, baked.texels), rho * sum, 0.01, what + ", texels");
        expect_balance(baked.status, what);
        EXPECT_EQ(baked.status.shots, (k - 1) * bakery.vpls.vpls.size());
    }
}

// An integrating sphere of two halves of albedo 0.2 and 0.8, the first of which shines: with the
// mean emission 1/2 and the mean albedo 1/2 everything receives 1 (STABILITY 1.2).
TEST_P(LightAtlas, OfASphereOfTwoAlbedosIsAnIntegratingSphere) {
    Scene scene = sphere(glm::vec3(0.2f), glm::vec3(1.0f));
    Material bright;
    bright.base_color = glm::vec4(glm::vec3(0.8f), 1.0f);
    const std::uint32_t other = test::add_material(scene, bright);
    const auto upper = [&](const SceneTriangle& t) {
        return scene.positions[t.vertex[0]].y + scene.positions[t.vertex[1]].y +
                   scene.positions[t.vertex[2]].y >
               0.0;
    };
    for (SceneTriangle& t : scene.triangles)
        if (upper(t)) t.material = other;
    const Bakery bakery(scene);
    // VPLs on the border have samples in both halves.
    std::vector<glm::vec3> direct;
    double emitted = 0.0, reflected = 0.0, area = 0.0;
    for (const VplSite& site : bakery.vpls.vpls) {
        double albedo = 0.0;
        for (std::uint32_t k = 0; k < site.sample_count; ++k)
            albedo += upper(scene.triangles[bakery.vpls.samples[site.first_sample + k].triangle])
                          ? 0.8
                          : 0.2;
        albedo /= site.sample_count;
        direct.emplace_back(upper(scene.triangles[site.triangle]) ? 0.0f : 5.0f);
        emitted += site.area * albedo * double{direct.back().x};
        reflected += site.area * albedo;
        area += site.area;
    }
    EXPECT_NEAR(reflected / area, 0.5, 0.01);
    const double wanted = emitted / area / (1.0 - reflected / area);
    EXPECT_NEAR(wanted, 1.0, 0.1);
    const Baked baked = test::bake_from(bakery, test::converged(GetParam()), direct);
    expect_all(test::over_texels(bakery, baked.texels), glm::dvec3(wanted), 0.015, "two halves");
    expect_balance(baked.status, "two halves");
}

// White walls would keep light for ever. VPLs reflect all but 2^-10 of it, so that bakes end: with
// 1023 times the light, of which a hundredth is not shot.
TEST_P(LightAtlas, OfAWhiteRoomEnds) {
    Scene room = test::plain_scene(glm::vec3(1.0f));
    test::add_box(room, glm::dvec3(0.0), glm::dvec3(1.0), -1);
    const Bakery bakery(room, {.vpls = 24, .atlas = 16});
    LightAtlasOptions options = test::bake_options(GetParam());
    options.bounces = 0;
    options.threshold = 0.01f;
    const Baked baked = test::bake_from(
        bakery, options, std::vector<glm::vec3>(bakery.vpls.vpls.size(), glm::vec3(1.0f)));
    expect_all(test::over_texels(bakery, baked.texels), glm::dvec3(1023.0 * 0.99), 0.011, "white");
    EXPECT_GT(baked.status.power_left, 0.0);
    EXPECT_LT(baked.status.power_left, 0.011 * baked.status.power_direct);
}

// Every point of a sphere gets the same light from each part of it. What differs are texels in the
// beam: VPLs and triangles are flat, so those next to a texel give it more or less than they
// should, a few parts of 1 / (VPLs in the beam), which are 107 of 1600.
TEST(LightAtlasOfASphere, LitByASpotIsEven) {
    const Bakery bakery(furnace({}), {.vpls = 1600});
    const double flux = 2.0 * std::numbers::pi * (1.0 - std::cos(std::numbers::pi / 6.0));
    const double once = 0.5 * flux / (4.0 * std::numbers::pi);  // 0.0334936491
    LightAtlasOptions options = test::converged();
    for (const std::uint32_t bounces : {1u, 0u}) {
        options.bounces = bounces;
        const Baked baked = test::bake(bakery, options);
        const double wanted = bounces == 1 ? once : 2.0 * once;
        const std::function<bool(const AtlasTexel&)> in_beam = [&](const AtlasTexel& texel) {
            return test::position(bakery.scene, texel).y < -0.8;
        };
        expect_all(test::over_texels(bakery, baked.texels, std::not_fn(in_beam)),
                   glm::dvec3(wanted), 0.015, "outside the beam");
        expect_all(test::over_texels(bakery, baked.texels, in_beam), glm::dvec3(wanted), 0.08,
                   "in the beam");
        EXPECT_NEAR(test::over_texels(bakery, baked.texels).mean.x, wanted, 0.003 * wanted);
        // The VPL that a texel lies on gives it nothing: 1 / 107.
        EXPECT_NEAR(test::over_texels(bakery, baked.texels, in_beam).mean.x, wanted,
                    0.015 * wanted);
        expect_balance(baked.status, "spot");
    }
}

Scene cube(const glm::vec3& albedo) {
    Scene scene = test::plain_scene(albedo);
    test::add_box(scene, glm::dvec3(0.0), glm::dvec3(1.0), -1);
    return scene;
}

// The same direct irradiance everywhere in a cube: the same sum at every VPL and every texel, in
// corners as well. What is left is what the threshold leaves unshot, 2e-5 at 0.95.
TEST_P(LightAtlas, OfACubeLitEvenlyIsEven) {
    const glm::dvec3 light(1.0, 0.5, 4.0);
    for (const glm::dvec3& rho : {glm::dvec3(0.2, 0.5, 0.8), glm::dvec3(0.95, 0.8, 0.0)}) {
        const Bakery bakery(cube(glm::vec3(rho)));
        const Baked baked =
            test::bake_from(bakery, test::converged(GetParam()),
                            std::vector<glm::vec3>(bakery.vpls.vpls.size(), glm::vec3(light)));
        const glm::dvec3 all = light / (1.0 - rho);
        expect_all(test::over_vpls(bakery, baked.vpls), all, 2e-4, "VPLs");
        expect_all(test::over_texels(bakery, baked.texels), rho * all, 2e-4, "texels");
        expect_balance(baked.status, "cube");
    }
}

// One face of the cube is lit. A face is not lit evenly then, so the radiosity of six faces that
// are (0.1817 opposite, 0.1818 beside, of 1 that is emitted) is 6 % off. Of the first reflection
// the means over faces are the form factors of squares, 0.1998248957 and 0.2000437761; of all of
// them, the radiosity of cells.
TEST_P(LightAtlas, OfACubeWithOneLitFaceHasTheLightOfItsFaces) {
    for (const double rho : {0.5, 0.8}) {
        const Bakery bakery(cube(glm::vec3(static_cast<float>(rho))), {.vpls = 1600});
        std::vector<glm::vec3> direct;
        for (const VplSite& site : bakery.vpls.vpls)
            direct.push_back(glm::vec3(test::face_of(bakery.scene, site.triangle) == 0 ? 1 : 0));
        LightAtlasOptions options = test::converged(GetParam());
        for (const std::uint32_t bounces : {1u, 0u}) {
            options.bounces = bounces;
            const Baked baked = test::bake_from(bakery, options, direct);
            const std::array<double, 6> wanted =
                test::cube_irradiance(rho, 12, bounces == 1 ? 1 : 100);
            if (bounces == 1) {
                EXPECT_NEAR(wanted[3], rho * 0.1998248957, 0.001 * rho);
                EXPECT_NEAR(wanted[1], rho * 0.2000437761, 0.001 * rho);
            }
            for (int face = bounces == 1 ? 1 : 0; face < 6; ++face) {
                const auto on_vpl = [&](const VplSite& site) {
                    return test::face_of(bakery.scene, site.triangle) == face;
                };
                const auto on_texel = [&](const AtlasTexel& texel) {
                    return test::face_of(bakery.scene, texel.triangle) == face;
                };
                const double right = wanted[static_cast<std::size_t>(face)];
                EXPECT_NEAR(test::over_texels(bakery, baked.texels, on_texel).mean.x, right,
                            0.005 * right)
                    << "texels of face " << face << ", " << bounces << " bounces, " << rho;
                if (bounces == 1) continue;
                EXPECT_NEAR(test::over_vpls(bakery, baked.vpls, on_vpl).mean.x - (face == 0), right,
                            0.005 * right)
                    << "VPLs of face " << face << ", " << rho;
            }
            expect_balance(baked.status, "one face");
        }
    }
}

// A floor and two walls whose backs are black: what leaves, and what ends on backs, is lost.
TEST_P(LightAtlas, KeepsTheBalanceOfPowerInAnOpenScene) {
    Scene scene = test::plain_scene(glm::vec3(0.6f, 0.3f, 0.8f));
    test::add_floor(scene, 1.0);
    test::add_quad(scene, {glm::dvec3(-1, 0, -1), {1, 0, -1}, {1, 1.5, -1}, {-1, 1.5, -1}});
    test::add_quad(scene, {glm::dvec3(-0.5, 0, 0.2), {0.5, 0, 0.2}, {0.5, 1, 0.2}, {-0.5, 1, 0.2}});
    scene.lights = {test::point_light({0.2, 0.8, 0.6}, 10.0f)};
    const Bakery bakery(scene);
    LightAtlasOptions options = test::bake_options(GetParam());
    double shot = 0.0;
    for (std::uint32_t k = 1; k <= 6; ++k) {
        options.bounces = k;
        const LightAtlasStatus status = test::bake(bakery, options).status;
        expect_balance(status, std::to_string(k) + " bounces");
        EXPECT_GE(status.power_shot, shot);
        shot = status.power_shot;
        if (k > 1) {
            EXPECT_GT(status.power_lost, 0.5 * status.power_shot);
            EXPECT_LT(status.power_lost, status.power_shot);
        }
    }
}

}  // namespace
}  // namespace clgi
