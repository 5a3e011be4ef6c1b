// Shares of the VPLs: nothing is lost where there are fewer VPLs than emitters; and who goes along
// one sequence of points.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <numbers>
#include <tuple>

#include "lighting.hpp"
#include "math_modes.hpp"
#include "scene/luminance.hpp"
#include "scenes.hpp"
#include "skies.hpp"
#include "sources.hpp"

namespace clgi {
namespace {

using std::numbers::pi;

CLGI_IN_BOTH_MATHS(Shares);

double power_of(const Emitter& emitter) {
    const double intensity = luminance(glm::vec3(emitter.intensity));
    // The samples' own flux; the others' measure is of what they light.
    return emitter.kind == EMITTER_AREA ? intensity : intensity * double{emitter.measure};
}

TEST(Emitters, SendAllLightHoweverFewLightsThereAre) {
    const DeviceScene scene = test::on_device(scene_of_all());
    for (const int count : {1, 2, 5, 20, 100, 20000}) {
        const EmitterSet set = make_emitters(scene, {.vpls = count});
        ASSERT_EQ(set.emitters.size(), 35u);
        double all = 0.0, sent = 0.0;
        std::size_t without = 0;
        for (const Emitter& emitter : set.emitters) {
            all += power_of(emitter);
            if (emitter.vpl_count > 0) sent += power_of(emitter) * double{emitter.taken_over};
            without += emitter.vpl_count == 0;
        }
        EXPECT_NEAR(sent, all, 1e-6 * all) << count;
        EXPECT_EQ(set.vpl_count, static_cast<std::size_t>(count));
        if (count < 35) {
            EXPECT_GT(without, 0u) << count;
        }
        if (without > 0) continue;
        for (const Emitter& emitter : set.emitters) EXPECT_EQ(emitter.taken_over, 1.0f);
    }
    for (const Emitter& emitter : make_emitters(scene, {.vpls = 0}).emitters)
        EXPECT_EQ(emitter.taken_over, 1.0f);  // nobody is there to take over
}

// A closed box reflects half of what two lamps send, by one light or by three.
TEST_P(Shares, OfSourcesWithoutLightsAreSentByTheOthers) {
    Scene world = test::plain_scene(glm::vec3(0.5f));
    test::add_box(world, {-1, -1, -1}, {1, 1, 1}, -1);
    world.lights = {test::point_light({0.1, 0, 0}, 10.0f), test::point_light({0, 0.2, 0}, 1.0f)};
    const DeviceScene scene = test::on_device(world);
    for (const int count : {1, 3, 200})
        EXPECT_NEAR(
            test::total_flux(scene, test::place_lights(scene, {.vpls = count}, GetParam()).lights),
            0.5 * 4 * pi * 11, 1e-5 * 0.5 * 4 * pi * 11)
            << count;
}

// In a closed room a lamp, outside a sun of 10^6 times its power.
TEST_P(Shares, OfADimLampReachItsRoom) {
    Scene world = test::plain_scene({0.5f, 0.4f, 0.3f});
    world.materials[0].double_sided = true;
    test::add_box(world, {-1, -1, -1}, {1, 1, 1}, -1);
    world.lights = {test::point_light({0.1, 0, 0}, 1.0f), test::directional_light({0.3, -1, 0.2})};
    world.lights[1].intensity = glm::vec3(1e6f);
    const DeviceScene scene = test::on_device(world);
    std::vector<Vpl> inside;
    for (const Vpl& vpl : test::place_lights(scene, {.vpls = 300}, GetParam()).lights)
        if (glm::dot(glm::vec3(vpl.position), glm::vec3(vpl.normal)) < 0.0f) inside.push_back(vpl);
    EXPECT_GE(inside.size(), 37u);
    EXPECT_NEAR(test::total_flux(scene, inside), 0.5 * 4 * pi, 1e-5 * 0.5 * 4 * pi);
}

// A sixteenth each: the lamp, the sun, the sky, the glowing floor; not each sample or direction.
TEST(Emitters, ShareAQuarterOfTheLightsEvenly) {
    Scene world = scene_of_all();
    world.lights.resize(2);
    world.lights[0].intensity = glm::vec3(1e9f);
    const EmitterSet set = make_emitters(test::on_device(world), {.vpls = 2560});
    std::size_t of_surfaces = 0, of_sky = 0;
    for (std::size_t i = 2; i < set.emitters.size(); ++i)
        (set.emitters[i].kind == EMITTER_AREA ? of_surfaces : of_sky) += set.emitters[i].vpl_count;
    EXPECT_NEAR(static_cast<double>(set.emitters[0].vpl_count), 2080.0, 1.0);
    EXPECT_NEAR(static_cast<double>(set.emitters[1].vpl_count), 160.0, 1.0);
    EXPECT_EQ(of_surfaces, 160u);
    EXPECT_EQ(of_sky, 160u);
}

// Without glowing surfaces an eighth each.
TEST(Emitters, ShareEvenlyAmongWhatIsThereAlone) {
    Scene world = test::plain_scene();
    test::add_floor(world, 2.0);
    world.lights = {test::point_light({0, 1, 0}, 1e9f)};
    world.environment = test::gradient_sky();
    const EmitterSet set = make_emitters(test::on_device(world), {.vpls = 1280});
    ASSERT_EQ(set.emitters.size(), 17u);
    EXPECT_NEAR(static_cast<double>(set.emitters[0].vpl_count), 1120.0, 1.0);
}

// Lumen of a spot of 1 cd, by the fall-off as KHR_lights_punctual states it, ring by ring.
double cone_flux(double inner, double outer) {
    constexpr int rings = 100000;
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        const double angle = outer * (i + 0.5) / rings;
        const double linear =
            (std::cos(angle) - std::cos(outer)) / std::max(std::cos(inner) - std::cos(outer), 1e-9);
        const double share = std::clamp(linear, 0.0, 1.0);
        sum += 2.0 * pi * std::sin(angle) * share * share;
    }
    return sum * outer / rings;
}

TEST(Emitters, ShareThreeQuartersOfTheLightsByTheFluxOfTheirCones) {
    constexpr int count = 1 << 20;
    const struct {
        double inner, outer;
        float candela;
    } spots[] = {{0.0, 0.7, 3.0f}, {0.6999, 0.7, 1.0f}, {0.3, 1.4, 0.5f}, {0.0, 0.02, 900.0f}};
    Scene scene = test::plain_scene();
    test::add_floor(scene, 2.0);
    double total = 0.0;
    for (const auto& spot : spots) {
        Light light = test::spot_light({0, 2, 0}, {0, -1, 0}, spot.outer, spot.candela);
        light.inner_angle = static_cast<float>(spot.inner);
        scene.lights.push_back(light);
        total += double{spot.candela} * cone_flux(spot.inner, spot.outer);
    }
    const EmitterSet set = make_emitters(test::on_device(scene), {.vpls = count});
    ASSERT_EQ(set.emitters.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        const double by_flux =
            double{spots[i].candela} * cone_flux(spots[i].inner, spots[i].outer) / total;
        const double wanted = count * (0.75 * by_flux + 0.25 / 4);
        // One light of rounding, and the float angles' own.
        EXPECT_NEAR(set.emitters[i].vpl_count, wanted, 2.0 + 1e-5 * wanted) << i;
    }
}

TEST(Emitters, GoAlongOneSequenceWithinTheirGroup) {
    const EmitterSet set = make_emitters(test::on_device(scene_of_all()), {.vpls = 500});
    std::uint32_t of_surfaces = 1, of_environment = 1;
    for (std::size_t i = 0; i < set.emitters.size(); ++i) {
        const Emitter& emitter = set.emitters[i];
        if (i < 3) {
            EXPECT_EQ(emitter.first_index, 1u) << i;  // lamps, the sun too
            continue;
        }
        std::uint32_t& next = emitter.kind == EMITTER_AREA ? of_surfaces : of_environment;
        EXPECT_EQ(emitter.first_index, next) << i;
        next += emitter.vpl_count;
    }
    EXPECT_GT(of_surfaces, 16u);
    EXPECT_GT(of_environment, 16u);
}

// Maps of samples lie differently by at most half a texel, and hold all that the map does.
TEST(Emitters, ShiftMapsWithinTheirTexels) {
    const DeviceScene scene = test::on_device(scene_of_all());
    for (const int size : {8, 64}) {
        EmitterOptions options{.shadow_size = size, .face_size = size};
        const EmitterSet usual = make_emitters(scene, options);
        double sum = 0.0, squares = 0.0, both = 0.0;
        constexpr std::uint32_t samples = 100, views = 8;  // spot, sun, cube of the point light
        for (std::uint32_t sample = 1; sample <= samples; ++sample) {
            options.sample = sample;
            const EmitterSet moved = make_emitters(scene, options);
            EXPECT_EQ(moved.emitters.size(), usual.emitters.size() - 12u);  // points: 4 of 16
            for (std::size_t i = 0; i < views; ++i) {
                const View &was = usual.views[i], &is = moved.views[i];
                ASSERT_EQ(static_cast<int>(is.width), size);
                both += (is.window.x - was.window.x) * (is.window.y - was.window.y) /
                        (double{is.right.w} * is.up.w) * size * size / 4.0;
                for (const auto& [extent, before, shift] :
                     {std::tuple{is.right.w, was.right.w, is.window.x - was.window.x},
                      std::tuple{is.up.w, was.up.w, is.window.y - was.window.y}}) {
                    const double texel = 2.0 * double{extent} / size;
                    EXPECT_LE(std::abs(shift), 0.5001 * texel);
                    EXPECT_GE(extent - std::abs(shift), before);
                    EXPECT_LE(extent, 1.3 * before);
                    sum += shift / texel;
                    squares += shift * shift / (texel * texel);
                }
            }
        }
        // Even over the texel: mean 0, variance 1/12, and nearer to it than independent shifts.
        EXPECT_NEAR(sum / (2 * views * samples), 0.0, 0.008);
        EXPECT_NEAR(squares / (2 * views * samples), 1.0 / 12.0, 0.004);
        EXPECT_NEAR(both / (views * samples), 0.0, 0.02);
    }
    // A map of one texel stays where it is.
    const EmitterSet one = make_emitters(scene, {.shadow_size = 1, .face_size = 1, .sample = 3});
    const EmitterSet first = make_emitters(scene, {.shadow_size = 1, .face_size = 1});
    for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_EQ(one.views[i].window, first.views[i].window);
        EXPECT_EQ(one.views[i].right, first.views[i].right);
    }
}

