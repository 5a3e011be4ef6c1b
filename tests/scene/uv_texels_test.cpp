// Texels of lightmaps: coverage, places to the last digit, edges that two triangles share, and
// irradiance of atlases against closed forms.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <cmath>
#include <numbers>

#include "lab/reference_picture.hpp"
#include "scene/uv_texels.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

// A quad with texture coordinates of its own in set 1, and none (all zero) in set 0.
void add_charted_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners, glm::vec2 low,
                      glm::vec2 high) {
    test::add_quad(scene, corners);
    for (const glm::vec2 uv : {glm::vec2(low.x, high.y), high, glm::vec2(high.x, low.y), low})
        scene.uvs.emplace_back(0.0f, 0.0f, uv.x, uv.y);
}

Scene charted_floor(glm::vec2 low, glm::vec2 high) {
    Scene scene = test::plain_scene();
    add_charted_quad(scene, {glm::dvec3(-2, 1, 3), {2, 1, 3}, {2, 1, -3}, {-2, 1, -3}}, low, high);
    return scene;
}

TEST(UvTexels, LieWhereTheSurfaceIs) {
    // u from x = -2 to 2, v from z = -3 to 3, both over a part of the square.
    const glm::vec2 low(0.125f, 0.25f), high(0.875f, 0.8125f);
    const Scene scene = charted_floor(low, high);
    for (const int size : {16, 64, 100}) {
        const UvTexels found = uv_texels(scene, 1, size);
        EXPECT_EQ(found.overlapping, 0u);
        EXPECT_EQ(found.outside, 0u);
        std::size_t wanted = 0;
        for (int row = 0; row < size; ++row)
            for (int column = 0; column < size; ++column) {
                const double u = (column + 0.5) / size, v = (row + 0.5) / size;
                // Of two opposite edges one belongs to the quad.
                wanted += u >= double{low.x} && u < double{high.x} && v > double{low.y} &&
                          v < double{high.y};
            }
        EXPECT_EQ(found.texels.size(), wanted) << size;
        for (const UvTexel& texel : found.texels) {
            const double u = (texel.texel % static_cast<unsigned>(size) + 0.5) / size;
            const double v = (texel.texel / static_cast<unsigned>(size) + 0.5) / size;
            const UvPlace place = place_at(scene, texel);
            EXPECT_NEAR(place.position.x, -2 + 4 * (u - 0.125) / 0.75, 1e-12);
            EXPECT_NEAR(place.position.z, -3 + 6 * (v - 0.25) / 0.5625, 1e-12);
            EXPECT_EQ(place.position.y, 1.0);
            EXPECT_NEAR(glm::distance(place.normal, glm::dvec3(0, 1, 0)), 0.0, 1e-7);
            EXPECT_NEAR(glm::distance(place.geometric, glm::dvec3(0, 1, 0)), 0.0, 1e-12);
        }
    }
    EXPECT_TRUE(uv_texels(scene, 0, 64).texels.empty());
    EXPECT_EQ(uv_texels(scene, 0, 64).without_area, 2u);
}

// Fans around a centre and edges through the centres of texels: every texel once, mirrored or not.
TEST(UvTexels, OnSharedEdgesBelongToOneTriangle) {
    for (const bool mirrored : {false, true})
        for (const int spokes : {3, 4, 8, 37}) {
            Scene scene = test::plain_scene();
            const auto corner = [&](int k) {
                const double turn = 2 * pi * k / spokes * (mirrored ? -1 : 1);
                return glm::dvec3(0.5 + 0.5 * std::cos(turn), 0.5 + 0.5 * std::sin(turn), 0);
            };
            for (int k = 0; k < spokes; ++k) {
                const glm::dvec3 at[3] = {{0.5, 0.5, 0}, corner(k), corner((k + 1) % spokes)};
                test::add_triangle(scene, at[0], at[1], at[2]);
                for (const glm::dvec3& p : at) scene.uvs.emplace_back(p.x, p.y, 0, 0);
            }
            const int size = 63;  // the centre of the fan is a texel's
            const UvTexels found = uv_texels(scene, 0, size);
            EXPECT_EQ(found.overlapping, 0u) << spokes;
            std::size_t holes = 0;
            std::vector<bool> there(size * size);
            for (const UvTexel& texel : found.texels) there[texel.texel] = true;
            for (int i = 0; i < size * size; ++i) {
                const double x = (i % size + 0.5) / size - 0.5, y = (i / size + 0.5) / size - 0.5;
                // Well within the polygon.
                holes += std::hypot(x, y) < 0.49 * std::cos(pi / spokes) &&
                         !there[static_cast<std::size_t>(i)];
            }
            EXPECT_EQ(holes, 0u) << spokes;
            const double area = 0.5 * spokes * 0.25 * std::sin(2 * pi / spokes);
            EXPECT_NEAR(static_cast<double>(found.texels.size()) / (size * size), area, 0.02);
        }
    // Both triangles of the whole square, its diagonal through the centres.
    EXPECT_EQ(uv_texels(charted_floor({0, 0}, {1, 1}), 1, 32).texels.size(), 1024u);
    EXPECT_EQ(uv_texels(charted_floor({1, 0}, {0, 1}), 1, 32).texels.size(), 1024u);
}

