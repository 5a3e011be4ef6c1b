// What lobes reflect of what records have around them, with buffers of the test's own.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/passes/cache.hpp>
#include <clgi/procedural.hpp>
#include <cmath>
#include <limits>

#include "glossy_records.hpp"
#include "math_modes.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(GlossPasses);

// Even light by the lobe's albedo at each angle, for tilted surfaces, those of normal textures, and
// an eye near by or far away. A normal that faces away counts as one that faces the eye.
TEST_P(GlossPasses, ReflectEvenLightByTheirAlbedo) {
    const glm::dvec3 tilted = glm::normalize(glm::dvec3(0.4, 0.8, -0.3)), base(0.8, 0.5, 0.2),
                     light(1.0, 3.0, 0.25);
    int away = 0;
    for (const bool far_eye : {false, true}) {
        Glossy in(finishes, {{{0, 0, 0}, tilted}}, 8);
        in.fill(0, light);
        in.params.exposure = 2.0f;
        std::vector<Point> points;
        std::vector<glm::dvec3> wanted;
        const glm::dvec3 eye =
            in.scene.frame().scale * (glm::dvec3(0.5, 0.9, 1.0) - in.scene.frame().origin);
        in.params.eye = glm::vec4(far_eye ? glm::normalize(glm::dvec3(-0.6, 0.4, 0.2)) : eye,
                                  far_eye ? 1.0f : 0.0f);
        for (int material = 0; material < 4; ++material)
            for (const double across : {-1.5, 0.0, 0.6})
                for (const int mapped : {-1, 36000 | 50000 << 16, 20000 | 14000 << 16}) {
                    points.push_back({{across, 0.1, 0.2}, tilted, base, material, mapped});
                    glm::dvec3 viewer =
                        far_eye ? glm::dvec3(in.params.eye)
                                : glm::normalize(glm::dvec3(0.5, 0.9, 1.0) - points.back().place);
                    const glm::dvec3 normal = mapped == -1 ? tilted : test::detail_normal(mapped);
                    const double facing = glm::dot(normal, viewer);
                    away += facing < 0.0;
                    if (facing < 0.0) viewer -= 2.0 * facing * normal;
                    const LobeAlbedo albedo =
                        lobe_albedo(finishes[static_cast<std::size_t>(material)], normal, viewer);
                    wanted.push_back(2.0 * (albedo.white + albedo.tint * base) * light);
                }
        const std::vector<glm::dvec3> found = in.reflected(points);
        EXPECT_EQ(in.non_finite, 0u);
        for (std::size_t p = 0; p < points.size(); ++p)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[p][c], wanted[p][c], 0.015 * wanted[p][c] + 1e-4)
                    << far_eye << " " << p << " " << c;
    }
    EXPECT_GT(away, 0);
}

constexpr int sky_columns = 6, sky_rows = 5;

// The texel of a sky in a direction. u = across / (2 pi) + 1/2 + turn.
int sky_texel(const glm::dvec3& d, double turn) {
    double u = std::atan2(d.x, -d.z) / (2 * pi) + 0.5 + turn;
    u -= std::floor(u);
    const double v = std::acos(std::clamp(d.y, -1.0, 1.0)) / pi;
    return std::min(static_cast<int>(v * sky_rows), sky_rows - 1) * sky_columns +
           std::min(static_cast<int>(u * sky_columns), sky_columns - 1);
}

// Three records of which the second was met, under a sky whose texels differ.
struct UnderASky {
    explicit UnderASky(const std::vector<Material>& materials, std::uint32_t in_one_of = 1)
        : every(in_one_of),
          in(materials, {{{0, 0, 0}, up}, {{0.1, 0, 0}, up}, {{0.2, 0.1, 0}, tilted}}, 64) {
        in.of = {1, 1, 2, 64 / every};
        test::Random random(7);
        for (int k = 0; k < sky_columns * sky_rows; ++k)
            sky.emplace_back(random(0.5, 4.0), random(0.5, 4.0), random(0.5, 4.0));
        // One whose largest channel rounds up to the next power of two.
        sky[8] = {std::nextafter(4.0f, 0.0f), 1.0, 0.5};
        std::vector<float> texels;
        for (const glm::dvec3& value : sky)
            for (int c = 0; c < 3; ++c) texels.push_back(static_cast<float>(value[c]));
        in.b.sky = test::upload(texels);
        in.around = test::empty<std::uint64_t>(around_bytes(in.of) / sizeof(std::uint64_t));
        look_around();
    }

