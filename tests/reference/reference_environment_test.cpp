// The path tracer under environments: furnaces, closed forms of single texels, gradients and suns.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/reference.hpp>
#include <limits>
#include <numbers>

#include "honest_errors.hpp"
#include "microfacet.hpp"
#include "scenes.hpp"
#include "skies.hpp"

namespace clgi {
namespace {

using reference::Irradiance;
using reference::parse_effects;
using reference::PathTracer;
using reference::Picture;
using reference::Place;
using reference::Sampling;

using std::numbers::pi;

reference::Options sky_options(const std::string& effects, int samples,
                               Sampling sampling = Sampling::both) {
    reference::Options options;
    options.effects = parse_effects(effects);
    options.samples = samples;
    options.sampling = sampling;
    options.width = options.height = 24;
    return options;
}

struct PlaceEstimate {
    double mean = 0.0, error = 0.0;  // and its standard error
};

PlaceEstimate estimate_of(const Irradiance& found) {
    double sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < found.values.size(); ++i) {
        sum += double{found.values[i].x};
        square += double{found.error[i]} * double{found.error[i]};
    }
    const auto count = static_cast<double>(found.values.size());
    return {sum / count, std::sqrt(square) / count};
}

// Many places at the origin with nothing near: a small triangle far below makes the scene.
Scene scene_under(const Environment& sky) {
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {0, -50, 0}, {0.1, -50, 0}, {0, -50, 0.1});
    scene.environment = sky;
    return scene;
}

PlaceEstimate lit(const Environment& sky, const glm::vec3& normal, int samples = 256,
                  Sampling sampling = Sampling::both) {
    const std::vector<Place> places(200, {{0, 0, 0}, glm::normalize(normal)});
    return estimate_of(
        PathTracer(scene_under(sky)).irradiance(places, sky_options("direct", samples, sampling)));
}

// 4.5 standard errors: one false alarm in 150,000.
void expect_lit(const PlaceEstimate& found, double wanted, double slack, const std::string& what) {
    EXPECT_NEAR(found.mean, wanted, 4.5 * found.error + slack * wanted) << what;
    EXPECT_LT(found.error, 0.01 * wanted) << what << ": too noisy to say anything";
}

// A sphere of flat facets.
void add_sphere(Scene& scene, double radius, std::uint32_t material) {
    constexpr int rings = 12, columns = 24;
    const auto at = [&](int ring, int column) {
        const double down = pi * ring / rings, round = 2 * pi * column / columns;
        return radius * glm::dvec3(std::sin(down) * std::cos(round), std::cos(down),
                                   -std::sin(down) * std::sin(round));
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int c = 0; c < columns; ++c) {
            if (ring > 0)
                test::add_triangle(scene, at(ring, c), at(ring + 1, c), at(ring, c + 1), material);
            if (ring < rings - 1)
                test::add_triangle(scene, at(ring + 1, c), at(ring + 1, c + 1), at(ring, c + 1),
                                   material);
        }
}

TEST(ReferenceEnvironment, LightsAConvexBodyByItsAlbedoExactly) {
    for (const float albedo : {0.0f, 0.3f, 1.0f}) {
        Scene scene = test::plain_scene(glm::vec3(albedo));
        add_sphere(scene, 1.0, 0);
        scene.environment = test::even_sky({2.0f, 3.0f, 5.0f});
        const Picture picture =
            PathTracer(scene).render(test::camera_at({1, 2, 3}, {0, 0, 0}), sky_options("all", 4));
        std::size_t sky = 0;
        for (const glm::vec3& radiance : picture.radiance) {
            const bool background = std::abs(radiance.x - 2.0f) < 1e-6f;
            sky += background;
            const float share = background ? 1.0f : albedo;
            EXPECT_NEAR(radiance.x, 2.0f * share, 1e-5f);
            EXPECT_NEAR(radiance.z, 5.0f * share, 2e-5f);
        }
        if (albedo < 1.0f) {
            EXPECT_GT(sky, 100u);
            EXPECT_LT(sky, 476u);
        }
    }
}

