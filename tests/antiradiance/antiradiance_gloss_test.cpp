// Lobes between bins: energy, both ways, and the whole step against the definition.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <clgi/shared/microfacet.h>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "math_modes.hpp"
#include "random_elements.hpp"

namespace clgi {
namespace {

using test::HandElements;

using std::numbers::pi;
using test::nan;
constexpr std::uint32_t every_step = LOCAL_RECEIVE | LOCAL_REFLECT | LOCAL_GO_THROUGH;

CLGI_IN_BOTH_MATHS(AntiradianceGloss);
CLGI_IN_ALL_MODES(BrokenLobes);

// By quadrature over the hemisphere of light, around the mirrored direction, from the formulas of
// glTF 2.0.
double albedo_by_quadrature(float roughness, double cosine) {
    const int rings = 1500, turns = 300;
    const Material metal = test::finished(1.0f, roughness);
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const glm::dvec3 viewer(sine, 0.0, cosine), mirror(-sine, 0.0, cosine), side(0.0, 1.0, 0.0),
        up = glm::cross(mirror, side);
    double sum = 0.0;
    for (int i = 0; i < rings; ++i) {
        // Rings get narrower toward the axis, where narrow lobes are.
        const double u = (i + 0.5) / rings, at = pi * u * u * u;
        const double width = pi * 3.0 * u * u / rings;
        for (int k = 0; k < turns; ++k) {
            const double turn = 2.0 * pi * (k + 0.5) / turns;
            const glm::dvec3 light = std::cos(at) * mirror +
                                     std::sin(at) * (std::cos(turn) * side + std::sin(turn) * up);
            if (light.z <= 0.0) continue;
            const double value =
                test::gltf_reflected(metal, glm::dvec3(1.0), {0, 0, 1}, viewer, light).gloss.x;
            sum += value * light.z * std::sin(at) * width * 2.0 * pi / turns;
        }
    }
    return sum;
}

TEST(LobeAlbedos, AreThoseOfMicrofacets) {
    for (const float roughness : {0.25f, 0.5f, 0.8f, 1.0f}) {
        const double alpha = double{roughness} * double{roughness};
        const std::vector<float> found = lobe_albedos(alpha);
        ASSERT_EQ(found.size(), std::size_t{ALBEDO_STEPS} + 1);
        double mean = 0.0, steps = 0.0;
        for (int k = 0; k <= ALBEDO_STEPS; ++k) {
            const double at = k / double(ALBEDO_STEPS);
            mean += 4.0 * at * at * at * double{found[static_cast<std::size_t>(k)]};
            steps += 4.0 * at * at * at;
        }
        EXPECT_NEAR(mean / steps, 1.0, 0.02);
        for (int k = 8; k <= ALBEDO_STEPS; k += 4) {
            const double cosine = std::min(std::pow(k / double(ALBEDO_STEPS), 2.0), 0.99999);
            EXPECT_NEAR(double{found[static_cast<std::size_t>(k)]} *
                            double{microfacet_albedo(static_cast<float>(alpha))},
                        albedo_by_quadrature(roughness, cosine), 6e-3)
                << roughness << " at " << cosine;
        }
    }
    for (const double alpha : {0.0, 1.1, double{nan}}) EXPECT_THROW(lobe_albedos(alpha), Error);
}

// One leaf of a tilted normal for each exponent.
HandElements lobes(int count, const std::vector<float>& exponents, int turn = 0) {
    const DirectionBins bins = direction_bins(count);
    HandElements scene(direction_rows(bins));
    const std::uint32_t root = scene.inner(ELEMENT_NONE);
    for (const float exponent : exponents) {
        const glm::dvec3 n = glm::normalize(glm::dvec3(0.3 + turn, -0.5, 0.8 - 0.3 * turn));
        const std::uint32_t i =
            scene.leaf(root, test::scaled(bins, n), 2.0f, {0, 0, 0}, {0.1f, 0.2f, 0.3f});
        scene.lobes.push_back({i,
                               {0.9f, 0.5f, 0.25f},
                               exponent,
                               std::vector<glm::vec3>(scene.bins(), glm::vec3(0.0f))});
    }
    scene.close(root);
    return scene;
}

// The last bit of a cosine and the error of packet_power, to the power.
double rounding(double exponent, std::size_t bins) {
    return 3e-6 + 4e-7 * test::exponent_between_bins(exponent, bins);
}

// What a bin brings leaves with the lobe's albedo, whatever its exponent; and what leaves along a
// bin under light from everywhere is the same, as nearly as the rounds of scaling bring it.
TEST_P(AntiradianceGloss, HasTheAlbedoOfTheLobeInEveryBin) {
    const std::vector<float> exponents = {0.0f, 1.0f, 10.0f, 1e3f, 1e6f};
    for (const int width : {1, 16})
        for (const int count : {32, 36, 128, 512})
            for (const int turn : {0, 1, 2}) {
                const HandElements scene = lobes(count, exponents, turn);
                const test::LightOnDevice light(scene, {.math = GetParam(), .packet_width = width});
                const std::vector<float> factors = light.factors();
                for (std::size_t k = 0; k < exponents.size(); ++k) {
                    const std::vector<float> curve = test::lobe_curve(exponents[k]);
                    const glm::dvec3 normal(scene.elements[scene.lobes[k].element].normal);
                    const float* factor = factors.data() + k * scene.bins();
                    const double within = rounding(exponents[k], scene.bins());
                    double most = 0.0, least = 2.0;
                    for (std::size_t l = 0; l < scene.bins(); ++l) {
                        const glm::dvec3 w(scene.directions[l]);
                        const double cosine = -glm::dot(normal, w);
                        double leaves = 0.0, arrives = 0.0;
                        for (std::size_t j = 0; j < scene.bins(); ++j) {
                            const double other = glm::dot(normal, glm::dvec3(scene.directions[j]));
                            const double solid = scene.directions[j].w;
                            leaves += test::between_bins(scene, scene.lobes[k], factor, l, j) *
                                      solid * std::max(0.0, other);
                            arrives += test::between_bins(scene, scene.lobes[k], factor, j, l) *
                                       solid * std::max(0.0, -other);
                        }
                        const double wanted =
                            test::lobe_albedo_at(curve, std::abs(cosine) / glm::length(normal));
                        if (cosine > 0.0) {
                            EXPECT_NEAR(leaves, wanted, within * wanted)
                                << exponents[k] << ", " << count << " bins";
                            // Of a mean of 0.38: the roughest, on the horizon.
                            EXPECT_LE(leaves, 1.7);
                        } else if (cosine < 0.0) {
                            most = std::max(most, arrives / wanted);
                            least = std::min(least, arrives / wanted);
                        }
                    }
                    // 12 rounds; with few bins wide cells overlap lobes badly.
                    const double scaled = exponents[k] < 5.0f ? 0.002 : count < 64 ? 0.1 : 0.05;
                    EXPECT_GT(least, 1.0 - scaled) << exponents[k] << ", " << count << " bins";
                    EXPECT_LT(most, 1.0 + scaled) << exponents[k] << ", " << count << " bins";
                }
            }
}

// One bin brings light to one leaf: each channel is multiplied by the lobe's colour, and the most
// leaves along the bin nearest to the mirrored one.
TEST_P(AntiradianceGloss, OfOneBinIsSpreadAboutTheMirroredOne) {
    const std::vector<float> exponents = {0.0f, 1.0f, 10.0f, 1e3f, 1e6f};
    for (const int count : {32, 128, 512}) {
        HandElements scene = lobes(count, exponents);
        const glm::dvec3 normal(scene.elements[1].normal), n = glm::normalize(normal);
        std::uint32_t from = 0;
        for (std::uint32_t b = 0; b < scene.bins(); ++b)  // at some 45 degrees
            if (std::abs(glm::dot(n, glm::dvec3(scene.directions[b])) + 0.7) <
                std::abs(glm::dot(n, glm::dvec3(scene.directions[from])) + 0.7))
                from = b;
        scene.sky[from] = {1.0f, 2.0f, 4.0f, 0.0f};
        test::LightOnDevice found(scene, {.math = GetParam()});
        const std::vector<float> factors = found.factors();
        found.step(every_step);
        const std::vector<glm::vec4> exitant = found.exitant();
        const glm::dvec3 w(scene.directions[from]);
        const glm::dvec3 mirror = w - 2.0 * glm::dot(n, w) * n;
        const glm::dvec3 arrives(scene.sky[from]);
        const double flux = -glm::dot(normal, w) * scene.directions[from].w;
        for (std::size_t k = 0; k < exponents.size(); ++k) {
            const test::HandLobe& lobe = scene.lobes[k];
            std::size_t brightest = 0, nearest = 0;
            const double within = rounding(exponents[k], scene.bins());
            glm::dvec3 power(0.0);
            std::vector<double> gloss(scene.bins(), 0.0);
            for (std::size_t j = 0; j < scene.bins(); ++j) {
                const glm::dvec3 to(scene.directions[j]);
                const double cosine = glm::dot(normal, to);
                if (glm::dot(to, mirror) > glm::dot(glm::dvec3(scene.directions[nearest]), mirror))
                    nearest = j;
                if (cosine <= 0.0) continue;
                const double f =
                    test::between_bins(scene, lobe, factors.data() + k * scene.bins(), from, j);
                const glm::dvec3 leaves(exitant[found.row_of(lobe.element) * scene.bins() + j]);
                power += leaves * double(scene.directions[j].w);
                for (int c = 0; c < 3; ++c) {
                    const double diffuse = 0.1 * (c + 1) / pi * flux * arrives[c];
                    const double wanted =
                        2.0 * cosine * (diffuse + lobe.color[c] * f * flux * arrives[c]);
                    EXPECT_NEAR(leaves[c], wanted, within * wanted + 1e-7 * flux);
                }
                gloss[j] = leaves.x / cosine;
                if (gloss[j] > gloss[brightest]) brightest = j;
            }
            // Exponents of 1 and less are no lobe that has a brightest bin: scaling moves it.
            if (exponents[k] > 5.0f) {
                const glm::dvec3 bright(scene.directions[brightest]);
                EXPECT_GT(glm::dot(bright, mirror), std::cos(1.5 * std::sqrt(4.0 * pi / count)))
                    << exponents[k] << ", " << count << " bins";
            }
            const double albedo =
                test::lobe_albedo_at(test::lobe_curve(exponents[k]), -glm::dot(n, w));
            for (int c = 0; c < 3; ++c) {
                const double wanted =
                    2.0 * flux * arrives[c] * (0.1 * (c + 1) + lobe.color[c] * albedo);
                EXPECT_NEAR(power[c], wanted, within * wanted) << exponents[k];
            }
        }
    }
}

// Some leaves of random trees have lobes of any exponent, and light of their own.
HandElements glossy_elements(unsigned seed, int count) {
    HandElements scene = test::random_elements(seed, count);
    std::mt19937 random(seed + 100);
    std::uniform_real_distribution<float> number(0.0f, 1.0f);
    const float exponents[] = {0.0f, 0.3f, 1.0f, 7.5f, 40.0f, 1e3f, 1e6f};
    for (std::uint32_t i = 0; i < scene.elements.size(); ++i) {
        if (!scene.is_leaf(i) || number(random) < 0.4f) continue;
        test::HandLobe lobe{i, {}, exponents[random() % 7], {}};
        for (int c = 0; c < 3; ++c) lobe.color[c] = number(random);
        for (std::uint32_t b = 0; b < scene.bins(); ++b)
            lobe.sources.emplace_back(number(random), 2.0f * number(random), 0.0f);
        scene.lobes.push_back(lobe);
    }
    return scene;
}

TEST_P(AntiradianceGloss, OfRandomTreesIsThatOfTheDefinition) {
    const std::vector<std::uint32_t> steps = {
        LOCAL_REFLECT | LOCAL_GO_THROUGH, every_step, LOCAL_RECEIVE | LOCAL_GO_THROUGH,
        LOCAL_RECEIVE | LOCAL_REFLECT,    every_step, LOCAL_RECEIVE};
    for (const Storage storage : {Storage::full, Storage::half})
        for (const unsigned seed : {1u, 2u, 3u}) {
            const HandElements scene = glossy_elements(seed, seed == 3 ? 36 : 128);
            ASSERT_GT(scene.lobes.size(), 5u);
            test::LightOnDevice found(scene, {.math = GetParam(),
                                              .storage = storage,
                                              .form = seed == 2 ? Form::groups : Form::packets,
                                              .local_size = 4 * seed});
            test::LightByDefinition wanted(scene, found.factors());
            const double within = storage == Storage::half ? 4e-3 : 1e-5;
            for (const std::uint32_t step : steps) {
                wanted.step(step);
                found.step(step);
                const std::size_t leaves = scene.sources.size();
                test::expect_alike(found.exitant(), found.rows_of(wanted.exitant), within,
                                   "intensity");
                test::expect_alike(test::download<glm::vec4>(found.light.radiances, leaves),
                                   wanted.radiances, within, "radiance");
                test::expect_alike(test::download<glm::vec4>(found.light.irradiances, leaves),
                                   wanted.irradiances, within, "irradiance");
            }
            EXPECT_EQ(test::download<cl_uint>(found.light.non_finite, 1)[0], 0u);
        }
}

// What arrived is kept for pictures, of each leaf in front of it alone.
TEST_P(AntiradianceGloss, KeepsWhatArrivesInFront) {
    HandElements scene = lobes(128, {3.0f, 50.0f});
    for (std::uint32_t b = 0; b < scene.bins(); ++b)
        scene.sky[b] = {1.0f + b, 0.5f * b, 300.0f - b, 0.0f};
    for (const Form form : {Form::packets, Form::groups}) {
        test::LightOnDevice found(scene, {.math = GetParam(), .form = form});
        found.step(every_step);
        const auto rows = test::download<float>(found.gloss.arriving, 2 * 3 * 128);
        for (std::size_t k = 0; k < 2; ++k)
            for (std::size_t b = 0; b < 128; ++b) {
                const glm::vec3 n(scene.elements[scene.lobes[k].element].normal);
                const bool front = glm::dot(n, glm::vec3(scene.directions[b])) < 0.0f;
                for (std::size_t c = 0; c < 3; ++c)
                    EXPECT_EQ(rows[(3 * k + c) * 128 + b],
                              front ? scene.sky[b][static_cast<int>(c)] : 0.0f);
            }
    }
}

// The same light with packets of every width, in groups of every size, and with a group a leaf,
// whose lanes have as many bins each or do not.
TEST_P(AntiradianceGloss, DoesNotDependOnPackets) {
    const HandElements scene = glossy_elements(5, 64);
    std::vector<BuildOptions> builds;
    for (const int width : test::widths())
        builds.push_back({.math = GetParam(),
                          .packet_width = width,
                          .form = Form::packets,
                          .local_size = static_cast<std::size_t>(width)});
    for (const std::size_t lanes : {0, 7, 100})
        builds.push_back({.math = GetParam(), .form = Form::groups, .local_size = lanes});
    std::vector<glm::vec4> wanted;
    for (const BuildOptions& build : builds) {
        test::LightOnDevice found(scene, build);
        for (int step = 0; step < 3; ++step) found.step(every_step);
        if (wanted.empty()) wanted = found.exitant();
        if (GetParam() == Math::strict)
            EXPECT_EQ(found.exitant(), wanted) << build.packet_width << " " << build.local_size;
        else
            test::expect_alike(found.exitant(), wanted, 1e-5, "intensity");
    }
}

// A lobe without an exponent is no darkness.
TEST_P(BrokenLobes, CountsLobesThatAreNoNumbers) {
    for (const auto& [form, exponent] : {std::pair(Form::packets, true),
                                         {Form::packets, false},
                                         {Form::groups, true},
                                         {Form::groups, false}}) {
        HandElements scene = lobes(64, {exponent ? nan : 5.0f, 5.0f});
        if (!exponent) scene.lobes[0].color.y = nan;
        for (glm::vec4& sky : scene.sky) sky = glm::vec4(1, 1, 1, 0);
        BuildOptions build = GetParam();
        build.form = form;
        test::LightOnDevice found(scene, build);
        found.step(every_step);
        EXPECT_EQ(test::download<cl_uint>(found.light.non_finite, 1)[0], 1u) << exponent;
    }
}

TEST(AntiradianceGlossPasses, RefuseWhatDoesNotFit) {
    for (const int bins : {0, 28, 34, 4100})
        EXPECT_THROW(AntiradianceGlossPasses(test::programs(), bins), Error) << bins;
    const AntiradianceGlossPasses passes(test::programs(), 32);
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer tiny = test::empty<char>(1);
    const auto zeros = [](std::size_t floats) {
        return test::upload(std::vector<float>(floats, 0.0f));
    };
    const std::size_t row = 4 * 32;
    cl::Buffer directions = zeros(row);
    LinkBuffers links{zeros(4 * 12), zeros(9), zeros(1), zeros(1), zeros(1), 4, 1, 3, 1, 4};
    ElementRows rows{zeros(row), zeros(row), zeros(4 * row), zeros(4 * row), zeros(16), zeros(16)};
    LeafBuffers leaves{zeros(12), zeros(12), zeros(12), zeros(12), zeros(12), zeros(1)};
    GlossBuffers gloss;
    gloss.count = gloss.vertex_count = 2;
    gloss.leaves = zeros(8);
    gloss.albedos = zeros(ALBEDO_STEPS + 1);
    gloss.bins = zeros(4 * 32);
    gloss.factors = zeros(2 * 32);
    gloss.colors = zeros(2 * 4);
    gloss.sources = zeros(2 * 3 * 32);
    gloss.arriving = zeros(2 * 3 * 32);
    gloss.first_leaves = zeros(3);
    gloss.vertex_leaves = zeros(4);
    gloss.light = zeros(2 * 3 * 32);
    const auto lobes = [&] { passes.lobes(queue, links, gloss).wait(); };
    const auto local = [&] {
        passes.gloss(queue, every_step, links, rows, directions, leaves, gloss).wait();
    };
    const auto vertices = [&] { passes.vertices(queue, gloss).wait(); };
    EXPECT_NO_THROW(lobes());
    EXPECT_NO_THROW(local());
    EXPECT_NO_THROW(vertices());
    const auto refuse = [&](cl::Buffer& buffer, std::initializer_list<std::function<void()>> who) {
        const cl::Buffer kept = buffer;
        buffer = tiny;
        for (const auto& pass : who) EXPECT_THROW(pass(), Error);
        buffer = kept;
    };
    refuse(gloss.leaves, {lobes, local});
    refuse(links.elements, {lobes, local});
    refuse(directions, {local});
    refuse(gloss.bins, {lobes, local});
    refuse(gloss.albedos, {lobes});
    refuse(gloss.factors, {lobes, local});
    refuse(gloss.arriving, {local, vertices});
    for (cl::Buffer* buffer :
         {&links.first_links, &links.senders, &links.bins, &links.form_factors, &rows.sky,
          &rows.incident, &rows.powers, &rows.next_powers, &rows.exitant, &rows.next,
          &leaves.sources, &leaves.reflectances, &leaves.radiances, &leaves.irradiances,
          &leaves.changes, &leaves.non_finite, &gloss.colors, &gloss.sources})
        refuse(*buffer, {local});
    for (cl::Buffer* buffer : {&gloss.first_leaves, &gloss.vertex_leaves, &gloss.light})
        refuse(*buffer, {vertices});
    EXPECT_NO_THROW(local());
}

}  // namespace
}  // namespace clgi