    void look_around() {
        CacheParams params{};
        params.count = 3;
        params.stride = test::record_stride;
        params.size = 64;
        params.sky = glm::vec4(factor, 0.0);
        params.sky_width = sky_columns;
        params.sky_height = sky_rows;
        params.sky_turn = static_cast<float>(turn);
        params.emitter_step = params.thin = 1;
        params.every = every;
        CachePasses(test::programs(), test::usual_build())
            .around(test::device().queue, params, in.of, in.tree, in.scene, no_emitters(), in.b,
                    in.around)
            .wait();
    }

    glm::dvec3 toward(const glm::dvec3& d) const {
        return factor * sky[static_cast<std::size_t>(sky_texel(glm::normalize(d), turn))];
    }

    const glm::dvec3 up{0, 1, 0}, tilted = glm::normalize(glm::dvec3(0.6, 0.5, -0.3)),
                                  factor{1.0, 0.5, 2.0};
    const double turn = 0.15;
    std::vector<glm::dvec3> sky;
    std::uint32_t every;  // columns and rows
    Glossy in;
};

void look_at_the_sky(std::uint32_t every) {
    UnderASky under(finishes, every);
    const CacheAround& of = under.in.of;
    const auto words =
        test::download<std::uint64_t>(under.in.around, around_bytes(of) / sizeof(std::uint64_t));
    const auto views = test::download<View>(under.in.b.views, 15);
    std::size_t other = 0, all = 0;
    for (std::uint32_t slot = 0; slot < 2; ++slot) {
        std::uint32_t first[AROUND_LEVELS];
        for (std::uint32_t level = 0; level < AROUND_LEVELS; ++level)
            first[level] =
                around_first(2, of.size, level) + (slot * 3 * of.size * of.size >> 2 * level);
        for (std::uint32_t face = 0; face < 5; ++face) {
            const std::uint32_t record = slot == 0 ? 0 : 2, shift = 5 * face + record;
            const View& view = views[5 * record + face];
            const std::uint32_t columns = view.width / every, rows = view.height / every;
            for (std::uint32_t y = 0; y < rows; ++y)
                for (std::uint32_t x = 0; x < columns; ++x, ++all) {
                    const std::uint32_t column = x * every + shift % every,
                                        row = y * every + shift / every % every;
                    const double across = (column + 0.5) / view.width * 2.0 - 1.0,
                                 upward = 1.0 - (row + 0.5) / view.height * 2.0;
                    const glm::dvec3 d =
                        glm::dvec3(view.forward) +
                        (double{view.window.x} + across * double{view.right.w}) *
                            glm::dvec3(view.right) +
                        (double{view.window.y} + upward * double{view.up.w}) * glm::dvec3(view.up);
                    const glm::dvec3 found = unpacked(words[first[0] + y * columns + x]),
                                     wanted = under.toward(d);
                    other += glm::length(found - wanted) > 0.01 * glm::length(wanted);
                }
            for (std::uint32_t level = 1; level < AROUND_LEVELS; ++level) {
                const std::uint32_t width = columns >> level, height = rows >> level;
                for (std::uint32_t y = 0; y < height; ++y)
                    for (std::uint32_t x = 0; x < width; ++x) {
                        glm::dvec3 mean(0.0);
                        for (std::uint32_t k = 0; k < 4; ++k)
                            mean +=
                                0.25 * unpacked(words[first[level - 1] +
                                                      (2 * y + k / 2) * 2 * width + 2 * x + k % 2]);
                        const glm::dvec3 found = unpacked(words[first[level] + y * width + x]);
                        for (int c = 0; c < 3; ++c)
                            ASSERT_NEAR(found[c], mean[c],
                                        2e-5 * std::max({mean.x, mean.y, mean.z}));
                    }
            }
            for (std::uint32_t level = 0; level < AROUND_LEVELS; ++level)
                first[level] += columns * rows >> 2 * level;
        }
    }
    // The square below, and directions between two texels.
    EXPECT_LT(static_cast<double>(other), 0.002 * static_cast<double>(all));
}

TEST_P(GlossPasses, HaveTheSkyAroundThem) {
    for (const std::uint32_t every : {1u, 2u}) look_at_the_sky(every);
}