// What reflects everything is invisible, however often light goes to and fro.
TEST(ReferenceEnvironment, LosesSightOfAWhiteBodyWithHollows) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    scene.materials[0].double_sided = true;
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    scene.triangles.resize(scene.triangles.size() - 2);  // open towards +z
    test::add_box(scene, {-0.4, -1, -0.4}, {0.3, 0.1, 0.3}, 1);
    scene.environment = test::even_sky(glm::vec3(3.0f));
    const Picture picture =
        PathTracer(scene).render(test::camera_at({0.3, 0.4, 4}, {0, 0, 0}), sky_options("all", 64));
    for (std::size_t p = 0; p < picture.radiance.size(); ++p)
        EXPECT_NEAR(picture.radiance[p].x, 3.0, 5.0 * picture.error[p] + 2e-4) << p;
}

// Albedo of a white metal: D V cosine over directions of the half vector, by quadrature of tan.
double microfacet_albedo(double roughness, double slant) {
    const double alpha = roughness * roughness;
    const glm::dvec3 viewer(std::sin(slant), 0.0, std::cos(slant));
    double sum = 0.0;
    constexpr int steps = 1200, turns = 240;
    const Material metal = test::finished(1.0f, static_cast<float>(roughness));
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < turns; ++j) {
            // Half vectors by D's own measure: tan^2 = alpha^2 u / (1 - u).
            const double share = (i + 0.5) / steps;
            const double tangent = alpha * std::sqrt(share / (1 - share));
            const double cosine = 1 / std::sqrt(1 + tangent * tangent), sine = tangent * cosine;
            const double round = 2 * pi * (j + 0.5) / turns;
            const glm::dvec3 half(sine * std::cos(round), sine * std::sin(round), cosine);
            const double vh = glm::dot(viewer, half);
            const glm::dvec3 light = 2 * vh * half - viewer;
            if (vh <= 0 || light.z <= 0) continue;
            const double d =
                alpha * alpha / (pi * std::pow(cosine * cosine * (alpha * alpha - 1) + 1, 2));
            sum += test::gltf_reflected(metal, glm::dvec3(1), {0, 0, 1}, viewer, light).gloss.x *
                   light.z * 4 * vh / (d * cosine) / (steps * turns);
        }
    return sum;
}

TEST(ReferenceEnvironment, ReflectsAnEvenSkyByTheAlbedoOfTheLobe) {
    for (const float roughness : {0.3f, 0.6f})
        for (const double slant : {0.0, 0.6, 1.2}) {
            const double wanted = microfacet_albedo(double{roughness}, slant);
            for (const bool picture_of_one_texel : {false, true}) {
                Scene scene = test::plain_scene();
                test::add_floor(scene, 1.0, 0.0,
                                test::add_material(scene, {.base_color = glm::vec4(1),
                                                           .metallic = 1.0f,
                                                           .roughness = roughness}));
                scene.environment = picture_of_one_texel
                                        ? test::picture_sky(2, 1, [](int, int) { return 1.0f; })
                                        : test::even_sky(glm::vec3(1.0f));
                reference::Options options = sky_options("direct", 1024);
                options.width = options.height = 8;
                const Picture picture = PathTracer(scene).render(
                    test::camera_at({8 * std::sin(slant), 8 * std::cos(slant), 1e-3}, {0, 0, 0},
                                    1e-3f),
                    options);
                double mean = 0.0, square = 0.0;
                for (std::size_t p = 0; p < 64; ++p) {
                    mean += double{picture.radiance[p].x} / 64;
                    square += double{picture.error[p]} * double{picture.error[p]};
                }
                EXPECT_NEAR(mean, wanted, 4.5 * std::sqrt(square) / 64 + 2e-4)
                    << "roughness " << roughness << ", slant " << slant;
                EXPECT_LT(std::sqrt(square) / 64, 0.01);
            }
        }
}

