// The path tracer against closed forms: light of every kind, bounces, effects, its own error.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/error.hpp>
#include <clgi/procedural.hpp>
#include <clgi/reference.hpp>
#include <cmath>
#include <numbers>

#include "honest_errors.hpp"
#include "scenes.hpp"

namespace clgi {
namespace {

using reference::Irradiance;
using reference::parse_effects;
using reference::PathTracer;
using reference::Picture;
using reference::Place;
using std::numbers::pi;

constexpr double degree = pi / 180.0;

reference::Options options_for(const std::string& effects, int samples) {
    reference::Options options;
    options.effects = parse_effects(effects);
    options.samples = samples;
    return options;
}

// Mean over places and its standard error.
std::pair<double, double> mean_of(const Irradiance& found) {
    double sum = 0.0, square = 0.0;
    for (std::size_t i = 0; i < found.values.size(); ++i) {
        sum += double{found.values[i].x};
        square += double{found.error[i]} * double{found.error[i]};
    }
    const auto count = static_cast<double>(found.values.size());
    return {sum / count, std::sqrt(square) / count};
}

// 4.5 standard errors: one false alarm in 150,000.
void expect_mean(const Irradiance& found, double wanted, double slack, const std::string& what) {
    const auto [mean, error] = mean_of(found);
    EXPECT_NEAR(mean, wanted, 4.5 * error + slack * wanted) << what;
    EXPECT_LT(error, 0.01 * wanted) << what << ": too noisy to say anything";
}

std::uint32_t add_glowing(Scene& scene, float radiance, float albedo = 0.0f) {
    Material material;
    material.base_color = glm::vec4(glm::vec3(albedo), 1.0f);
    material.emission = glm::vec3(radiance);
    return test::add_material(scene, material);
}

// A disc about (0, y, 0) that faces down.
void add_disc(Scene& scene, double radius, double y, std::uint32_t material) {
    constexpr int corners = 512;
    // The polygon with the disc's area.
    const double reach = radius * std::sqrt(2 * pi / corners / std::sin(2 * pi / corners));
    const auto corner = [&](int k) {
        const double turn = 2 * pi * k / corners;
        return glm::dvec3(reach * std::cos(turn), y, reach * std::sin(turn));
    };
    for (int k = 0; k < corners; ++k)
        test::add_triangle(scene, {0, y, 0}, corner(k), corner(k + 1), material);
}

TEST(Reference, KnowsViewFactorsOfEmissiveSurfaces) {
    const double light = 2.0;
    const auto lit = [&](const std::array<glm::dvec3, 4>& corners) {
        Scene scene = test::plain_scene();
        test::add_quad(scene, corners, add_glowing(scene, static_cast<float>(light)));
        const std::vector<Place> places(200, {{0, 0, 0}, {0, 0, 1}});
        return PathTracer(scene).irradiance(places, options_for("direct", 256));
    };
    // Parallel at height 1, a corner on the normal: sides a and b.
    for (const auto& [a, b, wanted] : std::initializer_list<std::array<double, 3>>{
             {1, 1, 0.1385316060}, {2, 1, 0.1673750099}, {0.5, 0.5, 0.0598641176}})
        expect_mean(lit({glm::dvec3(0, 0, 1), {0, b, 1}, {a, b, 1}, {a, 0, 1}}),
                    pi * light * wanted, 1e-6, "parallel");
    // Perpendicular: a along the edge, b up from the horizon, c away.
    for (const auto& [a, b, c, wanted] : std::initializer_list<std::array<double, 4>>{
             {1, 1, 1, 0.0557341970}, {2, 1, 1, 0.0686972989}, {1, 2, 0.5, 0.1587748045}})
        expect_mean(lit({glm::dvec3(c, 0, 0), {c, 0, b}, {c, a, b}, {c, a, 0}}),
                    pi * light * wanted, 1e-6, "perpendicular");
}

TEST(Reference, KnowsViewFactorsBesideTheNormal) {
    for (const auto& [aside, wanted] : std::initializer_list<std::array<double, 2>>{
             {0, 0.5}, {0.5, 0.4379826327}, {1, 0.2763932023}, {2, 0.0527864045}}) {
        Scene scene = test::plain_scene();
        add_disc(scene, 1.0, 1.0, add_glowing(scene, 1.0f));
        const std::vector<Place> at(200, {{aside, 0, 0}, {0, 1, 0}});
        const Irradiance found = PathTracer(scene).irradiance(at, options_for("direct", 256));
        expect_mean(found, pi * wanted, 1e-4, "disc, aside by " + std::to_string(aside));
    }
    Scene scene = test::plain_scene();
    test::add_triangle(scene, {1, 0, 1}, {-1, -1, 1}, {0, 1, 1}, add_glowing(scene, 1.0f));
    const std::vector<Place> places(200, {{0, 0, 0}, {0, 0, 1}});
    const Irradiance found = PathTracer(scene).irradiance(places, options_for("direct", 256));
    expect_mean(found, pi * 0.3003491901, 1e-5, "triangle");
}

// A glowing face of a closed cube: what is reflected in all is what is sent out times rho/(1 -
// rho).
TEST(Reference, LosesNoEnergyInACube) {
    Scene scene = test::plain_scene();
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, -1);
    const std::uint32_t glowing = add_glowing(scene, static_cast<float>(1 / pi), 0.5f);
    for (SceneTriangle& triangle : scene.triangles)
        if (scene.normals[triangle.vertex[0]].z > 0.5f) triangle.material = glowing;  // z = 0
    std::vector<Place> all, opposite, beside;
    for (int i = 0; i < 32; ++i)
        for (int j = 0; j < 32; ++j) {
            const double u = (i + 0.5) / 32, v = (j + 0.5) / 32;
            opposite.push_back({{u, v, 1}, {0, 0, -1}});
            beside.push_back({{0, u, v}, {1, 0, 0}});
            all.insert(all.end(), {opposite.back(),
                                   beside.back(),
                                   {{u, v, 0}, {0, 0, 1}},
                                   {{1, u, v}, {-1, 0, 0}},
                                   {{u, 0, v}, {0, 1, 0}},
                                   {{u, 1, v}, {0, -1, 0}}});
        }
    const PathTracer tracer(scene);
    // Slack: midpoints of 32 x 32 for the mean of a face; light at edges is not smooth.
    expect_mean(tracer.irradiance(all, options_for("all", 100)), 2.0 / 6, 2e-3, "all faces");
    expect_mean(tracer.irradiance(opposite, options_for("direct", 200)), 0.1998248957, 2e-4,
                "opposite, direct");
    expect_mean(tracer.irradiance(beside, options_for("direct", 200)), 0.2000437761, 2e-3,
                "adjacent, direct");
}

TEST(Reference, LightsASphereBySpotAndPoint) {
    for (const LightSource lamp : {LightSource::spot, LightSource::point}) {
        FurnaceOptions furnace_options;
        furnace_options.light = lamp;
        furnace_options.subdivisions = 6;
        const PathTracer tracer(furnace(furnace_options));
        const double flux = 2 * pi * (lamp == LightSource::spot ? 1 - std::cos(30 * degree) : 2.0);
        std::vector<Place> places;
        for (int i = 0; i < 400; ++i) {
            const double y = 1 - (2 * i + 1) / 400.0, turn = i * 2.4;
            const glm::dvec3 out(std::sqrt(1 - y * y) * std::cos(turn), y,
                                 std::sqrt(1 - y * y) * std::sin(turn));
            places.push_back({0.999 * out, glm::vec3(-out)});
        }
        // 2e-3: places a thousandth inside, and facets.
        expect_mean(tracer.irradiance(places, options_for("one-bounce", 512)),
                    0.5 * flux / (4 * pi), 2e-3, "one bounce");
        expect_mean(tracer.irradiance(places, options_for("indirect", 512)), flux / (4 * pi), 2e-3,
                    "all bounces");
    }
}

TEST(Reference, LightsAFloorByASpotAboveIt) {
    for (const auto& [angle, wanted] : {std::pair(15.0, 0.0318298598),
                                        {30.0, 0.1025721421},
                                        {45.0, 0.1646446609},
                                        {60.0, 0.1937500000}}) {
        Scene scene = test::plain_scene();
        test::add_floor(scene, 4.0);
        scene.lights = {test::spot_light({0, 1, 0}, {0, -1, 0}, angle * degree)};
        const std::vector<Place> places(400, {{0, 1, 0}, {0, -1, 0}});
        expect_mean(PathTracer(scene).irradiance(places, options_for("one-bounce", 400)), wanted,
                    1e-6, std::to_string(angle));
    }
}

TEST(Reference, KnowsLampsToTheLastDigit) {
    const auto lux = [](const Light& light, const glm::dvec3& position, const glm::vec3& normal) {
        Scene scene = test::plain_scene();
        test::add_floor(scene, 1.0, -5.0);
        scene.lights = {light};
        return double{PathTracer(scene)
                          .irradiance({{position, normal}}, options_for("direct", 1))
                          .values[0]
                          .x};
    };
    EXPECT_NEAR(lux(test::point_light({0, 2, 0}, 8.0f), {0, 0, 0}, {0, 1, 0}), 2.0, 1e-5);
    EXPECT_NEAR(lux(test::point_light({3, 4, 0}, 8.0f), {0, 0, 0}, {0, 1, 0}), 8.0 / 25 * 0.8,
                1e-6);
    EXPECT_NEAR(lux(test::directional_light({0, -3, 4}, 5.0f), {0, 0, 0}, {0, 1, 0}), 3.0, 1e-5);
    EXPECT_EQ(lux(test::point_light({0, -2, 0}, 8.0f), {0, 0, 0}, {0, 1, 0}), 0.0);
    Light light = test::point_light({0, 2, 0}, 8.0f);
    light.range = 4.0f;
    EXPECT_NEAR(lux(light, {0, 0, 0}, {0, 1, 0}), 2.0 * (1 - std::pow(0.5, 4)), 1e-5);
    light.range = 2.0f;
    EXPECT_EQ(lux(light, {0, 0, 0}, {0, 1, 0}), 0.0);
    Light spot = test::spot_light({0, 1, 0}, {0, -1, 0}, 60 * degree);
    spot.inner_angle = 0.0f;
    // Half way between the cosines of 0 and 60 degrees, squared.
    const double cosine = 0.75;
    const double x = std::sqrt(1 - cosine * cosine) / cosine;
    EXPECT_NEAR(lux(spot, {x, 0, 0}, {0, 1, 0}), 0.25 * std::pow(cosine, 3), 1e-6);
    EXPECT_EQ(lux(spot, {2, 0, 0}, {0, 1, 0}), 0.0);
}

// STABILITY 1.1: a disc of radius 1 at height 1 behind a disc of radius b at half the height.
TEST(Reference, LeavesOutBlockersOfUnshadowedLight) {
    for (const auto& [blocker, wanted] :
         {std::pair(0.1, 0.4615384615), {0.25, 0.3}, {0.4, 0.1097560976}}) {
        Scene scene = test::plain_scene();
        const std::uint32_t white = test::add_material(scene, {.base_color = glm::vec4(1)});
        const std::uint32_t black =
            test::add_material(scene, {.base_color = glm::vec4(0, 0, 0, 1), .double_sided = true});
        add_disc(scene, 1.0, 1.0, white);
        add_disc(scene, blocker, 0.5, black);
        // So slanted that the shadow of the small disc misses the large one.
        scene.lights = {test::directional_light({std::sin(75 * degree), std::cos(75 * degree), 0})};
        const std::vector<Place> places(200, {{0, 0, 0}, {0, 1, 0}});
        const PathTracer tracer(scene);
        const double lit = std::cos(75 * degree);
        expect_mean(tracer.irradiance(places, options_for("one-bounce", 800)), lit * wanted, 1e-4,
                    "shadowed");
        expect_mean(tracer.irradiance(places, options_for("unshadowed-indirect", 400)), lit * 0.5,
                    1e-4, "unshadowed");
    }
}

TEST(Reference, ReflectsAUniformSkyInItsLobe) {
    // What GGX reflects at normal incidence, from a quadrature.
    const double albedos[][2] = {{0.05, 0.9999}, {0.3, 0.9905}, {0.7, 0.6974}};
    for (const auto& [roughness, albedo] : albedos) {
        Scene scene = test::plain_scene();
        test::add_box(scene, {-9, -9, -9}, {9, 9, 9}, -1, add_glowing(scene, 2.0f));
        const Material metal = test::finished(1.0f, static_cast<float>(roughness));
        test::add_floor(scene, 1.0, 0.0, test::add_material(scene, metal));
        reference::Options options = options_for("direct", 400);
        options.width = options.height = 8;
        const Picture picture =
            PathTracer(scene).render(test::camera_at({0, 8, 1e-3}, {0, 0, 0}, 1e-3f), options);
        double mean = 0.0, square = 0.0;
        for (std::size_t p = 0; p < 64; ++p) {
            mean += double{picture.radiance[p].x} / 64;
            square += double{picture.error[p]} * double{picture.error[p]};
        }
        EXPECT_NEAR(mean, 2.0 * albedo, 4.5 * std::sqrt(square) / 64 + 3e-4) << roughness;
        EXPECT_LT(std::sqrt(square) / 64, 0.02);
    }
}

TEST(Reference, ErrsByTheRootOfItsSamplesAndSaysSo) {
    Scene scene = test::plain_scene();
    test::add_quad(scene, {glm::dvec3(0, 0, 1), {0, 1, 1}, {1, 1, 1}, {1, 0, 1}},
                   add_glowing(scene, 1.0f));
    const double wanted = pi * 0.1385316060;
    const PathTracer tracer(scene);
    test::expect_honest_errors(tracer, {{0, 0, 0}, {0, 0, 1}}, wanted);
}

TEST(Reference, IsTheSamePictureOnAnyNumberOfThreads) {
    const Scene scene = cornell();
    const PathTracer tracer(scene);
    reference::Options options = options_for("all", 10);
    options.width = 31;
    options.height = 23;
    options.threads = 1;
    const Picture one = tracer.render(scene.cameras[0], options);
    options.threads = 2;
    const Picture two = tracer.render(scene.cameras[0], options);
    EXPECT_TRUE(one.radiance == two.radiance);
    EXPECT_TRUE(one.error == two.error);
    options.seed = 2;
    EXPECT_FALSE(tracer.render(scene.cameras[0], options).radiance == one.radiance);
}

TEST(Reference, StopsAtItsTargetOrWhenToldTo) {
    const Scene scene = cornell();
    const PathTracer tracer(scene);
    reference::Options options = options_for("all", 4096);
    options.width = options.height = 24;
    options.target = 0.1;
    const Picture picture = tracer.render(scene.cameras[0], options);
    EXPECT_LE(picture.relative_error, 0.1);
    EXPECT_LT(picture.samples, 4096);
    EXPECT_FALSE(picture.cancelled);
    const Picture cancelled =
        tracer.render(scene.cameras[0], options, [](double done) { return done < 0.001; });
    EXPECT_TRUE(cancelled.cancelled);
    EXPECT_LT(cancelled.samples, 16);
}

TEST(Reference, SeesWhatACameraSees) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    scene.materials[0].double_sided = false;
    scene.materials[0].emission = glm::vec3(1.0f);
    test::add_floor(scene, 1.0);
    reference::Options options = options_for("emission", 1);
    options.width = options.height = 4;
    const Camera above = test::camera_at({0.1, 3, 0.2}, {0, 0, 0}, 0.2f);
    const Camera below = test::camera_at({0.1, -3, 0.2}, {0, 0, 0}, 0.2f);
    EXPECT_EQ(PathTracer(scene).render(above, options).radiance[5].x, 1.0f);
    EXPECT_EQ(PathTracer(scene).render(below, options).radiance[5].x, 0.0f);
    scene.materials[0].double_sided = true;
    EXPECT_EQ(PathTracer(scene).render(below, options).radiance[5].x, 1.0f);
    scene.materials[0].alpha_mode = AlphaMode::mask;
    scene.materials[0].base_color.w = 0.4f;
    EXPECT_EQ(PathTracer(scene).render(above, options).radiance[5].x, 0.0f);
    scene.materials[0].alpha_cutoff = 0.3f;
    EXPECT_EQ(PathTracer(scene).render(above, options).radiance[5].x, 1.0f);
}