// Smooth metal shows the sky in the mirrored direction, above the record's surface if it points
// below.
TEST_P(GlossPasses, ShowWhatIsMirrored) {
    const Material mirror = test::finished(1.0f, 0.0f, 1.0f);
    UnderASky under({mirror});
    under.in.params.directions = under.in.params.shared = 16384;
    test::Random random(3);
    std::size_t looked = 0;
    const auto any = [&] { return glm::dvec3(random(-1, 1), random(-1, 1), random(-1, 1)); };
    for (int trial = 0; trial < 24; ++trial) {
        const glm::dvec3 eye = glm::normalize(under.up + under.tilted + 0.8 * any());
        under.in.params.eye = glm::vec4(eye, 1.0f);
        std::vector<Point> points;
        std::vector<glm::dvec3> wanted;
        for (int k = 0; k < 40; ++k) {
            const bool second = k % 2 != 0;
            const glm::dvec3 own = second ? under.tilted : under.up,
                             normal = glm::normalize(own + 0.6 * any());
            if (glm::dot(normal, eye) < 0.15 || glm::dot(normal, own) < 0.6) continue;
            glm::dvec3 d = 2.0 * glm::dot(normal, eye) * normal - eye;
            if (glm::dot(d, own) < 0.0) d -= 2.0 * glm::dot(d, own) * own;
            bool alone = true;
            for (int other = 0; other < 60; ++other)
                alone = alone && under.toward(d + 0.12 * any()) == under.toward(d);
            if (!alone) continue;
            points.push_back(
                {second ? glm::dvec3(0.2, 0.1, 0) : glm::dvec3(0), normal, glm::dvec3(1.0), 0, -1});
            wanted.push_back(under.toward(d));
        }
        const std::vector<glm::dvec3> found = under.in.reflected(points);
        for (std::size_t p = 0; p < points.size(); ++p) {
            ++looked;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[p][c], wanted[p][c], 0.02 * wanted[p][c] + 0.04)
                    << trial << " " << p;
        }
    }
    EXPECT_GT(looked, 40u);
}

// Rough lobes weigh the sky by direction.
TEST_P(GlossPasses, WeighTheSkyByTheirLobes) {
    UnderASky under(finishes);
    const glm::dvec3 normal = under.up, base(0.9, 0.6, 0.3);
    for (const double across : {0.2, 0.8, 0.99})
        for (int material = 0; material < 4; ++material) {
            const glm::dvec3 viewer = glm::normalize(
                glm::dvec3(across, std::sqrt(1.0 - across * across), 0.1 * material));
            under.in.params.eye = glm::vec4(viewer, 1.0f);
            const Point point = {{0, 0, 0}, normal, base, material, -1};
            const LobeLight wanted =
                lobe_light(finishes[static_cast<std::size_t>(material)], normal, viewer,
                           [&](const glm::dvec3& d) { return under.toward(d); });
            const glm::dvec3 found = under.in.reflected({point})[0];
            for (int c = 0; c < 3; ++c) {
                const double all = wanted.white[c] + base[c] * wanted.tint[c];
                EXPECT_NEAR(found[c], all, 0.02 * all) << across << " " << material << " " << c;
            }
        }
}

// Along each axis what is ahead, and not what is beside it.
TEST_P(GlossPasses, ReflectWhatLiesStraightAhead) {
    const Material metal = test::finished(1.0f, 0.1f, 1.0f);
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            glm::dvec3 normal(0.0);
            normal[axis] = sign;
            Glossy in({metal}, {{{0, 0, 0}, normal}}, 8);
            in.fill(0, {9.0, 9.0, 9.0});
            std::fill_n(in.words.begin(), 8 * 8, packed({1.0, 2.0, 4.0}));
            in.params.eye = glm::vec4(normal, 1.0f);
            const LobeAlbedo albedo = lobe_albedo(metal, normal, normal);
            const double wanted = 2.0 * (albedo.white + albedo.tint);
            EXPECT_NEAR(in.reflected({{{0, 0, 0}, normal}})[0].y, wanted, 0.02 * wanted) << axis;
        }
}

// What was corrected in the irradiance is so in the gloss, up to twice as much.
TEST_P(GlossPasses, FollowCorrections) {
    Glossy in(finishes, {{{0, 0, 0}, {0, 1, 0}}}, 8);
    in.fill(0, {1.0, 2.0, 4.0});
    const std::vector<Point> points(4, Point{});
    const std::vector<glm::dvec3> plain = in.reflected(points, 1.0f);
    for (const float corrected : {0.0f, 0.25f, 1.5f, 2.0f, 7.0f}) {
        const std::vector<glm::dvec3> found = in.reflected(points, corrected);
        for (std::size_t p = 0; p < points.size(); ++p)
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[p][c], std::min(corrected, 2.0f) * plain[p][c], 1e-5);
    }
}