// Two panels, tilted, of other colours, and functions over them: the mean over the points of 64
// samples is nearer to the integral than that of as many independent points, and that of 256 nearer
// still. Replicates have other points.
TEST(Emitters, CoverSurfacesEvenlyOverAllSamples) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 2.0);
    Material red, blue;
    red.emission = {8.0f, 1.0f, 0.5f};
    blue.emission = {0.2f, 0.6f, 3.0f};
    test::add_quad(scene, {{{-1, 1, -1}, {0.2, 1.3, -1}, {0.2, 1.7, 0}, {-1, 1.4, 0}}},
                   test::add_material(scene, red));
    test::add_quad(scene, {{{0.5, 1, 0}, {1.5, 1, 0}, {1.5, 1.8, 0.9}, {0.5, 1.8, 0.9}}},
                   test::add_material(scene, blue));
    const DeviceScene device = test::on_device(scene);
    const auto value = [](const glm::dvec3& p) {
        return glm::dvec3(p.x, p.y * p.y, std::cos(3.0 * p.z) * p.x);
    };
    glm::dvec3 wanted(0.0), squares(0.0);
    double power = 0.0;
    constexpr int fine = 200;
    for (const EmissiveTriangle& t : device.emissive()) {
        const double weight = pi * t.area * luminance(t.radiance);
        power += weight;
        for (int i = 0; i < fine; ++i)
            for (int j = 0; j < fine; ++j) {
                const double root = std::sqrt((i + 0.5) / fine), v = (j + 0.5) / fine;
                const glm::dvec3 f = value(glm::dvec3(t.corner[0]) * (1.0 - root) +
                                           glm::dvec3(t.corner[1]) * (root * (1.0 - v)) +
                                           glm::dvec3(t.corner[2]) * (root * v));
                wanted += f * (weight / (fine * fine));
                squares += f * f * (weight / (fine * fine));
            }
    }
    wanted /= power;
    const glm::dvec3 deviation = glm::sqrt(squares / power - wanted * wanted);
    const auto apart = [&](std::uint32_t replicate, std::uint32_t samples) {
        glm::dvec3 sum(0.0);
        double all = 0.0;
        for (std::uint32_t sample = 1; sample <= samples; ++sample)
            for (const Emitter& one :
                 make_emitters(device, {.replicate = replicate, .sample = sample}).emitters) {
                if (one.kind != EMITTER_AREA) continue;
                all += luminance(glm::dvec3(one.intensity));
                sum += luminance(glm::dvec3(one.intensity)) * value(glm::dvec3(one.position));
            }
        EXPECT_NEAR(all / samples, power, 1e-5 * power);
        return glm::length((sum / all - wanted) / deviation) / std::sqrt(3.0);
    };
    // Of independent points it would be 1.
    for (const std::uint32_t samples : {16u, 64u, 256u}) {
        double square = 0.0;
        for (std::uint32_t replicate = 0; replicate < 8; ++replicate)
            square += std::pow(apart(replicate, samples), 2) * 4.0 * samples / 8.0;
        EXPECT_LT(std::sqrt(square), 0.4) << samples;
    }
    const auto place = [&](std::uint32_t replicate) {
        return make_emitters(device, {.replicate = replicate, .sample = 3})
            .emitters.back()
            .position;
    };
    EXPECT_NE(place(0), place(1));
    EXPECT_NE(place(1), place(2));
}

