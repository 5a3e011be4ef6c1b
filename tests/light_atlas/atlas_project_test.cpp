// The paper's filling of the atlas: which texels a VPL lights, and how strongly.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "math_modes.hpp"
#include "one_batch.hpp"

namespace clgi {
namespace {

using test::HandVpl;
using test::OneBatch;

// What all VPLs would send to a texel if nothing stood between.
glm::dvec4 all_sent(const OneBatch& batch, std::uint32_t texel) {
    glm::dvec4 out(0.0);
    for (const HandVpl& vpl : batch.vpls) out += batch.sent(texel, vpl);
    return out;
}

// Of a texel that one VPL lights: the share of what it sends; expects all channels to agree.
double share(const OneBatch& batch, const std::vector<float>& light, std::uint32_t texel) {
    const glm::dvec4 sent = batch.sent(texel, batch.vpls[0]);
    const double out = light[3 * batch.stride + texel] / sent.w;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(light[c * batch.stride + texel], out * sent[c], 1e-5 * sent[c]);
    return out;
}

// Float positions of texels and VPLs, near by, and some ten roundings.
constexpr double close = 2e-5;

Scene floor_scene() {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    return scene;
}

AtlasLayout charts_of_quads(const Scene& scene, int size) {
    return make_atlas(scene, test::regions(scene, 2), test::made_charts(size));
}

// A floor with a square plate above it, and a VPL above both.
struct Plate {
    static constexpr double half = 0.2, height = 0.4, lamp = 1.0;
    static OneBatch over_floor(int texels, int face_size) {
        Scene scene = floor_scene();
        test::add_floor(scene, half, height);
        return OneBatch(scene, charts_of_quads(scene, texels),
                        {HandVpl{{0.13, lamp, -0.07}, {0.0, -1.0, 0.0}}}, face_size);
    }
    // On the floor: how far beyond the plate's shadow, on the image plane; negative inside.
    static double outside(const OneBatch& batch, std::uint32_t texel) {
        const glm::dvec3 p = batch.place(texel), eye = batch.vpls[0].position;
        const auto beyond = [&](double at, double from) {
            const double edge = half * (at > from ? 1.0 : -1.0);
            return ((at - from) / lamp - (edge - from) / (lamp - height)) *
                   (at > from ? 1.0 : -1.0);
        };
        return std::max(beyond(p.x, eye.x), beyond(p.z, eye.z));
    }
};

// A texel of the floor that is no nearer than this to the floor's rim, beyond which nothing is.
bool on_floor(const OneBatch& batch, std::uint32_t texel, double from_rim) {
    const glm::dvec3 p = glm::abs(batch.place(texel));
    return p.y < 0.5 * Plate::height && std::max(p.x, p.z) < 1.0 - from_rim;
}

TEST(AtlasProject, LightsAFloorByTheClosedForm) {
    const Scene scene = floor_scene();
    const AtlasLayout atlas = charts_of_quads(scene, 48);
    const HandVpl tilted{{0.2, 0.3, 0.1}, glm::normalize(glm::dvec3(0.3, -1.0, -0.2))};
    const HandVpl upright{{-0.4, 0.5, 0.3}, {0.0, -1.0, 0.0}, 0.02, {0.1, 0.9, 0.4}, {1, 2, 3}};
    for (const int reach : {0, 5}) {
        OneBatch batch(scene, atlas, {tilted, upright}, 64);
        const auto light = batch.project(16, reach);
        for (std::uint32_t i = 0; i < batch.texels; ++i) {
            const glm::dvec4 sent = all_sent(batch, i);
            // Behind the tilted VPL's horizon its share is 0, by the facing of the lifted eye too.
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(light[c * batch.stride + i], sent[c], close * sent[c] + 1e-9)
                    << "texel " << i << ", reach " << reach;
        }
    }
}

// Shading normals that turn from corner to corner, by up to half a radian from the triangle's.
TEST(AtlasProject, LightsACurvedSurfaceByItsOwnNormals) {
    Scene scene = floor_scene();
    for (std::size_t v = 0; v < scene.normals.size(); ++v)
        scene.normals[v] =
            glm::normalize(glm::vec3(0.3f - 0.2f * float(v), 1.0f, v % 2 == 0 ? -0.35f : 0.1f));
    OneBatch batch(scene, charts_of_quads(scene, 32),
                   {HandVpl{{0.3, 0.6, -0.2},
                            glm::normalize(glm::dvec3(-0.2, -1.0, 0.1)),
                            0.02,
                            {0.1, 0.9, 0.4},
                            {1, 2, 3}}},
                   64);
    const auto light = batch.project(16, 0);
    double most = 0.0;
    for (std::uint32_t i = 0; i < batch.texels; ++i) {
        const glm::dvec4 sent = batch.sent(i, batch.vpls[0]);
        const double cosine =
            batch.normal(i).y;  // with the triangle's: what a flat floor would have is another
        most = std::max(most, std::abs(cosine - 1.0));
        // Cosines down to 0 lose relative bits: a float's of the largest.
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(light[c * batch.stride + i], sent[c], close * sent[c] + 1e-7) << i;
    }
    EXPECT_GT(most, 0.05);
}

TEST(AtlasProject, AddsToWhatIsThere) {
    const Scene scene = floor_scene();
    OneBatch batch(scene, charts_of_quads(scene, 16), {HandVpl{{0, 0.5, 0}, {0, -1, 0}}}, 32);
    const auto once = batch.project(4, 0);
    const cl::Buffer light = test::upload(std::vector<float>(3 * batch.stride, 0.5f));
    const cl::Buffer filled = test::upload(std::vector<float>(batch.stride, 0.25f));
    for (const std::uint32_t shooters : {0u, 1u})
        test::atlas_passes().project(test::device().queue, batch.fill_params(0, shooters),
                                     {1, 32, 4, 0}, batch.sites, batch.views, batch.visibility,
                                     batch.mesh, batch.planes, light, filled);
    const auto twice = batch.joined(light, filled);
    for (std::uint32_t i = 0; i < batch.texels; ++i) {
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(twice[c * batch.stride + i], 0.5f + once[c * batch.stride + i]);
        EXPECT_EQ(twice[3 * batch.stride + i], 0.25f + once[3 * batch.stride + i]);
    }
}

// In a convex room everything in front of a VPL is lit, by one triangle of M each. Low above the
// floor the walls' triangles reach beyond the floor's horizon.
TEST(AtlasProject, LightsEveryTexelOfAConvexRoomOnce) {
    const Scene scene = test::inside_of_cube();
    const AtlasLayout atlas = charts_of_quads(scene, 64);
    ASSERT_EQ(atlas.charts.size(), 6u);
    for (const glm::dvec3 at : {glm::dvec3(-0.4999, -0.4, 0.13), glm::dvec3(-0.4999, 0.21, -0.33)})
        for (const std::uint32_t squares : {8u, 16u, 64u}) {
            OneBatch batch(scene, atlas, {HandVpl{at, {1.0, 0.0, 0.0}}}, 128);
            const auto light = batch.project(squares, 0);
            std::size_t dark = 0, lit = 0;
            for (std::uint32_t i = 0; i < batch.texels; ++i) {
                const glm::dvec4 sent = batch.sent(i, batch.vpls[0]);
                if (!(sent.w > 1e-9)) {
                    EXPECT_EQ(light[3 * batch.stride + i], 0.0f);
                    continue;
                }
                const double got = share(batch, light, i);
                if (got == 0.0) {
                    // No corner of its triangle lies in its chart: only beside two other charts.
                    const glm::dvec3 from_middle = glm::abs(batch.place(i));
                    const double across = 1.5 * 2.0 / squares * 1.8;  // on a wall, at most
                    int walls = 0;
                    for (int axis = 0; axis < 3; ++axis) walls += from_middle[axis] > 0.5 - across;
                    EXPECT_GE(walls, 2);
                    ++dark;
                } else {
                    EXPECT_NEAR(got, 1.0, close);
                    ++lit;
                }
            }
            // The dark ones lie where two or three charts meet: a line of pieces of triangles.
            EXPECT_LT(static_cast<double>(dark), 0.8 / squares * static_cast<double>(lit))
                << squares;
        }
}

// The stencil of the paper: a chart's texels are lit by copies in that chart alone, and only where
// the copy's box is.
TEST(AtlasProject, WritesNothingOutsideTheChart) {
    const Scene scene = test::inside_of_cube();
    const AtlasLayout atlas = charts_of_quads(scene, 64);
    const HandVpl vpl{{-0.4999, -0.1, 0.13}, {1.0, 0.0, 0.0}};
    const auto lit = [&](auto change) {
        OneBatch batch(scene, atlas, {vpl}, 64);
        change(batch);
        batch.mesh.places = test::upload(batch.places);
        const auto light = batch.project(16, 0);
        std::vector<std::uint32_t> out;
        for (std::uint32_t i = 0; i < batch.texels; ++i)
            if (light[3 * batch.stride + i] > 0.0f) out.push_back(i);
        return out;
    };
    EXPECT_GT(lit([](OneBatch&) {}).size(), atlas.texels.size() / 2);
    for (std::uint32_t shift = 1; shift < 6; ++shift)
        EXPECT_TRUE(lit([&](OneBatch& b) {
                        for (std::uint32_t i = 0; i < b.texels; ++i)
                            b.places[i] = (b.places[i] + shift) % 6;
                    }).empty())
            << shift;
    // A place of the chart that is elsewhere: far from the texel's triangle of M nothing is lit.
    OneBatch batch(scene, atlas, {vpl}, 64);
    for (const int plane : {PLACE_COLUMN, PLACE_ROW}) {
        const auto moved = lit([&](OneBatch& b) {
            for (std::uint32_t i = 0; i < b.texels; ++i) {
                const AtlasChart& chart = atlas.charts[atlas.texels[i].chart];
                b.places[plane * b.stride + i] =
                    static_cast<std::uint32_t>(plane == PLACE_COLUMN ? chart.column : chart.row);
            }
        });
        EXPECT_FALSE(moved.empty());
        std::size_t far_away = 0;
        for (const std::uint32_t i : moved) {
            const AtlasChart& chart = atlas.charts[atlas.texels[i].chart];
            const std::uint32_t first =
                static_cast<std::uint32_t>(plane == PLACE_COLUMN ? chart.column : chart.row);
            far_away += batch.places[plane * batch.stride + i] > first + 16;
        }
        // Triangles that reach beyond a horizon have the whole chart as their box.
        EXPECT_LT(far_away, atlas.texels.size() / 20);
    }
}

// With K = 0 a texel is dark or lit, as the ray to the VPL says, except within a pixel of the edge
// and where the texel's chart is at no corner of its triangle.
CLGI_IN_BOTH_MATHS(AtlasShadows);

TEST_P(AtlasShadows, WithoutAKernelTestsDepthHard) {
    for (const std::uint32_t squares : {16u, 64u}) {
        OneBatch batch = Plate::over_floor(96, 128);
        const auto light = batch.project(squares, 0);
        const double pixel = 2.0 / 128, cell = 2.0 / squares;
        std::size_t dark = 0, lit = 0;
        for (std::uint32_t i = 0; i < batch.texels; ++i) {
            if (!on_floor(batch, i, 3.0 * cell)) continue;
            const double beyond = Plate::outside(batch, i);
            const double got = share(batch, light, i);
            if (got > 0.0) {
                EXPECT_NEAR(got, 1.0, close);
                EXPECT_GT(beyond, -1.5 * pixel) << "a shadowed texel is lit";
                ++lit;
            } else {
                // Narrower than a square, the floor beside the plate may have no corner.
                EXPECT_LT(beyond, std::max(1.5 * pixel, squares < 64 ? 1.5 * cell : 0.0))
                    << "a texel in the light is dark";
                ++dark;
            }
        }
        EXPECT_GT(dark, batch.texels / 20u);
        EXPECT_GT(lit, batch.texels / 5u);
    }
}

// Over the edge of a half-plane the lit share rises from 0 to 1, by symmetry 1/2 on average. The
// edge lies in the middle of a column of squares: texels beyond it have a corner in their chart.
TEST(AtlasProject, SoftensEdgesSymmetrically) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    // Seen from (0, 1, 0) its edge lies at 0.375 on the image plane, between two of 128 pixels.
    test::add_quad(scene,
                   {glm::dvec3(0.1875, 0.5, 1), {1, 0.5, 1}, {1, 0.5, -1}, {0.1875, 0.5, -1}});
    const AtlasLayout atlas = charts_of_quads(scene, 512);
    for (const int reach : {0, 2, 5}) {
        OneBatch batch(scene, atlas, {HandVpl{{0.0, 1.0, 0.0}, {0.0, -1.0, 0.0}}}, 128);
        const auto light = batch.project(8, reach);
        const double pixel = 2.0 / 128, band = 8 * pixel;
        std::vector<std::vector<double>> shares(16);
        for (std::uint32_t i = 0; i < batch.texels; ++i) {
            const glm::dvec3 p = batch.place(i);
            const double from_edge = 0.375 - p.x;  // into the light
            if (p.y > 0.1 || std::abs(p.z) > 0.8 || std::abs(from_edge) > band) continue;
            shares[static_cast<std::size_t>(from_edge / pixel + 8.0)].push_back(
                share(batch, light, i));
        }
        double sum = 0.0, last = 0.0;
        for (int k = 0; k < 16; ++k) {
            ASSERT_GT(shares[k].size(), 20u);
            const auto [low, high] = std::minmax_element(shares[k].begin(), shares[k].end());
            // Of 2 K + 1 columns those on the lit side of the edge: the share of the pixel's
            // column.
            const double wanted = std::clamp((k - 7.0 + reach) / (2 * reach + 1), 0.0, 1.0);
            EXPECT_NEAR(*low, wanted, close) << "column " << k << ", reach " << reach;
            EXPECT_NEAR(*high, wanted, close) << "column " << k << ", reach " << reach;
            EXPECT_GE(*low, last - close);
            last = *high;
            sum += 0.5 * (*low + *high);
        }
        EXPECT_NEAR(sum / 16, 0.5, close);
    }
}

// Pixels beyond the edge of a face are left out, and pixels on the receiver's own plane do not
// shadow it: beside the edges of the faces, and far down a tilted plane, all is lit.
TEST_P(AtlasShadows, DoesNotShadowAPlaneByItself) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 3.0);
    const AtlasLayout atlas = charts_of_quads(scene, 128);
    for (const glm::dvec3 normal : {glm::dvec3(0, -1, 0), glm::dvec3(1, -0.3, 0.2), {0.7, -1, 0.7}})
        for (const int reach : {1, 9}) {
            OneBatch batch(scene, atlas, {HandVpl{{0.3, 0.25, 0.1}, glm::normalize(normal)}}, 64);
            const auto light = batch.project(8, reach);
            for (std::uint32_t i = 0; i < batch.texels; ++i) {
                const glm::dvec4 sent = batch.sent(i, batch.vpls[0]);
                // At the horizon texels come to lie behind the lifted eye; fast math compares less
                // sharply there.
                if (sent.w < (GetParam() == Math::fast ? 1e-6 : 1e-7)) continue;
                EXPECT_NEAR(light[3 * batch.stride + i] / sent.w, 1.0, close + 1e-11 / sent.w);
            }
        }
}