TEST(ReferenceEnvironment, KnowsTheIrradianceOfABlockOfTexels) {
    const Environment sky = test::picture_sky(16, 8, [](int row, int column) {
        return row >= 2 && row < 4 && column >= 9 && column < 11 ? 4.0f : 0.0f;
    });
    const test::SkyBlock block = test::block_of(sky, 2, 2, 9, 2);
    for (const double rotation : {0.0, 0.5 * pi, -2.0, 100.0}) {
        Environment turned = sky;
        turned.rotation = static_cast<float>(rotation);
        const glm::dvec3 vector = test::vector_of(block, rotation);
        const std::string what = "rotation " + std::to_string(rotation);
        expect_lit(lit(turned, {0, 1, 0}), 4 * vector.y, 2e-6, what + ", up");
        const glm::vec3 level(glm::normalize(glm::dvec3(vector.x, 0, vector.z)));
        expect_lit(lit(turned, level), 4 * glm::dot(vector, glm::dvec3(level)), 2e-6,
                   what + ", towards it");
        EXPECT_EQ(lit(turned, -level).mean, 0.0) << what;
    }
    // A quarter turn takes what is ahead, at -z, to the left.
    Environment ahead = test::picture_sky(
        16, 8, [](int row, int column) { return row == 4 && (column == 7 || column == 8); });
    EXPECT_GT(lit(ahead, {0, 0, -1}).mean, 5 * lit(ahead, {-1, 0, 0}).mean);
    ahead.rotation = static_cast<float>(0.5 * pi);
    EXPECT_GT(lit(ahead, {-1, 0, 0}).mean, 5 * lit(ahead, {0, 0, -1}).mean);
}

TEST(ReferenceEnvironment, KnowsTheIrradianceOfAGradient) {
    const Environment sky = test::gradient_sky();
    for (const glm::vec3& normal :
         {glm::vec3(0, 1, 0), {1, 1, 0}, {0, 0, -1}, {1, -1, 1}, {0, -1, 0}}) {
        const double wanted = pi / 2 + pi / 3 * double{glm::normalize(normal).y};
        for (const Sampling sampling : {Sampling::both, Sampling::lights, Sampling::lobes})
            expect_lit(
                lit(sky, normal, 512, sampling), wanted, 2e-5,
                std::to_string(normal.y) + ", way " + std::to_string(static_cast<int>(sampling)));
    }
    // An even sky, drawn for its own sake, is drawn evenly.
    expect_lit(lit(test::even_sky(glm::vec3(2)), {1, 1, 0}, 1024, Sampling::lights), 2 * pi, 1e-6,
               "even");
    EXPECT_NEAR(lit(test::even_sky(glm::vec3(2)), {1, 1, 0}, 1).mean, 2 * pi, 1e-5);
}

// Bounces under a sky, and no sky in a closed room.
TEST(ReferenceEnvironment, IsReflectedAtEveryOrder) {
    Scene scene = test::plain_scene(glm::vec3(0.5f));
    test::add_floor(scene, 2000.0);
    scene.environment = test::even_sky(glm::vec3(2.0f));
    const PathTracer tracer(scene);
    const std::vector<Place> places(200, {{0, 1, 0}, {0, -1, 0}});
    const auto found = [&](const std::string& effects) {
        return estimate_of(tracer.irradiance(places, sky_options(effects, 256)));
    };
    // 1e-5: what a floor of 4 km does not fill of the view.
    expect_lit(found("one-bounce"), pi, 1e-5, "one bounce");
    expect_lit(found("unshadowed-indirect"), pi, 1e-5, "unshadowed");
    expect_lit(found("all"), pi, 1e-5, "all");
    EXPECT_LT(found("direct").mean, 1e-3);
    EXPECT_LT(found("bounces=2").mean, 1e-3);

    Scene room = test::plain_scene(glm::vec3(0.5f));
    room.materials[0].double_sided = true;
    test::add_box(room, {-1, -1, -1}, {1, 1, 1}, -1);
    room.environment = test::gradient_sky();
    const auto dark = PathTracer(room).irradiance(
        std::vector<Place>(50, {{0.1, 0.2, 0.3}, {0, 1, 0}}), sky_options("all", 64));
    EXPECT_EQ(estimate_of(dark).mean, 0.0);
}