// Directions of later samples are drawn anew: the mean of what they bring to a plane is that of the
// environment, pi/2 + pi/3 n.y.
TEST(Emitters, OfLaterSamplesAreDrawnFromTheEnvironment) {
    Scene world = scene_of_all();
    world.environment = test::gradient_sky();
    world.environment->factor = {1.0f, 2.0f, 4.0f};
    const DeviceScene scene = test::on_device(world);
    EmitterOptions options;
    options.environment_alone = true;
    options.environment_lights = 6;
    const EmitterSet first = make_emitters(scene, options);
    const std::vector<Light> centres = scene.environment_lights(6);
    ASSERT_EQ(first.emitters.size(), 6u);
    EXPECT_TRUE(first.soft());
    for (std::size_t i = 0; i < 6; ++i)
        EXPECT_EQ(
            glm::vec3(first.emitters[i].axis.x, first.emitters[i].axis.y, first.emitters[i].axis.z),
            glm::normalize(centres[i].direction));
    auto weights = std::make_shared<SkyWeights>();
    *weights = {1, 2, {1.0f, 0.2f}};
    for (const bool weighted : {false, true}) {
        options.sky_weights = weighted ? weights : nullptr;
        for (const std::uint32_t replicate : {0u, 3u}) {
            options.replicate = replicate;
            const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, 0.8, -0.5));
            glm::dvec3 sum(0.0);
            constexpr std::uint32_t samples = 400;
            for (options.sample = 1; options.sample <= samples; ++options.sample) {
                const EmitterSet set = make_emitters(scene, options);
                ASSERT_EQ(set.emitters.size(), 6u);
                for (const Emitter& one : set.emitters) {
                    const glm::dvec3 toward(-one.axis.x, -one.axis.y, -one.axis.z);
                    const glm::dvec3 lux(one.intensity.x, one.intensity.y, one.intensity.z);
                    sum += scene.frame().exposure / samples *
                           std::max(glm::dot(toward, normal), 0.0) * lux;
                }
            }
            const double wanted = pi / 2 + pi / 3 * normal.y;
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(sum[c], (1 << c) * wanted, 0.01 * (1 << c) * wanted) << weighted;
        }
    }
    // Other weights, another replicate and another sample have other directions, all of them.
    const auto axes = [&](std::uint32_t sample, std::uint32_t replicate, bool weighted) {
        options.sample = sample;
        options.replicate = replicate;
        options.sky_weights = weighted ? weights : nullptr;
        std::vector<float> out;
        for (const Emitter& one : make_emitters(scene, options).emitters) out.push_back(one.axis.x);
        std::sort(out.begin(), out.end());
        return out;
    };
    const std::vector<float> usual = axes(1, 0, false);
    EXPECT_EQ(axes(1, 0, false), usual);
    for (const auto& other : {axes(1, 3, false), axes(2, 0, false), axes(1, 0, true)}) {
        std::vector<float> both;
        std::set_intersection(usual.begin(), usual.end(), other.begin(), other.end(),
                              std::back_inserter(both));
        EXPECT_TRUE(both.empty());
    }
}