TEST(Reference, ShinesNotOutOfHoles) {
    Scene scene = test::plain_scene();
    const std::uint32_t glowing = add_glowing(scene, 1.0f);
    test::add_quad(scene, {glm::dvec3(0, 0, 1), {0, 1, 1}, {1, 1, 1}, {1, 0, 1}}, glowing);
    scene.materials[glowing].alpha_mode = AlphaMode::mask;
    scene.materials[glowing].base_color.w = 0.1f;
    const auto found =
        PathTracer(scene).irradiance({{{0, 0, 0}, {0, 0, 1}}}, options_for("direct", 64));
    EXPECT_EQ(found.values[0].x, 0.0f);
}

// Colours of corners end with the triangle, however far beside it a pixel reaches on its plane.
TEST(Reference, KeepsVertexColoursBetweenThoseOfTheCorners) {
    Scene scene = test::plain_scene(glm::vec3(1.0f));
    test::add_floor(scene, 1e4);
    scene.colors = {{1, 0, 0, 1}, {0, 1, 0, 1}, {0.2, 0.3, 1, 1}, {0, 0, 0, 1}};
    scene.lights = {test::directional_light({0, -1, 0}, static_cast<float>(pi))};
    reference::Options options = options_for("direct", 8);
    options.width = 40;
    options.height = 30;
    const Picture picture =
        PathTracer(scene).render(test::camera_at({0, 1, 0}, {0.3, 1, 1}, 0.5f), options);
    float most = 0.0f;
    for (const glm::vec3& radiance : picture.radiance)
        for (int c = 0; c < 3; ++c) {
            EXPECT_GE(radiance[c], 0.0f);
            EXPECT_LE(radiance[c], 1.0f + 1e-5f);
            most = std::max(most, radiance[c]);
        }
    EXPECT_GT(most, 0.1f);
    EXPECT_EQ(picture.non_finite, 0u);
}

