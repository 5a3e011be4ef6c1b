// Atlases of texture coordinates: the texels of the reference, exact shares, what is refused; and
// the texels around charts.
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>
#include <clgi/io/gltf.hpp>
#include <filesystem>
#include <limits>

#include "atlas_checks.hpp"
#include "lab/reference_picture.hpp"

namespace clgi {
namespace {

AtlasOptions of_set(int set, int size) {
    AtlasOptions out;
    out.size = size;
    out.uvs = set == 0 ? AtlasUvs::set_0 : AtlasUvs::set_1;
    return out;
}

// A cube whose six faces have so many charts: faces of a chart lie side by side in a row of UV set
// 1, which leaves a gap between charts.
Scene unwrapped(int charts) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, 1);
    // Corners get coordinates by their place on the face, so that neighbours need not meet.
    for (int face = 0; face < 6; ++face) {
        const int chart = face % charts, place = face / charts;
        const glm::vec2 low(0.03f + 0.16f * static_cast<float>(place),
                            0.03f + 0.16f * static_cast<float>(chart));
        const glm::vec2 high = low + glm::vec2(0.16f, 0.13f);
        for (const glm::vec2 uv : {glm::vec2(low.x, high.y), high, glm::vec2(high.x, low.y), low})
            scene.uvs.emplace_back(0, 0, uv.x, uv.y);
    }
    return scene;
}

// A floor of 2 m whose coordinates in set 1 run from 0 to these.
Scene charted(const glm::vec2& high) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    for (const glm::vec2 uv : {glm::vec2(0, 1), {1, 1}, {1, 0}, {0, 0}})
        scene.uvs.emplace_back(0, 0, uv.x * high.x, uv.y * high.y);
    return scene;
}

void expect_reference(const Scene& scene, const AtlasLayout& atlas, int size, int set) {
    const lab::AtlasPlaces wanted = lab::atlas_places(scene, size, set);
    std::size_t next = 0;
    double extent = 0.0;
    for (const glm::dvec3& p : scene.positions) extent = std::max(extent, glm::length(p));
    for (const AtlasTexel& texel : atlas.texels) {
        if (!texel.centre) continue;
        ASSERT_LT(next, wanted.texels.size());
        ASSERT_EQ(texel.texel, wanted.texels[next]);
        ASSERT_LT(glm::distance(test::place_of(scene, texel), wanted.places[next].position),
                  1e-6 * extent);
        ++next;
    }
    EXPECT_EQ(next, wanted.texels.size());
}

TEST(AtlasOfUvs, HasTheTexelsOfTheReference) {
    for (int charts = 1; charts <= 6; ++charts)
        for (const int size : {64, 100}) {
            const Scene scene = unwrapped(charts);
            const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, size));
            EXPECT_EQ(atlas.uv_set, 1);
            test::expect_sound(scene, atlas);
            expect_reference(scene, atlas, size, 1);
            EXPECT_EQ(make_atlas(scene, {}, {}).uv_set, 1);
        }
}

TEST(AtlasOfUvs, HasTheTexelsOfTheReferenceInFiles) {
    const std::filesystem::path folder = CLGI_SCENES_DIR "/lightmap-uv";
    int files = 0;
    for (const char* name : {"house-uv1.glb", "vr-gallery-uv1.glb", "bevy-CornellBox.glb"}) {
        if (!std::filesystem::exists(folder / name)) continue;
        const Scene scene = io::load_gltf(folder / name);
        if (scene.uvs.empty()) continue;
        AtlasLayout atlas;
        try {
            atlas = make_atlas(scene, {}, of_set(1, 256));
        } catch (const InputError&) {
            EXPECT_THROW(lab::atlas_places(scene, 256, 1), InputError) << name;
            continue;
        }
        ++files;
        SCOPED_TRACE(name);
        test::expect_sound(scene, atlas);
        expect_reference(scene, atlas, 256, 1);
    }
    if (files == 0) GTEST_SKIP() << "no scenes with lightmaps in " CLGI_SCENES_DIR;
}

TEST(AtlasOfUvs, HasAChartForWhatIsConnected) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::add_floor(scene, 1.0, 2.0);
    // One beside the other, with the same coordinates along the edge between them.
    for (const float left : {0.0f, 0.5f})
        for (const glm::vec2 uv : {glm::vec2(0, 1), {0.5f, 1}, {0.5f, 0}, {0, 0}})
            scene.uvs.emplace_back(0, 0, left + uv.x, uv.y);
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 16));
    ASSERT_EQ(atlas.charts.size(), 2u);
    EXPECT_EQ(atlas.triangle_chart, (std::vector<std::uint32_t>{0, 0, 1, 1}));
    EXPECT_EQ(atlas.charts[1].column, 8);
    EXPECT_EQ(atlas.charts[1].width, 8);
    EXPECT_EQ(atlas.charts[1].height, 16);
    EXPECT_EQ(atlas.texels.size(), 256u);
    EXPECT_TRUE(atlas.dilated.empty());
    // Two squares of 2 m on 256 texels.
    EXPECT_NEAR(atlas.texels_per_metre, std::sqrt(256.0 / 8.0), 1e-9);
}