// A spot alone has sharp shadows; emissive surfaces and the environment have soft ones.
TEST(Emitters, KnowWhetherTheirShadowsAreSoft) {
    Scene world = scene_of_all();
    const auto soft = [&](int surfaces, int directions) {
        return make_emitters(test::on_device(world),
                             {.area_samples = surfaces, .environment_lights = directions})
            .soft();
    };
    EXPECT_FALSE(soft(0, 0));
    EXPECT_TRUE(soft(3, 0));
    EXPECT_TRUE(soft(0, 3));
    const auto samples = [&](int surfaces, int directions, std::size_t pixels = 1u << 20) {
        const DeviceScene scene = test::on_device(world);
        return Emitters(scene, {.area_samples = surfaces, .environment_lights = directions})
            .samples_a_map(pixels);
    };
    EXPECT_EQ(samples(0, 0), 16u);
    EXPECT_EQ(samples(3, 0), 2u);
    // Another for each sample of a picture this large, but not of a small one.
    EXPECT_EQ(samples(0, 3), 1u);
    EXPECT_EQ(samples(0, 3, 1u << 6), 2u);
}

TEST(Emitters, OfAnEnvironmentAreCutAnewForAnotherCount) {
    const DeviceScene scene = test::on_device(scene_of_all());
    const std::vector<Light> four = scene.environment_lights(4);
    EXPECT_EQ(four.size(), 4u);
    EXPECT_EQ(scene.environment_lights(7).size(), 7u);
    EXPECT_TRUE(scene.environment_lights(0).empty());
    const std::vector<Light> again = scene.environment_lights(4);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(again[i].direction, four[i].direction);
    EXPECT_TRUE(test::on_device(Scene()).environment_lights(4).empty());
}

}  // namespace
}  // namespace clgi