TEST(UvTexels, SayWhatIsOddAboutThem) {
    Scene scene = charted_floor({0, 0}, {0.5f, 1});
    add_charted_quad(scene, {glm::dvec3(9, 0, 0), {9, 1, 0}, {9, 1, 1}, {9, 0, 1}}, {0.25f, 0},
                     {0.75f, 1});
    const UvTexels both = uv_texels(scene, 1, 64);
    EXPECT_EQ(both.texels.size(), 64u * 48u);
    EXPECT_EQ(both.overlapping, 64u * 16u);
    for (const UvTexel& texel : both.texels)
        if (texel.texel % 64 < 32) {
            EXPECT_LT(texel.triangle, 2u);
        }
    EXPECT_EQ(uv_texels(charted_floor({0.5f, 0}, {1.25f, 1}), 1, 64).outside, 2u);
    // However far it reaches.
    const UvTexels far = uv_texels(charted_floor({-1e30f, -1e30f}, {1e30f, 1e30f}), 1, 16384);
    EXPECT_EQ(far.outside, 2u);
    EXPECT_TRUE(far.texels.empty());
    // Rounding of a packer is not outside.
    EXPECT_EQ(uv_texels(charted_floor({0, 0}, {1.000001f, 1}), 1, 64).outside, 0u);
    EXPECT_TRUE(uv_texels(Scene(), 1, 8).texels.empty());
    EXPECT_THROW(uv_texels(scene, 2, 8), Error);
    EXPECT_THROW(uv_texels(scene, 0, 0), Error);
}

TEST(UvTexels, TakeTheSurfacesNormalWhereTheShadingNormalFails) {
    Scene scene = charted_floor({0, 0}, {1, 1});
    for (glm::vec3& normal : scene.normals) normal = glm::vec3(0, -1, 0);
    for (const UvTexel& texel : uv_texels(scene, 1, 4).texels)
        EXPECT_NEAR(place_at(scene, texel).normal.y, 1.0, 1e-12);
    scene = charted_floor({0, 0}, {1, 1});
    const glm::vec3 slanted = glm::normalize(glm::vec3(1, 1, 0));
    for (glm::vec3& normal : scene.normals) normal = slanted;
    for (const UvTexel& texel : uv_texels(scene, 1, 4).texels) {
        EXPECT_NEAR(place_at(scene, texel).normal.x, std::sqrt(0.5), 1e-6);
        EXPECT_NEAR(place_at(scene, texel).geometric.y, 1.0, 1e-12);
    }
}

TEST(ReferenceAtlas, TakesTheSetThatServes) {
    Scene scene = charted_floor({0, 0}, {1, 1});
    EXPECT_EQ(lab::atlas_places(scene, 16, -1).uv_set, 1);
    EXPECT_THROW(lab::atlas_places(scene, 16, 0), InputError);
    for (glm::vec4& uv : scene.uvs) uv = {uv.z, uv.w, 0, 0};
    EXPECT_EQ(lab::atlas_places(scene, 16, -1).uv_set, 0);
    EXPECT_THROW(lab::atlas_places(scene, 16, 1), InputError);
    for (glm::vec4& uv : scene.uvs) uv *= 3.0f;
    EXPECT_THROW(lab::atlas_places(scene, 16, -1), InputError);
    scene.uvs.clear();
    EXPECT_THROW(lab::atlas_places(scene, 16, -1), InputError);
    EXPECT_THROW(lab::atlas_places(Scene(), 16, -1), InputError);
}