TEST(AtlasOfUvs, CutsChartsAtSeams) {
    // Two squares with an edge in common, of which each has coordinates of its own.
    Scene scene = test::plain_scene();
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0), c(2, 0, 0), up(0, 1, 0);
    test::add_quad(scene, {a, b, b + up, a + up});
    test::add_quad(scene, {b, c, c + up, b + up});
    for (const float gap : {0.1f, 0.0f}) {
        scene.uvs.clear();
        for (const float left : {0.0f, 0.4f + gap})
            for (const glm::vec2 uv : {glm::vec2(0, 0), {0.4f, 0}, {0.4f, 1}, {0, 1}})
                scene.uvs.emplace_back(0, 0, left + uv.x, uv.y);
        EXPECT_EQ(make_atlas(scene, {}, of_set(1, 20)).charts.size(), gap > 0 ? 2u : 1u);
    }
}

// A rectangle of coordinates, either way around: shares are products of what each texel has of it
// along u and along v.
TEST(AtlasOfUvs, KnowsSharesExactly) {
    const double low[2] = {0.11, 0.27}, high[2] = {0.83, 0.59};
    for (const bool mirrored : {false, true})
        for (const int size : {1, 4, 30, 64}) {
            Scene scene = test::plain_scene();
            test::add_floor(scene, 1.5);
            const double left = mirrored ? high[0] : low[0], right = mirrored ? low[0] : high[0];
            for (const glm::dvec2 uv :
                 {glm::dvec2(left, high[1]), {right, high[1]}, {right, low[1]}, {left, low[1]}})
                scene.uvs.emplace_back(uv.x, uv.y, 0, 0);
            if (size == 1) {
                // The centre, at 0.5, is covered.
                ASSERT_EQ(make_atlas(scene, {}, of_set(0, 1)).texels.size(), 1u);
            }
            const AtlasLayout atlas = make_atlas(scene, {}, of_set(0, size));
            test::expect_sound(scene, atlas);
            expect_reference(scene, atlas, size, 0);
            std::size_t wanted = 0;
            const auto along = [&](int axis, double texel) {
                return std::max(0.0, std::min(texel + 1, double{float(high[axis])} * size) -
                                         std::max(texel, double{float(low[axis])} * size));
            };
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) wanted += along(0, x) * along(1, y) > 1e-9;
            EXPECT_EQ(atlas.texels.size(), wanted);
            const double texel_area = 9.0 / ((high[0] - low[0]) * (high[1] - low[1]) * size * size);
            for (const AtlasTexel& texel : atlas.texels) {
                const glm::dvec2 first = test::corner_of(texel, size);
                const double share = along(0, first.x) * along(1, first.y);
                EXPECT_NEAR(double{texel.coverage}, share, 1e-7);
                EXPECT_NEAR(double{texel.area}, share * texel_area, 1e-6 * texel_area);
                // The surface of the place lies where the coordinates say, also off the centre.
                const glm::dvec3 place = test::place_of(scene, texel);
                const double u = (place.x / 3 + 0.5) * (right - left) + left;
                EXPECT_GE(u * size, first.x - 1e-4);
                EXPECT_LE(u * size, first.x + 1 + 1e-4);
            }
        }
}

// A right triangle with legs of 3.8 texels: areas and centroids by hand.
TEST(AtlasOfUvs, TakesCentroidsWhereCentresAreBare) {
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {0, 0, 0}, {3.8, 0, 0}, {0, 3.8, 0});
    for (const glm::vec2 uv : {glm::vec2(0, 0), {3.8f / 8, 0}, {0, 3.8f / 8}})
        scene.uvs.emplace_back(uv.x, uv.y, 0, 0);
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(0, 8));
    ASSERT_EQ(atlas.texels.size(), 10u);
    for (const AtlasTexel& texel : atlas.texels) {
        const glm::dvec2 first = test::corner_of(texel, 8);
        const double diagonal = first.x + first.y;  // of the texels that the long side crosses
        EXPECT_EQ(texel.centre, diagonal < 3);
        EXPECT_NEAR(double{texel.coverage},
                    diagonal == 3   ? 0.5 * 0.8 * 0.8
                    : diagonal == 2 ? 1 - 0.5 * 0.2 * 0.2
                                    : 1.0,
                    1e-6);
        const glm::dvec3 place = test::place_of(scene, texel);
        const double within = diagonal < 3 ? 0.5 : 0.8 / 3;
        EXPECT_NEAR(place.x, first.x + within, 1e-6);
        EXPECT_NEAR(place.y, first.y + within, 1e-6);
    }
}