// The fewer directions, the more each stands for. Two of them at 32 pixels a side: 16 pixels or
// more, and at most 32 where the lobe is at least half as dense, 1 - sqrt(1 / 2) of it.
TEST_P(GlossPasses, LookUpAsMuchAsADirectionStandsFor) {
    const Material smooth = test::finished(1.0f, std::sqrt(0.1f), 1.0f);
    for (std::uint32_t level = 0; level < AROUND_LEVELS; ++level) {
        Glossy in({smooth}, {{{0, 0, 0}, {0, 1, 0}}}, 32);
        for (std::uint32_t k = 0; k < AROUND_LEVELS; ++k)
            in.fill(0, k, glm::dvec3(k == level ? 1.0 : 1e-6));
        const std::uint32_t counts[] = {65536, 2, 1};
        in.params.directions = in.params.shared = counts[level];
        glm::dvec3 mean(0.0);
        const std::vector<Point> points(400, Point{});
        for (const glm::dvec3& found : in.reflected(points)) mean += found / 400.0;
        const LobeAlbedo albedo = lobe_albedo(smooth, {0, 1, 0}, {0, 1, 0});
        const double share = mean.x / (albedo.white + albedo.tint);
        EXPECT_NEAR(share, level == 1 ? 0.293 : 0.98, 0.025) << level;
    }
}

// Samples go on where the one before ended, and pixels have their own.
TEST_P(GlossPasses, DrawOtherDirectionsInEachSampleAndPixel) {
    Glossy in(finishes, {{{0, 0, 0}, {0, 1, 0}}}, 8);
    in.fill(0, {1.0, 2.0, 4.0});
    in.params.eye = glm::vec4(glm::normalize(glm::vec3(1.0f, 0.3f, 0.0f)), 1.0f);
    const std::vector<Point> points(2, Point{});
    in.params.directions = 4;
    const std::vector<glm::dvec3> first = in.reflected(points);
    in.params.first_direction = 4;
    const std::vector<glm::dvec3> second = in.reflected(points);
    in.params.first_direction = 0;
    in.params.directions = 8;
    const std::vector<glm::dvec3> both = in.reflected(points);
    for (std::size_t p = 0; p < 2; ++p)
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(both[p][c], 0.5 * (first[p][c] + second[p][c]), 1e-5);
    EXPECT_GT(std::abs(first[0].x - second[0].x), 1e-4);
    EXPECT_GT(std::abs(first[0].x - first[1].x), 1e-4);
}

TEST_P(GlossPasses, CountWhatIsNotFinite) {
    Glossy in(finishes, {{{0, 0, 0}, {0, 1, 0}}}, 8);
    in.fill(0, {1.0, 2.0, 4.0});
    for (std::uint64_t& word : in.words) word = ~std::uint64_t{0};
    EXPECT_EQ(in.reflected(std::vector<Point>(3, Point{}))[2], glm::dvec3(0.0));
    EXPECT_EQ(in.non_finite, 9u);

    UnderASky under(finishes);
    under.in.b.light = test::upload(
        std::vector<float>(3 * test::record_stride, std::numeric_limits<float>::quiet_NaN()));
    under.in.b.sky = test::upload(
        std::vector<float>(3 * sky_columns * sky_rows, std::numeric_limits<float>::infinity()));
    under.look_around();
    under.in.reflected(std::vector<Point>(3, Point{}));
    EXPECT_EQ(under.in.non_finite, 9u);
}

// A pixel whose place is no number leaves its neighbours as they are.
TEST_P(GlossPasses, KeepToTheirPixels) {
    Glossy in(finishes, {{{0, 0, 0}, {0, 1, 0}}}, 8);
    in.fill(0, {1.0, 2.0, 4.0});
    in.params.eye = {0.3f, 1.0f, 0.2f, 0.0f};
    std::vector<Point> points(5, Point{});
    const std::vector<glm::dvec3> right = in.reflected(points);
    points[2].place = glm::dvec3(std::numeric_limits<double>::quiet_NaN());
    const std::vector<glm::dvec3> found = in.reflected(points);
    for (const std::size_t p : {0, 1, 3, 4}) EXPECT_EQ(found[p], right[p]) << p;
}

TEST(GlossPasses, RefuseWhatDoesNotFit) {
    Glossy in(finishes, {{{0, 0, 0}, {0, 1, 0}}, {{1, 0, 0}, {0, 1, 0}}}, 8);
    const std::vector<Point> one(1, Point{});
    EXPECT_NO_THROW(in.reflected(one));
    in.params.directions = 0;
    EXPECT_THROW(in.reflected(one), Error);
    in.params.directions = 1;
    in.params.shared = 0;
    EXPECT_THROW(in.reflected(one), Error);
    in.params.shared = 1;
    for (const CacheAround of : {CacheAround{2, 0, 1, 8}, CacheAround{2, 1, 1, 8},
                                 CacheAround{0, 0, 2, 12}, CacheAround{0, 3, 2, 8}}) {
        in.of = of;
        EXPECT_THROW(in.reflected(one), Error);
    }
    in.of = {2, 0, 2, 8};
    in.around = test::empty<std::uint64_t>(around_bytes(in.of) / sizeof(std::uint64_t) - 1);
    EXPECT_THROW(in.reflected(one), Error);
}

}  // namespace
}  // namespace clgi