double rms_against(const OneBatch& batch, const std::vector<float>& got,
                   const std::vector<float>& wanted) {
    double error = 0.0, all = 0.0;
    for (int c = 0; c < 3; ++c)
        for (std::uint32_t i = 0; i < batch.texels; ++i) {
            if (!on_floor(batch, i, 0.0)) continue;
            const double g = got[c * batch.stride + i], w = wanted[c * batch.stride + i];
            error += (g - w) * (g - w);
            all += w * w;
        }
    return std::sqrt(error / all);
}

// Figure 7 of the paper: the finer the mesh, the truer the shadows. Plates of many sizes leave gaps
// that a coarse mesh passes over.
TEST(AtlasProject, ComesNearToGatherAsTheMeshGetsFiner) {
    Scene scene = floor_scene();
    test::Random random(3);
    for (int plate = 0; plate < 30; ++plate) {
        const double x = random(-0.6, 0.6), z = random(-0.6, 0.6), y = random(0.3, 0.5),
                     half = random(0.02, 0.08);
        test::add_quad(scene, {glm::dvec3(x - half, y, z + half),
                               {x + half, y, z + half},
                               {x + half, y, z - half},
                               {x - half, y, z - half}});
    }
    std::vector<HandVpl> vpls;
    for (int k = 0; k < 4; ++k)
        vpls.push_back({{random(-0.3, 0.3), 1.0, random(-0.3, 0.3)}, {0.0, -1.0, 0.0}});
    OneBatch batch(scene, charts_of_quads(scene, 96), vpls, 256);
    const auto gathered = batch.gather();
    std::vector<double> errors;
    for (const std::uint32_t squares : {8u, 16u, 64u, 128u}) {
        const double error = rms_against(batch, batch.project(squares, 0), gathered);
        EXPECT_LT(error, 0.7 * (errors.empty() ? 1.0 : errors.back())) << squares;
        errors.push_back(error);
    }
    EXPECT_LT(errors.back(), 0.01);
}

// The form factor is the same function, so away from edges there is no difference but rounding.
TEST(AtlasProject, AgreesWithGatherAwayFromEdges) {
    OneBatch batch = Plate::over_floor(96, 128);
    const auto gathered = batch.gather();
    for (const auto& [squares, reach] : {std::pair{16u, 0}, {64u, 0}, {64u, 5}}) {
        const auto light = batch.project(squares, reach);
        const double away = 2.0 / squares + (reach + 1) * 2.0 / 128;
        std::size_t compared = 0;
        for (std::uint32_t i = 0; i < batch.texels; ++i) {
            const double beyond = Plate::outside(batch, i);
            if (!on_floor(batch, i, 2.0 * away) || (beyond < away && beyond > -away)) continue;
            ++compared;
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(light[c * batch.stride + i], gathered[c * batch.stride + i],
                            1e-6 * gathered[c * batch.stride + i]);
        }
        EXPECT_GT(compared, 1000u);
    }
}

}  // namespace
}  // namespace clgi