// A flap that is folded over its own chart.
TEST(AtlasOfUvs, TakesTheFirstTriangleWhereAChartLiesOnItself) {
    Scene scene = charted(glm::vec2(0.8f));
    test::add_triangle(scene, scene.positions[1], scene.positions[0], {0, 1, 2});
    scene.uvs.push_back(scene.uvs[1]);
    scene.uvs.push_back(scene.uvs[0]);
    scene.uvs.emplace_back(0, 0, 0.4f, 0.79f);
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 100));
    EXPECT_EQ(atlas.charts.size(), 1u);
    ASSERT_EQ(atlas.warnings.size(), 1u);
    test::expect_sound(scene, atlas);
    expect_reference(scene, atlas, 100, 1);
}

TEST(AtlasOfUvs, GivesATexelToOneChart) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    test::add_floor(scene, 1.0, 2.0);
    // The charts meet at 0.7 of texel 5.
    for (const glm::vec2 range : {glm::vec2(0, 5.7f / 8), {5.7f / 8, 1}})
        for (const glm::vec2 uv : {glm::vec2(0, 1), {1, 1}, {1, 0}, {0, 0}})
            scene.uvs.emplace_back(0, 0, glm::mix(range.x, range.y, uv.x), uv.y);
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 8));
    test::expect_sound(scene, atlas);
    ASSERT_EQ(atlas.texels.size(), 64u);
    ASSERT_EQ(atlas.warnings.size(), 1u);
    EXPECT_NE(atlas.warnings[0].find("8 of 64 texels are shared"), std::string::npos);
    for (const AtlasTexel& texel : atlas.texels)
        if (texel.texel % 8 == 5) {
            EXPECT_EQ(texel.chart, 0u);
            EXPECT_NEAR(double{texel.coverage}, 0.7, 1e-6);
        }
    EXPECT_NEAR(atlas.skipped_area, 4.0 * 0.3 / 2.3, 1e-6);
}

// Two squares on 8 texels; the second in its own place of the coordinates.
Scene two_squares(const glm::vec2& high, const glm::vec2& low, const glm::vec2& far) {
    Scene scene = charted(high / 8.0f);
    test::add_floor(scene, 1.0, 2.0);
    for (const glm::vec2 uv : {glm::vec2(0, 1), {1, 1}, {1, 0}, {0, 0}})
        scene.uvs.emplace_back(0, 0, glm::mix(low.x, far.x, uv.x) / 8,
                               glm::mix(low.y, far.y, uv.y) / 8);
    return scene;
}

TEST(AtlasOfUvs, GivesATexelToTheChartThatHasMoreOfIt) {
    const Scene scene = two_squares({4.2f, 4.2f}, {4.6f, 4.6f}, {8, 8});
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 8));
    test::expect_sound(scene, atlas);
    const auto texel = std::find_if(atlas.texels.begin(), atlas.texels.end(),
                                    [](const AtlasTexel& t) { return t.texel == 4 * 8 + 4; });
    ASSERT_NE(texel, atlas.texels.end());
    EXPECT_EQ(texel->chart, 1u);
    EXPECT_FALSE(texel->centre);
    EXPECT_NEAR(double{texel->coverage}, 0.16, 1e-6);
}

// At a centre the first counts, even with less of the texel: half a texel of 64 is in both.
TEST(AtlasOfUvs, GivesACentreToTheFirstTriangle) {
    const Scene scene = two_squares({3.95f, 8}, {3.875f, 0}, {8, 0.5f});
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 64));
    test::expect_sound(scene, atlas);
    expect_reference(scene, atlas, 64, 1);
    EXPECT_NE(atlas.warnings.at(0).find("covered more than once"), std::string::npos);
}

// A part so near to the side opposite to the first corner that its weight is lost in rounding.
TEST(AtlasOfUvs, KeepsWeightsWithinTheTriangle) {
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {0, 0.5, 0}, {1, 0, 0}, {1, 1, 0});
    const float side = std::nextafter(0.5f, 1.0f);
    for (const glm::vec2 uv : {glm::vec2(0, 0.5f), {side, 0}, {side, 1}})
        scene.uvs.emplace_back(0, 0, uv.x, uv.y);
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 64));
    test::expect_sound(scene, atlas);
    EXPECT_TRUE(std::any_of(atlas.texels.begin(), atlas.texels.end(),
                            [](const AtlasTexel& t) { return t.texel % 64 == 32; }));
}