TEST(Reference, ShadowsByBacksButNotThroughHoles) {
    for (const bool hole : {false, true}) {
        Scene scene = test::plain_scene();
        scene.materials[0].double_sided = false;  // seen from below: its back
        test::add_floor(scene, 1.0, 1.0);
        if (hole) {
            scene.materials[0].alpha_mode = AlphaMode::mask;
            scene.materials[0].base_color.w = 0.1f;
        }
        scene.lights = {test::point_light({0, 2, 0}, 4.0f)};
        const auto found =
            PathTracer(scene).irradiance({{{0, 0, 0}, {0, 1, 0}}}, options_for("direct", 1));
        EXPECT_NEAR(found.values[0].x, hole ? 1.0 : 0.0, 1e-6);
    }
}

TEST(Reference, RefusesWhatItDoesNotKnow) {
    for (const char* list : {"indirekt", "direct,", "all,direct", "bounces=0", "bounces=",
                             "bounces=2x", "indirect,one-bounce", "one-bounce,unshadowed-indirect"})
        EXPECT_THROW(parse_effects(list), Error) << list;
    // What is left out alone leaves the rest in.
    EXPECT_TRUE(parse_effects("diffuse").direct);
    EXPECT_FALSE(parse_effects("diffuse").direct_gloss);
    EXPECT_EQ(parse_effects("diffuse-indirect").last_bounce, reference::Effects::unlimited);
    const PathTracer tracer(cornell());
    for (auto change : std::vector<void (*)(reference::Options&)>{
             [](auto& o) { o.width = 0; }, [](auto& o) { o.samples = 0; },
             [](auto& o) { o.target = -1.0; }, [](auto& o) { o.threads = -1; },
             [](auto& o) { o.effects.shadowed = false; }}) {
        reference::Options options;
        change(options);
        EXPECT_THROW(tracer.render(cornell().cameras[0], options), Error);
    }
    EXPECT_NO_THROW(PathTracer(Scene()).irradiance({{{0, 0, 0}, {0, 1, 0}}}, {}));
}
}  // namespace
}  // namespace clgi
