// The iterations of the solver: where they meet, end and diverge, and that no light is shown of one
// that diverged.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include "lab/scenes/interiors.hpp"

#include "device.hpp"
#include "math_modes.hpp"
#include "rooms.hpp"
#include "solved_antiradiance.hpp"

namespace clgi {
namespace {

using test::options_of;
using test::power;
using test::Solved;

CLGI_IN_BOTH_MATHS(AntiradianceIteration);
CLGI_IN_ALL_MODES(AntiradianceOfShelves);

// Shelves as wide as the room, behind each other. What changes behind them may grow for as many
// steps as there are, and that is no divergence.
TEST_P(AntiradianceIteration, LetsLightGoThroughManySurfaces) {
    Scene scene = test::plain_scene(glm::vec3(0.3f));
    scene.materials[0].double_sided = true;
    test::add_box(scene, {0, 0, 0}, {1, 1, 1}, -1);
    for (int k = 1; k <= 12; ++k) {
        const double y = 0.07 * k;
        test::add_quad(scene, {glm::dvec3(0, y, 0), {0, y, 1}, {1, y, 1}, {1, y, 0}});
    }
    scene.lights = {test::point_light({0.5, 0.95, 0.5})};
    AntiradianceOptions options = options_of(GetParam(), 64, 1200);
    options.iteration = Iteration::asymmetric;
    const Solved solved(scene, options);
    const AntiradianceStatus status = solved.solver.status();
    EXPECT_TRUE(status.converged);
    EXPECT_FALSE(status.given_up);
    EXPECT_GT(*std::max_element(status.residuals.begin(), status.residuals.end()), 2.0);
}

// In a bright room far more arrives than at first, and that is no divergence either.
TEST_P(AntiradianceIteration, KeepsLightThatIsReflectedOften) {
    Scene scene = test::plain_scene(glm::vec3(0.9f));
    test::add_box(scene, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
    test::add_box(scene, {0.5, 0.4, 0.4}, {0.6, 0.5, 0.5}, 1);
    scene.lights = {test::point_light({0.3, 0.6, 0.4})};
    AntiradianceOptions options = options_of(GetParam(), 128, 1000);
    options.iteration = Iteration::asymmetric;
    const Solved solved(scene, options);
    EXPECT_TRUE(solved.solver.status().converged);
    EXPECT_FALSE(solved.solver.status().given_up);
    const double wanted = 4.0 * 3.14159265358979323846 * 0.9 / 0.1;
    EXPECT_NEAR(power(solved).x, wanted, 0.2 * wanted);
}

// Nothing of an iteration that diverged is shown: leaves send what they reflect of direct light.
void expect_no_light(const Solved& solved) {
    const AntiradianceStatus status = solved.solver.status();
    EXPECT_TRUE(status.given_up);
    EXPECT_FALSE(status.converged);
    EXPECT_LT(status.residuals.size(), 200u);
    for (const glm::vec4& e : solved.irradiances()) ASSERT_EQ(e, glm::vec4(0.0f));
    const auto radiances =
        test::download<glm::vec4>(solved.solver.leaves().radiances, solved.count());
    const auto sources = solved.sources();
    for (std::size_t row = 0; row < sources.size(); ++row)
        ASSERT_EQ(glm::vec3(radiances[row]), glm::vec3(sources[row])) << row;
    const LeafSurface& surface = solved.solver.surface();
    for (const glm::vec4& e : test::download<glm::vec4>(surface.light, surface.vertex_count))
        ASSERT_EQ(e, glm::vec4(0.0f));
}

// With one bin for each leaf the light of this room grows at each reflection, in every iteration;
// half storage keeps it from growing without end, and it is seen all the same.
TEST_P(AntiradianceIteration, GivesUpWhereLightGrows) {
    const Scene scene = office();
    for (const Storage storage : {Storage::full, Storage::half}) {
        AntiradianceOptions options = options_of(GetParam(), 128, 4000);
        options.links.spread = Spread::none;
        options.build.storage = storage;
        Solved solved(scene, options);
        expect_no_light(solved);
        EXPECT_TRUE(solved.solver.status().diverged);
        EXPECT_EQ(solved.solver.status().iteration, Iteration::asymmetric);
    }
}

// Links from leaves to themselves, along which what is let through becomes `gain` times as much.
void add_loops(Solved& solved, double gain) {
    const LinkBuffers& links = solved.solver.links();
    const auto elements = test::download<Element>(links.elements, links.element_count);
    const auto first =
        test::download<std::uint32_t>(links.first_links, 2 * links.element_count + 1);
    auto senders = test::download<std::uint32_t>(links.senders, links.link_count);
    const auto bins = test::download<std::uint16_t>(links.bins, links.link_count);
    auto factors = test::download<float>(links.form_factors, links.link_count);
    int loops = 0;
    for (std::uint32_t i = 0; i < links.element_count; ++i) {
        const Element& leaf = elements[i];
        if (leaf.end != i + 1 || leaf.sends == ELEMENT_NONE) continue;
        for (std::uint32_t k = first[2 * i + 1]; k < first[2 * i + 2]; ++k) {
            const glm::vec3 way(solved.solver.bins().directions[bins[k]]);
            const float cosine = glm::dot(glm::vec3(leaf.normal), way);
            if (cosine > -0.1f) continue;
            senders[k] = leaf.sends;
            factors[k] = static_cast<float>(gain) / (-cosine * leaf.normal.w);
            ++loops;
            break;
        }
    }
    EXPECT_GT(loops, 10);
    const cl::CommandQueue& queue = test::device().queue;
    queue.enqueueWriteBuffer(links.senders, CL_TRUE, 0, 4 * senders.size(), senders.data());
    queue.enqueueWriteBuffer(links.form_factors, CL_TRUE, 0, 4 * factors.size(), factors.data());
}

TEST_P(AntiradianceIteration, GivesUpWhereLightGoesRoundInABin) {
    AntiradianceOptions options = options_of(GetParam(), 32, 600);
    options.iteration = Iteration::asymmetric;
    for (const double gain : {0.5, 1.1, 40.0, 1e6}) {
        Solved solved(test::furnished_room(5), options, false);
        add_loops(solved, gain);
        EXPECT_TRUE(solved.solver.run());
        if (gain > 1.0)
            expect_no_light(solved);
        else
            EXPECT_TRUE(solved.solver.status().converged);
    }
}

// Light that came to rest stays, however many steps follow in which nothing changes.
TEST_P(AntiradianceIteration, KeepsLightThatCameToRestLongAgo) {
    for (const Storage storage : {Storage::full, Storage::half}) {
        AntiradianceOptions options = options_of(GetParam(), 32, 300);
        options.iteration = Iteration::asymmetric;
        options.build.storage = storage;
        options.through_steps = 80;
        options.steps = 2000;
        const Solved solved(test::furnished_room(5), options);
        const AntiradianceStatus status = solved.solver.status();
        EXPECT_FALSE(status.given_up);
        EXPECT_TRUE(status.converged);
        EXPECT_EQ(status.residuals.size(), 2000u);
    }
}

// The next run begins anew: after a light that diverged comes one that does not.
TEST(AntiradianceIterationSteps, GoOnAfterDivergence) {
    AntiradianceOptions options = options_of(Math::strict, 32, 600);
    options.iteration = Iteration::asymmetric;
    Solved solved(test::furnished_room(5), options);
    const auto wanted = solved.irradiances();
    const LinkBuffers& links = solved.solver.links();
    const auto senders = test::download<std::uint32_t>(links.senders, links.link_count);
    const auto factors = test::download<float>(links.form_factors, links.link_count);
    add_loops(solved, 100.0);
    EXPECT_TRUE(solved.solver.run());
    expect_no_light(solved);
    const cl::CommandQueue& queue = test::device().queue;
    queue.enqueueWriteBuffer(links.senders, CL_TRUE, 0, 4 * senders.size(), senders.data());
    queue.enqueueWriteBuffer(links.form_factors, CL_TRUE, 0, 4 * factors.size(), factors.data());
    EXPECT_TRUE(solved.solver.run());
    EXPECT_FALSE(solved.solver.status().given_up);
    EXPECT_EQ(solved.irradiances(), wanted);
}

// Where nothing can lie between, there is nothing to let through, and no step for it.
TEST(AntiradianceIterationSteps, AreThoseOfLightAloneWhereNothingLiesBetween) {
    Scene scene = test::plain_scene({0.7f, 0.5f, 0.2f});
    test::add_box(scene, {0, 0, 0}, {1.2, 0.9, 1.0}, -1);
    scene.lights = {test::point_light({0.5, 0.6, 0.4})};
    AntiradianceOptions options = options_of(Math::strict, 64, 600);
    options.iteration = Iteration::symmetric;
    const Solved symmetric(scene, options);
    options.iteration = Iteration::asymmetric;
    const Solved asymmetric(scene, options);
    const AntiradianceStatus status = asymmetric.solver.status();
    EXPECT_FALSE(status.lets_through);
    EXPECT_EQ(status.iteration, Iteration::symmetric);
    EXPECT_EQ(status.residuals, symmetric.solver.status().residuals);
    EXPECT_EQ(asymmetric.irradiances(), symmetric.irradiances());
    EXPECT_TRUE(Solved(test::furnished_room(5), options).solver.status().lets_through);
}

// Reflecting and letting light through at once diverges between thin shelves; that is seen, and the
// asymmetric iteration finds the light.
TEST_P(AntiradianceOfShelves, SeesDivergenceAndConvergesAllTheSame) {
    AntiradianceOptions options = options_of(GetParam(), 128, 2000);
    options.iteration = Iteration::symmetric;
    const Scene scene = test::shelves(0.6f);
    const Solved symmetric(scene, options);
    EXPECT_TRUE(symmetric.solver.status().diverged);
    expect_no_light(symmetric);

    options.iteration = Iteration::asymmetric;
    options.residual = 1e-4;
    const Solved asymmetric(scene, options);
    EXPECT_TRUE(asymmetric.solver.status().converged);

    options.iteration = Iteration::automatic;
    const Solved either(scene, options);
    const AntiradianceStatus status = either.solver.status();
    EXPECT_TRUE(status.diverged);
    EXPECT_TRUE(status.converged);
    EXPECT_FALSE(status.given_up);
    EXPECT_EQ(status.iteration, Iteration::asymmetric);
    EXPECT_EQ(either.irradiances(), asymmetric.irradiances());
}

// Where both iterations converge they find the same light.
TEST_P(AntiradianceIteration, BothIterationsMeet) {
    AntiradianceOptions options = options_of(GetParam(), 128, 1500);
    options.residual = 1e-5;
    options.iteration = Iteration::symmetric;
    const Solved one(test::furnished_room(3), options);
    options.iteration = Iteration::asymmetric;
    const Solved other(test::furnished_room(3), options);
    EXPECT_TRUE(one.solver.status().converged);
    EXPECT_TRUE(other.solver.status().converged);
    const glm::dvec3 mean = power(other);
    double square = 0.0, all = 0.0;
    const auto a = one.irradiances(), b = other.irradiances();
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            square += std::pow(double(a[i][c]) - b[i][c], 2);
            all += std::pow(double(b[i][c]), 2);
        }
    EXPECT_LT(std::sqrt(square / all), 1e-3);
    EXPECT_GT(mean.x, 0.0);
}

TEST(AntiradianceIterationSteps, AsymmetricStepsCanBeStopped) {
    AntiradianceOptions options = options_of(Math::strict, 32, 600);
    options.iteration = Iteration::asymmetric;
    Solved solved(test::furnished_room(5), options, false);
    int asked = 0;
    EXPECT_FALSE(solved.solver.run([&](double share) {
        EXPECT_LE(share, 1.0);
        return ++asked < 2;
    }));
    EXPECT_EQ(asked, 2);
    EXPECT_FALSE(solved.solver.status().converged);
    EXPECT_EQ(solved.solver.status().residuals.size(), 2u);
    options.steps = 5;
    EXPECT_EQ(Solved(test::furnished_room(5), options).solver.status().residuals.size(), 5u);
}

// With k steps that let light through for each that reflects, the first reflection is step k + 1
// and is seen in the one after it; until then all numbers are the same. However many, one light.
TEST(AntiradianceIterationSteps, LetsLightThroughAsOftenAsItIsTold) {
    AntiradianceOptions options = options_of(Math::strict, 32, 600);
    options.iteration = Iteration::asymmetric;
    options.steps = 60;
    const auto residuals = [&](int through) {
        options.through_steps = through;
        return Solved(test::furnished_room(5), options).solver.status().residuals;
    };
    const std::vector<double> long_run = residuals(20);
    for (const int k : {1, 2, 4}) {
        const std::vector<double> found = residuals(k);
        ASSERT_EQ(found.size(), 60u);
        const auto first = static_cast<std::size_t>(k) + 1;
        for (std::size_t step = 0; step < first; ++step)
            EXPECT_EQ(found[step], long_run[step]) << k << " " << step;
        for (std::size_t step = first; step < 30; ++step) {
            const bool shows = (step - first) % first == 0;
            EXPECT_EQ(found[step] > found[step - 1], shows) << k << " " << step;
        }
    }
    options.steps = 0;
    options.residual = 1e-5;
    options.through_steps = 0;
    const auto wanted = Solved(test::furnished_room(5), options).irradiances();
    options.through_steps = 3;
    const Solved solved(test::furnished_room(5), options);
    EXPECT_TRUE(solved.solver.status().converged);
    const auto found = solved.irradiances();
    double most = 0.0;
    for (const glm::vec4& e : wanted) most = std::max(most, double(e.x));
    for (std::size_t i = 0; i < wanted.size(); ++i)
        EXPECT_NEAR(found[i].x, wanted[i].x, 1e-4 * most) << i;
}

TEST(AntiradianceIterationSteps, StopsWhenItIsToldTo) {
    Solved solved(test::furnished_room(5), options_of(Math::strict, 32, 600), false);
    int asked = 0;
    EXPECT_FALSE(solved.solver.run([&](double) { return ++asked < 3; }));
    EXPECT_EQ(asked, 3);
    EXPECT_EQ(solved.solver.status().iteration, Iteration::symmetric);
    EXPECT_FALSE(solved.solver.status().given_up);
    EXPECT_TRUE(solved.solver.run());
    EXPECT_TRUE(solved.solver.status().converged);
}

}  // namespace
}  // namespace clgi