TEST(AtlasOfUvs, RefusesWhatIsNoLightmap) {
    const auto regions = [](const Scene& scene) { return test::regions(scene, 2); };
    Scene scene = unwrapped(3);
    for (glm::vec4& uv : scene.uvs) uv *= 3.0f;
    EXPECT_THROW(make_atlas(scene, regions(scene), of_set(1, 64)), InputError);
    // Charts are made instead, and somebody who meant it to be a lightmap hears of it.
    AtlasLayout atlas = make_atlas(scene, regions(scene), {});
    EXPECT_EQ(atlas.uv_set, -1);
    ASSERT_EQ(atlas.warnings.size(), 1u);
    EXPECT_NE(atlas.warnings[0].find("outside"), std::string::npos);
    for (glm::vec4& uv : scene.uvs) uv = glm::vec4(0.0f);
    atlas = make_atlas(scene, regions(scene), {});
    EXPECT_EQ(atlas.charts.size(), 6u);
    EXPECT_TRUE(atlas.warnings.empty());
    EXPECT_THROW(make_atlas(scene, {}, {}), Error);
    // Set 0 is for textures, unless it is asked for.
    Scene textured = unwrapped(3);
    for (glm::vec4& uv : textured.uvs) uv = {uv.z, uv.w, 0, 0};
    EXPECT_EQ(make_atlas(textured, regions(textured), {}).uv_set, -1);
    EXPECT_EQ(make_atlas(textured, {}, of_set(0, 64)).uv_set, 0);
    EXPECT_THROW(make_atlas(scene, {}, of_set(0, 64)), InputError);

    scene = unwrapped(3);
    scene.uvs[7].w = std::numeric_limits<float>::quiet_NaN();
    for (const AtlasUvs uvs : {AtlasUvs::automatic, AtlasUvs::set_1}) {
        AtlasOptions options;
        options.uvs = uvs;
        EXPECT_THROW(make_atlas(scene, regions(scene), options), InputError);
    }
    EXPECT_THROW(make_atlas(Scene(), {}, {}), InputError);
}

TEST(AtlasOfUvs, CountsTrianglesWithoutAreaAsSkipped) {
    Scene scene = unwrapped(6);
    for (std::size_t i = 0; i < 4; ++i) scene.uvs[i] = glm::vec4(0, 0, 0.5f, 0.9f);
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 64));
    test::expect_sound(scene, atlas);
    EXPECT_NEAR(atlas.skipped_area, 4.0, 1e-9);
    EXPECT_EQ(atlas.triangle_chart[1], test::no_region);
    ASSERT_EQ(atlas.warnings.size(), 1u);
}

TEST(AtlasOfUvs, CountsWhatLiesBeyondThePageAsSkipped) {
    const Scene scene = charted({1.05f, 1.0f});
    const AtlasLayout atlas = make_atlas(scene, {}, of_set(1, 8));
    test::expect_sound(scene, atlas);
    EXPECT_EQ(atlas.texels.size(), 64u);
    EXPECT_NEAR(atlas.skipped_area, 4.0 * 0.05 / 1.05, 1e-6);
}

// Every empty texel within the padding has the listed texel that is nearest to it, and no other.
TEST(AtlasDilation, FillsEmptyTexelsFromTheNearest) {
    for (const int padding : {1, 2, 5}) {
        Scene scene = test::plain_scene();
        test::add_triangle(scene, {0, 0, 0}, {3, 0.2, 0}, {1, 4, 0});
        test::add_box(scene, {6, 0, 0}, {7, 2, 1}, 1);
        const AtlasLayout atlas =
            make_atlas(scene, test::regions(scene, 1), test::made_charts(48, padding, 2));
        test::expect_sound(scene, atlas);
        std::vector<int> source(static_cast<std::size_t>(48 * 48 * atlas.pages), -1);
        for (const AtlasDilated& dilated : atlas.dilated)
            source[dilated.texel] = static_cast<int>(dilated.source);
        for (int at = 0; at < 48 * 48 * atlas.pages; ++at) {
            int nearest = -1, least = 1 << 20;
            bool listed = false;
            for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
                const int other = static_cast<int>(atlas.texels[i].texel);
                if (other / (48 * 48) != at / (48 * 48)) continue;
                const int x = std::abs(other % 48 - at % 48),
                          y = std::abs(other / 48 % 48 - at / 48 % 48);
                listed = listed || other == at;
                if (std::max(x, y) > padding || x * x + y * y >= least) continue;
                least = x * x + y * y;
                nearest = static_cast<int>(i);
            }
            EXPECT_EQ(source[static_cast<std::size_t>(at)], listed ? -1 : nearest) << at;
        }
    }
}

}  // namespace
}  // namespace clgi