TEST(ReferenceAtlas, WarnsOfAFewTexelsAndRefusesMany) {
    Scene scene = charted_floor({0, 0}, {0.5f, 1});
    const std::array<glm::dvec3, 4> other = {glm::dvec3(9, 0, 0), {9, 1, 0}, {9, 1, 1}, {9, 0, 1}};
    Scene little = scene;
    // A quarter of a column lies over the first chart: 16 of 2,560 texels.
    add_charted_quad(little, other, {0.49f, 0}, {1, 0.25f});
    const lab::AtlasPlaces atlas = lab::atlas_places(little, 64, 1);
    ASSERT_EQ(atlas.warnings.size(), 1u);
    EXPECT_NE(atlas.warnings[0].find("covered more than once"), std::string::npos);
    Scene much = scene;
    add_charted_quad(much, other, {0.4f, 0}, {1, 1});
    EXPECT_THROW(lab::atlas_places(much, 64, 1), InputError);
}

// A closed box whose walls glow: irradiance pi L / (1 - rho) on every texel, and 0 on the others.
TEST(ReferenceAtlas, LightsTheTexelsOfAFurnace) {
    Scene scene = test::plain_scene(glm::vec3(0.5f));
    scene.materials[0].emission = glm::vec3(2.0f);
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    for (int face = 0; face < 6; ++face) {
        const glm::vec2 low(static_cast<float>(face % 3) / 3.0f + 0.01f,
                            static_cast<float>(face / 3) / 2.0f + 0.01f);
        const glm::vec2 high = low + glm::vec2(0.3f, 0.45f);
        for (const glm::vec2 uv : {glm::vec2(low.x, high.y), high, glm::vec2(high.x, low.y), low})
            scene.uvs.emplace_back(0, 0, uv.x, uv.y);
    }
    const lab::AtlasPlaces atlas = lab::atlas_places(scene, 24, -1);
    reference::Options options;
    options.samples = 128;
    const reference::PathTracer tracer(scene);
    const reference::Irradiance lit = tracer.irradiance(atlas.places, options);
    const io::Image image = lab::atlas_image(atlas, lit, "");
    EXPECT_EQ(image.attributes.at("clgi:quantity"), "irradiance");
    EXPECT_EQ(image.attributes.at("clgi:unit"), "lux");
    const double wanted = pi * 2 / (1 - 0.5);
    std::size_t covered = 0;
    for (std::size_t t = 0; t < 24 * 24; ++t) {
        const float value = image.find("G")->values[t], alpha = image.find("A")->values[t];
        if (alpha == 0.0f) {
            EXPECT_EQ(value, 0.0f);
            continue;
        }
        ++covered;
        EXPECT_EQ(alpha, 1.0f);
        EXPECT_NEAR(value, wanted, 5.0 * double{image.find("error.Y")->values[t]} + 1e-4 * wanted);
    }
    EXPECT_NEAR(static_cast<double>(covered), 24 * 24 * 6 * 0.3 * 0.45, 40);
    EXPECT_GT(lit.relative_error, 0.0);
    EXPECT_LT(lit.relative_error, 0.1);

    const reference::Irradiance cancelled =
        tracer.irradiance(atlas.places, options, [](double done) { return done < 0.01; });
    EXPECT_TRUE(cancelled.cancelled);
    EXPECT_LT(cancelled.samples, 16);
    options.samples = 100000;
    options.target = 0.05;
    const reference::Irradiance enough = tracer.irradiance(atlas.places, options);
    EXPECT_LE(enough.relative_error, 0.05);
    EXPECT_LT(enough.samples, 100000);
}

// Normals that lean over: light from below the surface does not count, as in a picture.
TEST(ReferenceAtlas, LooksNotBelowTheSurface) {
    Scene scene = charted_floor({0, 0}, {1, 1});
    for (glm::vec3& normal : scene.normals) normal = glm::normalize(glm::vec3(1, 1, 0));
    scene.environment = test::even_sky(glm::vec3(1.0f));
    const lab::AtlasPlaces atlas = lab::atlas_places(scene, 8, 1);
    reference::Options options;
    options.effects = reference::parse_effects("direct");
    options.samples = 4096;
    const auto lit = reference::PathTracer(scene).irradiance(atlas.places, options);
    // Of the hemisphere about a normal at 45 degrees, what is above the floor.
    for (std::size_t i = 0; i < lit.values.size(); ++i)
        EXPECT_NEAR(lit.values[i].x, pi / 2 * (1 + std::sqrt(0.5)), 5.0 * double{lit.error[i]});
}

}  // namespace
}  // namespace clgi
