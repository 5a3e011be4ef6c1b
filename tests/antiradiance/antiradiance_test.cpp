// Light between elements: random trees against the definition, and stacks of plates against what is
// known of them.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>

#include "math_modes.hpp"
#include "random_elements.hpp"

namespace clgi {
namespace {

using test::expect_alike;
using test::HandElements;
using test::random_elements;
using test::scaled;

using std::numbers::pi;
constexpr std::uint32_t all_of_it = LOCAL_RECEIVE | LOCAL_REFLECT | LOCAL_GO_THROUGH;

CLGI_IN_ALL_MODES(Antiradiance);

TEST_P(Antiradiance, OfRandomTreesIsThatOfTheDefinition) {
    const std::vector<std::uint32_t> steps = {
        LOCAL_REFLECT | LOCAL_GO_THROUGH, all_of_it, LOCAL_RECEIVE | LOCAL_GO_THROUGH,
        LOCAL_RECEIVE | LOCAL_REFLECT,    all_of_it, LOCAL_RECEIVE};
    for (const unsigned seed : {1u, 2u, 3u}) {
        const HandElements scene = random_elements(seed, seed == 3 ? 32 : 128);
        ASSERT_GT(scene.sources.size(), 10u);
        test::LightByDefinition wanted(scene);
        BuildOptions build = GetParam();
        build.local_size = 4 * seed;
        build.form = seed == 2 ? Form::groups : Form::packets;
        test::LightOnDevice found(scene, build);
        EXPECT_GT(found.with_rows.size(), 5u);
        EXPECT_LT(found.with_rows.size(), 0.75 * scene.elements.size());
        const double within = GetParam().storage == Storage::half ? 4e-3 : 4e-6;
        for (const std::uint32_t step : steps) {
            const std::vector<glm::dvec3> before = wanted.irradiances;
            wanted.step(step);
            found.step(step);
            const std::size_t leaves = scene.sources.size();
            expect_alike(found.exitant(), found.rows_of(wanted.exitant), within, "intensity");
            expect_alike(test::download<glm::vec4>(found.light.radiances, leaves), wanted.radiances,
                         within, "radiance");
            expect_alike(test::download<glm::vec4>(found.light.irradiances, leaves),
                         wanted.irradiances, within, "irradiance");
            const auto changes = test::download<glm::vec4>(found.light.changes, leaves);
            for (const Element& element : scene.elements) {
                if (element.normal.w == 0.0f) continue;
                const std::size_t row = element.row;
                const glm::dvec3 moved =
                    double(element.normal.w) * glm::abs(wanted.irradiances[row] - before[row]);
                const glm::dvec3 now = glm::abs(wanted.irradiances[row]);
                const double flux = element.normal.w * (now.x + now.y + now.z);
                EXPECT_NEAR(changes[row].w, flux, 4.0 * within * flux);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(changes[row][c], moved[c], 8.0 * within * flux);
            }
        }
        EXPECT_EQ(test::download<cl_uint>(found.light.non_finite, 1)[0], 0u);
    }
}

// Plates of 1 m^2 one behind the other along the first bin; the first one shines. All of it is
// exact in floats: U is 1 below the diagonal, J is 1 [Dachsbacher07, Eq. 6, figure 4].
HandElements stack(std::uint32_t plates) {
    HandElements scene(std::vector<glm::vec4>(32, glm::vec4(1, 0, 0, 0)));
    scene.directions[0] = {0, 0, 1, 1};
    const std::uint32_t root = scene.inner(ELEMENT_NONE);
    for (std::uint32_t i = 0; i < plates; ++i)
        scene.leaf(root, {0, 0, i == 0 ? 1 : -1}, 1.0f, i == 0 ? glm::vec3(1, 2, 4) : glm::vec3(0),
                   glm::vec3(0));
    scene.close(root);
    for (std::uint32_t k = 0; k < plates; ++k)
        for (std::uint32_t i = k + 1; i < plates; ++i)
            scene.links.push_back({k + 1, i + 1, 0, 1.0f});
    return scene;
}

// Behind the first plate that it meets the light is gone after as many steps as there are plates,
// to the last bit, however large it grew between.
TEST_P(Antiradiance, RemovesTheLightBehindPlates) {
    for (const std::uint32_t plates : {2u, 3u, 5u, 12u, 24u}) {
        if (plates == 24u && GetParam().storage == Storage::half) continue;  // beyond 65504
        const HandElements scene = stack(plates);
        test::LightOnDevice found(scene, GetParam());
        found.step(LOCAL_REFLECT);
        double most = 0.0;
        for (std::uint32_t step = 1; step < plates; ++step) {
            found.step(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
            for (const glm::vec4& e : test::download<glm::vec4>(found.light.irradiances, plates))
                most = std::max(most, double(std::abs(e.x)));
            if (plates == 5 && step == 1) {  // nothing is hidden yet
                EXPECT_EQ(test::download<glm::vec4>(found.light.irradiances, plates)[4],
                          glm::vec4(1, 2, 4, 0));
            }
        }
        const auto e = test::download<glm::vec4>(found.light.irradiances, plates);
        EXPECT_EQ(e[0], glm::vec4(0.0f));
        EXPECT_EQ(e[1], glm::vec4(1, 2, 4, 0));
        for (std::uint32_t i = 2; i < plates; ++i) EXPECT_EQ(e[i], glm::vec4(0.0f)) << i;
        const std::map<std::uint32_t, double> peaks = {
            {2, 1}, {3, 1}, {5, 2}, {12, 126}, {24, 352716}};  // binomials of n - 3
        EXPECT_EQ(most, peaks.at(plates));
        found.step(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
        EXPECT_EQ(test::download<glm::vec4>(found.light.irradiances, plates)[plates - 1],
                  plates == 2 ? glm::vec4(1, 2, 4, 0) : glm::vec4(0.0f));
    }
}

// Where half intensities do not reach, they stay at the largest half; nothing becomes infinite.
TEST_P(Antiradiance, StaysFiniteInHalfStorage) {
    const HandElements scene = stack(24);
    BuildOptions halves = GetParam();
    halves.storage = Storage::half;
    test::LightOnDevice found(scene, halves);
    found.step(LOCAL_REFLECT);
    for (int step = 1; step < 60; ++step) found.step(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
    for (const glm::vec4& intensity : found.exitant())
        for (int c = 0; c < 3; ++c) ASSERT_LE(std::abs(intensity[c]), 65504.0f);
    EXPECT_EQ(test::download<cl_uint>(found.light.non_finite, 1)[0], 0u);
}

// Infinite parallel plates, each with two sides: plate k sends to all others through all bins of a
// hemisphere.
HandElements plates_of_two_sides(std::uint32_t plates, float reflectance) {
    const DirectionBins bins = direction_bins(32);
    HandElements scene(direction_rows(bins));
    const glm::vec3 up = scaled(bins, {0, 0, 1});
    const std::uint32_t root = scene.inner(ELEMENT_NONE);
    for (std::uint32_t i = 0; i < plates; ++i)
        for (const float side : {1.0f, -1.0f})
            scene.leaf(root, side * up, 1.0f, glm::vec3(i == 0 && side > 0.0f ? 1.0f : 0.0f),
                       glm::vec3(reflectance));
    scene.close(root);
    for (std::uint32_t k = 0; k < plates; ++k)
        for (std::uint32_t i = 0; i < plates; ++i)
            for (std::uint32_t b = 0; b < scene.bins(); ++b) {
                const float cosine = glm::dot(up, glm::vec3(scene.directions[b]));
                if (i == k || (i > k) != (cosine > 0.0f)) continue;
                for (const std::uint32_t side : {0u, 1u})  // of the sender; the near one receives
                    scene.links.push_back({1 + 2 * k + side, 1 + 2 * i + (i > k ? 1u : 0u), b,
                                           1.0f / std::abs(cosine)});
            }
    return scene;
}

// Three plates of albedo 0.66: reflecting and letting through at once diverges, with the eigenvalue
// (rho + sqrt(5 rho^2 + 4 rho)) / 2 of (rho R - J) U [derived]. Three steps that let through for
// every one that reflects converge to what lies between two plates, 1 / (1 - rho^2); the vertex
// patch sees nothing.
TEST_P(Antiradiance, BetweenThreePlatesNeedsTheAsymmetricIteration) {
    const float rho = 0.66f;
    const HandElements scene = plates_of_two_sides(3, rho);
    const auto arrives = [](const test::LightOnDevice& light, std::size_t leaf) {
        return test::download<glm::vec4>(light.light.irradiances, 6)[leaf].x / pi;
    };
    const bool half = GetParam().storage == Storage::half;
    if (!half) {  // 40 steps end beyond 65504
        test::LightOnDevice symmetric(scene, GetParam());
        symmetric.step(LOCAL_REFLECT);
        double before = 0.0, now = 0.0;
        for (int step = 0; step < 40; ++step) {
            symmetric.step(all_of_it);
            before = now;
            now = arrives(symmetric, 3);
        }
        const double growth = (rho + std::sqrt(5.0 * rho * rho + 4.0 * rho)) / 2.0;
        EXPECT_NEAR(std::abs(now / before), growth, 2e-3);
    }
    const double within = half ? 2e-3 : 2e-5;
    test::LightOnDevice asymmetric(scene, GetParam());
    asymmetric.step(LOCAL_REFLECT);
    for (int round = 0; round < 40; ++round) {
        for (int step = 0; step < 3; ++step) asymmetric.step(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
        asymmetric.step(LOCAL_RECEIVE | LOCAL_REFLECT);
    }
    EXPECT_NEAR(arrives(asymmetric, 3), 1.0 / (1.0 - rho * rho), within);  // the far side's front
    EXPECT_NEAR(arrives(asymmetric, 0), rho / (1.0 - rho * rho), within);
    EXPECT_NEAR(arrives(asymmetric, 5), 0.0, within);  // behind an opaque plate
}

// By how much the change from step to step grows: the table of STABILITY 1.8. It is above 1 from
// sqrt(2) - 1 on for three plates, and from less for more of them.
TEST_P(Antiradiance, GrowsBetweenPlatesAsTheTableSays) {
    const struct {
        std::uint32_t plates;
        float reflectance;
        double growth;
    } rows[] = {{3, 0.3f, 0.79226163},  {3, 0.41421356f, 1.0}, {3, 0.5f, 1.15138782},
                {3, 0.66f, 1.42749715}, {3, 0.8f, 1.66491106}, {3, 1.0f, 2.0},
                {4, 0.19393657f, 1.0},  {4, 1.0f, 3.0},        {5, 0.09478759f, 1.0},
                {6, 1.0f, 5.0}};
    const auto growth_of = [](const HandElements& plates, const BuildOptions& build, int steps) {
        test::LightOnDevice light(plates, build);
        light.step(LOCAL_REFLECT);
        double value = 0.0, change = 0.0, growth = 0.0;
        for (int step = 0; step < steps; ++step) {
            light.step(all_of_it);
            const double now = test::download<glm::vec4>(light.light.irradiances, 4)[3].x;
            growth = std::abs((now - value) / change);
            change = now - value;
            value = now;
        }
        return growth;
    };
    for (const auto& row : rows) {
        const HandElements plates = plates_of_two_sides(row.plates, row.reflectance);
        const std::string what =
            std::to_string(row.plates) + " plates, " + std::to_string(row.reflectance);
        // Halves end at 65504: they follow the first steps.
        if (GetParam().storage == Storage::half) {
            const double wanted = growth_of(plates, BuildOptions{}, 6);
            EXPECT_NEAR(growth_of(plates, GetParam(), 6), wanted, 1e-2 * wanted) << what;
        } else {
            EXPECT_NEAR(growth_of(plates, GetParam(), 30), row.growth, 2e-3 * row.growth) << what;
        }
    }
}

TEST_P(Antiradiance, CountsLeavesThatAreNotFinite) {
    HandElements scene = stack(3);
    scene.sources[0].y = std::numeric_limits<float>::quiet_NaN();
    for (const Form form : {Form::packets, Form::groups}) {
        BuildOptions build = GetParam();
        build.form = form;
        test::LightOnDevice found(scene, build);
        found.step(LOCAL_REFLECT);
        EXPECT_EQ(test::download<cl_uint>(found.light.non_finite, 1)[0], 0u);
        found.step(LOCAL_RECEIVE | LOCAL_GO_THROUGH);
        EXPECT_EQ(test::download<cl_uint>(found.light.non_finite, 1)[0], 2u);
        const auto e = test::download<glm::vec4>(found.light.irradiances, 3);
        EXPECT_TRUE(std::isnan(e[2].y));
        EXPECT_EQ(e[2].x, 1.0f);
    }
}

// What meets the back of a leaf does not count for it, not even where it is no number.
TEST_P(Antiradiance, OfWhatMeetsTheBackIsNotReceived) {
    HandElements scene = stack(3);
    scene.sky[1] = glm::vec4(std::numeric_limits<float>::infinity());
    scene.directions[1] = {0, 0, -1, 1};
    test::LightOnDevice found(scene, GetParam());
    found.step(LOCAL_REFLECT);
    found.step(LOCAL_RECEIVE | LOCAL_REFLECT);
    const auto e = test::download<glm::vec4>(found.light.irradiances, 3);
    EXPECT_EQ(e[0].x, std::numeric_limits<float>::infinity());  // it faces the other way
    EXPECT_EQ(e[1], glm::vec4(1, 2, 4, 0));
    EXPECT_EQ(e[2], glm::vec4(1, 2, 4, 0));
}

TEST(AntiradiancePasses, RefuseWhatDoesNotFit) {
    for (const int bins : {0, 28, 33, 34, 4100})
        EXPECT_THROW(AntiradiancePasses(test::programs(), bins), Error) << bins;
    const AntiradiancePasses passes(test::programs(), 32);
    const cl::CommandQueue& queue = test::device().queue;
    const cl::Buffer tiny = test::empty<char>(1);
    const auto zeros = [](std::size_t floats) {
        return test::upload(std::vector<float>(floats, 0.0f));
    };
    const std::size_t row = 4 * 32;
    cl::Buffer list = zeros(1), directions = zeros(row);
    LinkBuffers links{zeros(4 * 12), zeros(9), zeros(1), zeros(1), zeros(1), 4, 1, 3, 1, 4};
    ElementRows rows{zeros(row), zeros(row), zeros(4 * row), zeros(4 * row), zeros(16), zeros(16)};
    LeafBuffers leaves{zeros(12), zeros(12), zeros(12), zeros(12), zeros(12), zeros(1)};
    const ElementParams one{0, 1, 0, 0};
    const auto global = [&] { passes.global(queue, one, list, links, rows).wait(); };
    const auto pull = [&] { passes.pull(queue, one, list, links, rows).wait(); };
    const auto local = [&] {
        passes.local(queue, one, list, links, rows, directions, leaves).wait();
    };
    // No light is to arrive: the first element has no links.
    EXPECT_NO_THROW(local());
    // Every buffer alone, too small for each pass that takes it.
    const auto refuse = [&](cl::Buffer& buffer, std::initializer_list<std::function<void()>> who) {
        const cl::Buffer kept = buffer;
        buffer = tiny;
        for (const auto& pass : who) EXPECT_THROW(pass(), Error);
        buffer = kept;
    };
    refuse(list, {global, pull, local});
    refuse(links.elements, {global, pull, local});
    for (cl::Buffer* buffer : {&links.first_links, &links.senders, &links.bins, &links.form_factors,
                               &rows.sky, &rows.incident, &rows.powers, &rows.exitant})
        refuse(*buffer, {global, local});
    refuse(rows.next, {pull, local});
    refuse(rows.next_powers, {pull, local});
    for (cl::Buffer* buffer :
         {&directions, &leaves.sources, &leaves.reflectances, &leaves.radiances,
          &leaves.irradiances, &leaves.changes, &leaves.non_finite})
        refuse(*buffer, {local});
    EXPECT_NO_THROW(local());
}

// With groups that the links of an element do and do not fill, and that divide bins or do not.
TEST(AntiradianceGroups, GiveTheBitsOfPackets) {
    const HandElements scene = random_elements(5, 32);
    const std::size_t leaves = scene.sources.size();
    for (const Storage storage : {Storage::full, Storage::half}) {
        test::LightOnDevice wanted(scene, {.storage = storage, .form = Form::packets});
        std::vector<test::LightOnDevice> found;
        for (const std::size_t lanes : {0, 1, 7, 100})
            found.emplace_back(
                scene, BuildOptions{.storage = storage, .form = Form::groups, .local_size = lanes});
        for (const std::uint32_t step : {std::uint32_t{LOCAL_REFLECT | LOCAL_GO_THROUGH}, all_of_it,
                                         std::uint32_t{LOCAL_RECEIVE | LOCAL_REFLECT}, all_of_it,
                                         std::uint32_t{LOCAL_RECEIVE | LOCAL_GO_THROUGH}}) {
            wanted.step(step);
            for (test::LightOnDevice& of : found) {
                of.step(step);
                EXPECT_EQ(of.exitant(), wanted.exitant());
                for (const auto rows : {&LeafBuffers::radiances, &LeafBuffers::irradiances})
                    EXPECT_EQ(test::download<glm::vec4>(of.light.*rows, leaves),
                              test::download<glm::vec4>(wanted.light.*rows, leaves));
            }
        }
    }
}

}  // namespace
}  // namespace clgi