TEST(ReferenceEnvironment, IsSeenWhereEmissionIs) {
    const Scene scene = scene_under(test::picture_sky(
        4, 2, [](int row, int column) { return static_cast<float>(1 + 4 * row + column); }));
    const auto seen = [&](const glm::dvec3& toward, const char* effects) {
        reference::Options options = sky_options(effects, 1);
        options.width = options.height = 1;
        return PathTracer(scene).render(test::camera_at({0, 0, 0}, toward), options).radiance[0].x;
    };
    EXPECT_EQ(seen({-1, 1, 1}, "emission"), 1.0f);
    EXPECT_EQ(seen({-1, 1, -1}, "emission"), 2.0f);
    EXPECT_EQ(seen({1, 1, -1}, "all"), 3.0f);
    EXPECT_EQ(seen({1, 1, 1}, "all"), 4.0f);
    EXPECT_EQ(seen({1, -1, -1}, "all"), 7.0f);
    EXPECT_EQ(seen({1, 1, -1}, "direct,indirect"), 0.0f);
}

// A sun of one texel, 100,000 times as bright as the sky around it.
TEST(ReferenceEnvironment, FindsASmallSun) {
    const Environment sky = test::picture_sky(
        128, 64, [](int row, int column) { return row == 20 && column == 70 ? 1e5f : 1.0f; });
    const glm::dvec3 vector = test::vector_of(test::block_of(sky, 20, 1, 70, 1));
    const double wanted = pi + (1e5 - 1) * vector.y;
    const PlaceEstimate both = lit(sky, {0, 1, 0}, 256);
    expect_lit(both, wanted, 2e-5, "both");
    expect_lit(lit(sky, {0, 1, 0}, 256, Sampling::lights), wanted, 2e-5, "lights");
    // Lobes alone need thousands of times the samples for the same error.
    const PlaceEstimate lobes = lit(sky, {0, 1, 0}, 256, Sampling::lobes);
    EXPECT_NEAR(lobes.mean, wanted, 4.5 * lobes.error + 2e-5 * wanted);
    EXPECT_GT(lobes.error, 40 * both.error);
}

TEST(ReferenceEnvironment, ErrsByTheRootOfItsSamplesAndSaysSo) {
    const Environment sky = test::gradient_sky(4, 8);
    double wanted = 0.0;  // looking up: the upper rows, exactly
    for (int row = 0; row < 4; ++row)
        wanted += double{sky.texels[static_cast<std::size_t>(4 * row)].x} *
                  test::vector_of(test::block_of(sky, row, 1, 0, 4)).y;
    const PathTracer tracer(scene_under(sky));
    test::expect_honest_errors(tracer, {{0, 0, 0}, {0, 1, 0}}, wanted);
}

TEST(ReferenceEnvironment, OfNoLightIsNone) {
    for (const Environment& sky :
         {test::even_sky(glm::vec3(0)), test::picture_sky(4, 2, [](int, int) { return 0.0f; })})
        EXPECT_EQ(lit(sky, {0, 1, 0}, 4).mean, 0.0);
}

TEST(ReferenceEnvironment, IsCheckedBeforeItIsUsed) {
    const auto refused = [](auto change) {
        Environment sky = test::gradient_sky(4, 2);
        change(sky);
        EXPECT_THROW(validate(scene_under(sky)), InputError);
    };
    EXPECT_NO_THROW(validate(scene_under(test::gradient_sky(4, 2))));
    constexpr float infinite = std::numeric_limits<float>::infinity();
    refused([](Environment& sky) { sky.texels[3].y = -1.0f; });
    refused([](Environment& sky) { sky.texels[3].y = infinite; });
    refused([](Environment& sky) { sky.texels[3].y = sky.factor.y = 1e30f; });
    // Each texel is a number, what they send together is not.
    refused([](Environment& sky) { sky.factor.y = 1e38f; });
    refused([](Environment& sky) { sky.factor.z = -1.0f; });
    refused([](Environment& sky) { sky.factor.z = infinite; });
    refused([](Environment& sky) { sky.rotation = std::nanf(""); });
    refused([](Environment& sky) { sky.texels.pop_back(); });
    refused([](Environment& sky) { sky.width = 0; });
    refused([](Environment& sky) { sky.width = -4, sky.height = -2; });
}

}  // namespace
}  // namespace clgi
