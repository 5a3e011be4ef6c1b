// The last pass, every branch of it, per pixel and channel against double precision: crooked
// surfaces, sources of every kind in colours of their own, full and half shadow.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "frames.hpp"
#include "math_modes.hpp"
#include "oblique.hpp"
#include "shading.hpp"

namespace clgi {
namespace {

using test::Random;
using test::Shading;

enum Source { spot, point, sun, wide_spot, thin_spot, lamp };

// One emitter of each kind as the library makes them, area lights in several samples.
Shading oblique_shading(const std::vector<int>& sources, cl_uint effects, int pixels = 531) {
    Scene scene = test::oblique_room();
    const Light lights[] = {test::oblique_spot(), test::oblique_point(), test::oblique_sun(),
                            test::oblique_wide_spot(), test::oblique_thin_spot()};
    for (const int s : sources) {
        if (s == lamp)
            test::add_oblique_lamp(scene);
        else
            scene.lights.push_back(lights[s]);
    }
    const DeviceScene placed = test::on_device(scene);
    const EmitterSet set =
        make_emitters(placed, {.vpls = 90, .shadow_size = 61, .face_size = 37, .area_samples = 3});
    Shading out;
    out.emitters = set.emitters;
    out.views = set.views;
    for (const Emitter& e : set.emitters)
        if (e.view_count == 1) {  // off the axis, though the library's own are not
            View& view = out.views[e.first_view];
            view.window.x = 0.2f * view.right.w;
            view.window.y = -0.1f * view.up.w;
        }
    out.materials = scene.materials;
    out.view = make_view(test::oblique_camera(), placed.frame(), 40, 30);
    out.params.exposure = 1.0f;
    out.params.texel_bias = 1.5f;
    out.params.effects = effects;
    Random random(17);
    out.visibility.resize(std::max<std::size_t>(set.pixels, 1), ~std::uint64_t{0});
    for (int i = 0; i < pixels; ++i) {
        test::ShadedPixel pixel;
        pixel.position = {random(-0.6, 0.6), random(-0.6, 0.6), random(-0.6, 0.6)};
        pixel.normal = test::random_direction(random);
        pixel.geometric = glm::normalize(pixel.normal + 0.6f * test::random_direction(random));
        pixel.material = random.integer(-1, static_cast<int>(scene.materials.size()) - 1);
        pixel.base = test::random_colour(random, 0.2, 0.9);
        pixel.emission = test::random_colour(random, 0.0, 3.0);
        pixel.irradiance = test::random_colour(random, -4.0, 8.0);
        if (i % 19 == 7) pixel.normal = pixel.geometric = glm::vec3(0);
        out.pixels.push_back(pixel);
    }
    return out;
}

// Puts a blocker into every texel around every receiver: `share` of the bias nearer than what the
// receiver's own plane has there, in a random half of the texels.
void block(Shading& in, double share, Random& random) {
    for (const test::ShadedPixel& pixel : in.pixels)
        for (const Emitter& emitter : in.emitters) {
            if (random(0, 1) < 0.3) continue;
            const test::Shadowed at =
                test::shadowed(emitter, in.views, glm::dvec3(pixel.position),
                               glm::dvec3(pixel.geometric), double{in.params.texel_bias});
            if (at.view == nullptr) continue;
            for (int k = 0; k < 4; ++k) {
                if (random(0, 1) < 0.4) continue;
                const double limit = at.limit(at.column(k & 1), at.row(k >> 1));
                if (std::isnan(limit)) continue;  // no normal, no plane
                in.visibility[at.texel(k & 1, k >> 1)] = test::word_of(
                    static_cast<float>(limit + (share - 1.0) * at.bias), random.integer(0, 99));
            }
        }
}

// Returns how many pixels were compared and how many of them are not black.
std::pair<int, int> expect_truth(const Shading& in, const std::string& what) {
    const test::Combined found = test::combine(in);
    Shading kept = in;
    for (test::ShadedPixel& pixel : kept.pixels) pixel = test::stored(pixel);
    EXPECT_EQ(found.non_finite, 0u) << what;
    int compared = 0, bright = 0;
    for (std::size_t i = 0; i < in.pixels.size(); ++i) {
        const test::ShadedTruth truth = test::shaded_truth(kept, kept.pixels[i]);
        if (truth.doubtful) continue;
        ++compared;
        bright += truth.radiance.x > 0.0;
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.radiance[i][c], truth.radiance[c], truth.bound[c])
                << what << ", pixel " << i << ", channel " << c;
    }
    return {compared, bright};
}

CLGI_IN_ALL_MODES(CombineBorders);

class CombineSource : public testing::TestWithParam<int> {};

TEST_P(CombineSource, LightsAsTheFormulasSay) {
    const auto [compared, bright] =
        expect_truth(oblique_shading({GetParam()}, COMBINE_DIRECT), "open");
    EXPECT_GT(compared, 520);
    EXPECT_GT(bright, GetParam() == thin_spot ? -1 : 40);
}

TEST_P(CombineSource, GlossesAsTheFormulasSay) {
    Shading in = oblique_shading({GetParam()}, COMBINE_DIRECT | COMBINE_SPECULAR);
    EXPECT_GT(expect_truth(in, "perspective").first, 520);
    in.view.eye.w = 1.0f;
    in.view.window.z = 4.0f;
    EXPECT_GT(expect_truth(in, "orthographic").first, 520);
}

TEST_P(CombineSource, IsShadowedByWhatExceedsTheBiasAlone) {
    for (const float texel_bias : {1.5f, 0.25f, 0.0f})
        for (const double share : {0.5, 1.5, 40.0}) {
            Shading in = oblique_shading({GetParam()}, COMBINE_DIRECT);
            in.params.texel_bias = texel_bias;
            Random random(23);
            block(in, share, random);
            const int compared = expect_truth(in, std::to_string(share)).first;
            EXPECT_GT(compared, texel_bias > 0.0f ? 470 : 300) << share;
        }
}

INSTANTIATE_TEST_SUITE_P(Kinds, CombineSource,
                         testing::Values(spot, point, sun, wide_spot, thin_spot, lamp));

// Spots that light what lies around their axes: random places hardly meet a thin cone.
TEST_P(CombineBorders, KnowsTheBordersOfACone) {
    for (const int source : {spot, wide_spot, thin_spot})
        for (const bool hard : {false, true}) {
            Shading in = oblique_shading({source}, COMBINE_DIRECT, 0);
            Emitter& e = in.emitters[0];
            if (hard) e.right.w = e.axis.w;
            const glm::dvec3 axis(e.axis), right(e.right), up = glm::cross(right, axis);
            const double outer = std::acos(double{e.axis.w});
            Random random(3);
            for (int i = 0; i < 201; ++i) {
                const double turn = random(0, 6.28),
                             slant = std::tan(std::min(outer * random(0, 1.15), 1.5));
                const glm::dvec3 aside = right * std::cos(turn) + up * std::sin(turn);
                const glm::dvec3 direction = glm::normalize(axis + slant * aside);
                test::ShadedPixel pixel;
                pixel.position = glm::dvec3(e.position) + random(0.2, 1.2) * direction;
                pixel.normal = pixel.geometric =
                    glm::normalize(glm::vec3(-direction) + 0.5f * test::random_direction(random));
                pixel.base = {0.3f, 0.8f, 0.5f};
                in.pixels.push_back(pixel);
            }
            const auto [compared, bright] = expect_truth(in, hard ? "hard" : "soft");
            EXPECT_GT(compared, 150);
            EXPECT_GT(bright, 90);
        }
}

// So thin that the cosines of its edge and its axis are neighbouring floats.
TEST(Combine, FillsTheThinnestHardCone) {
    Scene scene = test::oblique_room();
    scene.lights = {test::spot_light({0, 0.25, 0}, {0, -1, 0}, 0.0003)};
    const DeviceScene placed = test::on_device(scene);
    const EmitterSet set = make_emitters(placed, {.vpls = 1, .shadow_size = 8});
    Shading in = oblique_shading({spot}, COMBINE_DIRECT, 0);
    in.emitters = set.emitters;
    in.emitters[0].position = {0, 0.25f, 0, 0};  // its axis goes through the pixels exactly
    in.views = set.views;
    in.views[0].eye = in.emitters[0].position;
    in.visibility.assign(set.pixels, ~std::uint64_t{0});
    for (int i = 0; i < 3; ++i) {
        test::ShadedPixel pixel;
        pixel.position = {0, -0.25f * static_cast<float>(i), 0};
        pixel.normal = pixel.geometric = {0.6f, 0.8f, 0};
        pixel.base = {0.3f, 0.8f, 0.5f};
        in.pixels.push_back(pixel);
    }
    const auto radiance = test::combine(in).radiance;
    for (int i = 0; i < 3; ++i)
        for (int c = 0; c < 3; ++c) {
            const double wanted = double{in.pixels[i].base[c]} / std::numbers::pi * 0.8 *
                                  double{in.emitters[0].intensity[c]} / std::pow(0.25 * (i + 1), 2);
            EXPECT_NEAR(radiance[i][c], wanted, 1e-6 * wanted) << i;
        }
}

TEST(Combine, AddsAllSourcesAndTakesEachEffectAlone) {
    const std::vector<int> all = {spot, point, sun, wide_spot, lamp};
    for (cl_uint which = 0; which < 16; ++which) {
        Shading in = oblique_shading(all, which, 213);
        in.params.exposure = 3.7f;
        Random random(29);
        block(in, 3.0, random);
        expect_truth(in, "effects " + std::to_string(which));
    }
}

// Any code is a direction: those of all faces of the octahedron, and pixels without one between.
TEST(Combine, TakesNormalsAndFinishOfTextures) {
    for (const bool detail : {false, true}) {
        Shading in = oblique_shading({spot, point, sun, lamp},
                                     COMBINE_DIRECT | COMBINE_SPECULAR | COMBINE_INDIRECT |
                                         (detail ? COMBINE_MAPPED_NORMALS : 0));
        Random random(31);
        for (test::ShadedPixel& pixel : in.pixels) {
            if (random(0, 1) < 0.7)
                pixel.detail = static_cast<int>(
                    static_cast<std::uint32_t>(random.integer(0, DETAIL_STEPS)) |
                    static_cast<std::uint32_t>(random.integer(0, DETAIL_STEPS)) << 16);
            if (random(0, 1) < 0.7)
                pixel.finish =
                    random.integer(0, METALLIC_ROUGHNESS_STEPS) << METALLIC_ROUGHNESS_BITS |
                    random.integer(METALLIC_ROUGHNESS_STEPS / 4, METALLIC_ROUGHNESS_STEPS);
            else if (random(0, 1) < 0.3)
                pixel.finish = 0;  // a smooth dielectric
        }
        const auto [compared, bright] = expect_truth(in, detail ? "detail" : "finish");
        EXPECT_GT(compared, 500);
        EXPECT_GT(bright, 200);
    }
}

TEST(Combine, SeesNothingWhereNothingIs) {
    Shading in = oblique_shading({sun}, COMBINE_DIRECT | COMBINE_INDIRECT | COMBINE_EMISSION);
    for (test::ShadedPixel& pixel : in.pixels) pixel.normal = glm::vec3(0);
    for (const glm::vec3& radiance : test::combine(in).radiance) EXPECT_EQ(radiance, glm::vec3(0));
}

// A range reaches from full light to none; infinity, where it is 0.
TEST_P(CombineBorders, EndsAtTheRange) {
    for (const float range : {0.0f, 0.15f, 0.6f, 2.0f})
        for (const int source : {spot, point}) {
            Shading in = oblique_shading({source}, COMBINE_DIRECT);
            in.emitters[0].range = range;
            expect_truth(in, "range " + std::to_string(range));
        }
}

// A flat receiver that faces the sun has no slope and asks for no texels: what is left of the bias
// is float spacing.
TEST(Combine, DoesNotShadowAReceiverByItsOwnRounding) {
    Shading in = oblique_shading({sun}, COMBINE_DIRECT);
    in.params.texel_bias = 0.0f;
    for (test::ShadedPixel& pixel : in.pixels)
        pixel.normal = pixel.geometric = -glm::vec3(in.emitters[0].axis);
    Random random(37);
    block(in, 0.0, random);  // at the receiver itself
    EXPECT_GT(expect_truth(in, "own depth").first, 500);
}

// Places that lie on the border of two faces, whichever way they are rounded: one of the faces
// counts, the first that sees them.
TEST(Combine, HasNoGapBetweenFaces) {
    Shading in = oblique_shading({lamp}, COMBINE_DIRECT, 0);
    in.emitters.resize(1);
    const Emitter& e = in.emitters[0];
    const View& front = in.views[e.first_view];
    Random random(43);
    for (int i = 0; i < 3000; ++i) {
        glm::dvec2 at(random(-1, 1), i % 2 ? 1.0 : -1.0);
        if (i % 4 < 2) std::swap(at.x, at.y);
        const glm::dvec3 direction = glm::dvec3(front.forward) + at.x * glm::dvec3(front.right) +
                                     at.y * glm::dvec3(front.up);
        test::ShadedPixel pixel;
        pixel.position = glm::dvec3(e.position) + random(0.1, 0.9) * direction;
        pixel.normal = pixel.geometric = glm::normalize(glm::vec3(-direction));
        pixel.base = {0.3f, 0.8f, 0.5f};
        in.pixels.push_back(pixel);
    }
    const auto open = test::combine(in).radiance;
    const std::size_t front_end = std::size_t{front.width} * front.height;
    const auto fill = [&](bool front_blocked, bool sides_blocked) {
        for (std::size_t i = 0; i < in.visibility.size(); ++i)
            in.visibility[i] = (i < front_end ? front_blocked : sides_blocked)
                                   ? test::word_of(1e6f, 0)
                                   : ~std::uint64_t{0};
        return test::combine(in).radiance;
    };
    const auto none = fill(true, true), front_only = fill(true, false), sides = fill(false, true);
    for (std::size_t i = 0; i < in.pixels.size(); ++i) {
        EXPECT_GT(open[i].x, 0.0f);
        EXPECT_EQ(none[i], glm::vec3(0)) << i;
        // On the border either face may have a point, but one of them has it.
        const bool in_front = front_only[i] == glm::vec3(0);
        EXPECT_EQ(front_only[i], in_front ? glm::vec3(0) : open[i]) << i;
        EXPECT_EQ(sides[i], in_front ? open[i] : glm::vec3(0)) << i;
    }
}

TEST(Combine, NeverGivesLessThanNothing) {
    Shading in = oblique_shading({sun}, COMBINE_DIRECT | COMBINE_EMISSION | COMBINE_INDIRECT);
    for (test::ShadedPixel& pixel : in.pixels) pixel.emission = {-7.0f, 1.0f, -3.0f};
    for (const glm::vec3& radiance : test::combine(in).radiance)
        for (int c = 0; c < 3; ++c) EXPECT_GE(radiance[c], 0.0f);
}

// At the source itself the direction is lost: neither light nor an infinity.
TEST(Combine, StaysFiniteAtItsSources) {
    Shading in = oblique_shading({spot, point, lamp}, COMBINE_DIRECT | COMBINE_SPECULAR, 66);
    for (std::size_t i = 0; i < in.pixels.size(); ++i)
        in.pixels[i].position = in.emitters[i % in.emitters.size()].position;
    in.pixels[5].position = in.view.eye;
    const test::Combined found = test::combine(in);
    EXPECT_EQ(found.non_finite, 0u);
    for (const glm::vec3& radiance : found.radiance)
        for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isfinite(radiance[c]) && radiance[c] >= 0.0f);
}

TEST(Combine, IsTheSameForEveryPacket) {
    Shading in = oblique_shading({spot, point, sun, lamp}, 15);
    Random random(31);
    block(in, 2.0, random);
    const auto usual = test::combine(in).radiance;
    for (const int width : {1, 4}) {
        const ImagePasses passes(test::programs(), {.packet_width = width});
        EXPECT_TRUE(test::same_bits(test::combine(in, passes).radiance, usual)) << width;
    }
}

}  // namespace
}  // namespace clgi
