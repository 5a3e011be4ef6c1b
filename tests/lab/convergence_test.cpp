// How the iterations of antiradiance come to rest, step by step, and where one of them does not.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <clgi/error.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "device.hpp"
#include "gltf_draft.hpp"
#include "lab/convergence.hpp"
#include "rooms.hpp"

namespace clgi::lab {
namespace {

// Two leaves of 1 and 3 m^2 that receive 2 and 6 lux, 5 on average, and 1 and 7 by another answer.
TEST(LeafDifference, IsRelativeAndWeightedByArea) {
    const std::vector<glm::vec4> truth = {glm::vec4(2.0f), glm::vec4(6.0f)};
    std::vector<glm::vec4> other = {glm::vec4(1.0f), glm::vec4(7.0f)};
    EXPECT_NEAR(leaf_difference(other, truth, {1.0, 3.0}), 1.0 / 5.0, 1e-7);
    other[0].x = 2.0f + 1.0f / 0.2126f;  // a lux of red more, and no difference of the others
    other[0].y = other[0].z = 2.0f;
    other[1] = truth[1];
    other[1].w = 99.0f;
    EXPECT_NEAR(leaf_difference(other, truth, {1.0, 3.0}), 0.5 / 5.0, 1e-7);
    EXPECT_EQ(leaf_difference(truth, truth, {1.0, 3.0}), 0.0);
    other[0].x = std::nanf("");
    EXPECT_TRUE(std::isnan(leaf_difference(other, truth, {1.0, 3.0})));
    EXPECT_THROW(leaf_difference(other, truth, {1.0}), Error);
}

ConvergenceSetup setup_of(const Scene& scene, int steps) {
    ConvergenceSetup out{test::device().queue, scene};
    out.options.bins = 64;
    out.options.elements.requested = 800;
    out.steps = steps;
    return out;
}

const Convergence& of_a_room() {
    static const Scene scene = test::furnished_room(5);
    static const Convergence found = measure_convergence(setup_of(scene, 60));
    return found;
}

const Convergence& of_shelves() {
    static const Scene scene = test::shelves(0.6f);
    static const Convergence found = measure_convergence(setup_of(scene, 60));
    return found;
}

// Residual and error fall, and all iterations end at one solution.
TEST(Convergence, OfARoomReachesOneSolution) {
    const Convergence& found = of_a_room();
    ASSERT_EQ(found.curves.size(), 3u);
    EXPECT_LT(found.solution_residual, 1e-6);
    EXPECT_NEAR(static_cast<double>(found.leaves), 800.0, 300.0);
    for (const ConvergenceCurve& curve : found.curves) {
        EXPECT_FALSE(curve.diverged) << curve.name;
        ASSERT_EQ(curve.residuals.size(), 60u) << curve.name;
        ASSERT_EQ(curve.errors.size(), 60u) << curve.name;
        EXPECT_NEAR(curve.residuals.front(), 1.0, 1e-6) << "of what arrives first, from nothing";
        EXPECT_LT(curve.errors.back(), 0.02 * curve.errors.front()) << curve.name;
    }
    const ConvergenceCurve& symmetric = found.curves[0];
    for (std::size_t step = 1; step < 20; ++step) {
        EXPECT_LT(symmetric.residuals[step], symmetric.residuals[step - 1]) << step;
        EXPECT_LT(symmetric.errors[step], symmetric.errors[step - 1]) << step;
    }
    EXPECT_LT(symmetric.errors.back(), 1e-4);
    // What is left to change is about what changes in a step over the share that each step leaves.
    for (const std::size_t step : {10u, 20u}) {
        const double share = symmetric.residuals[step] / symmetric.residuals[step - 1];
        EXPECT_GT(symmetric.errors[step], 0.1 * symmetric.residuals[step] * share / (1.0 - share));
    }
}

// Four steps let light through, the fifth reflects, and the next one shows it: of five errors on
// end one is much less than that before.
TEST(Convergence, OfFourToOneHasStepsOfFive) {
    const ConvergenceCurve& curve = of_a_room().curves[1];
    EXPECT_EQ(curve.through_steps, 4);
    EXPECT_EQ(curve.name, "asymmetric, 4 to 1");
    for (std::size_t step = 2; step <= 30; ++step) {
        const double ratio = curve.errors[step - 1] / curve.errors[step - 2];
        if (step % 5 == 1)
            EXPECT_LT(ratio, 0.8) << step;
        else
            EXPECT_GT(ratio, 0.85) << step;
    }
}

TEST(Convergence, OfShelvesDivergesAndIsShownAsSuch) {
    const Convergence& found = of_shelves();
    const ConvergenceCurve& symmetric = found.curves[0];
    EXPECT_TRUE(symmetric.diverged);
    EXPECT_LT(symmetric.residuals.size(), 60u);
    EXPECT_EQ(symmetric.errors.size(), symmetric.residuals.size());
    EXPECT_GT(symmetric.residuals.back(),
              *std::min_element(symmetric.residuals.begin(), symmetric.residuals.end()));
    for (const std::size_t k : {1u, 2u}) {
        EXPECT_FALSE(found.curves[k].diverged);
        EXPECT_LT(found.curves[k].errors.back(), 0.1 * found.curves[k].errors.front());
    }
    EXPECT_NE(summary(found).front().find("diverges"), std::string::npos);

    const test::TempFolder out;
    const std::string why = save_convergence(found, {"clgi sweep", "1.2.3"}, out.path());
    const auto text = [&](const char* name) {
        std::ostringstream all;
        all << std::ifstream(out.path() / name).rdbuf();
        return all.str();
    };
    std::istringstream lines(text("convergence.csv"));
    std::string line;
    std::getline(lines, line);
    EXPECT_EQ(line, "iteration,step,residual,error,diverged");
    std::size_t rows = 0, given_up = 0, wanted = 0;
    for (; std::getline(lines, line); ++rows) given_up += line.back() == '1';
    for (const ConvergenceCurve& curve : found.curves) wanted += curve.residuals.size();
    EXPECT_EQ(rows, wanted);
    EXPECT_EQ(given_up, 1u);
    const auto json = nlohmann::json::parse(text("convergence.json"));
    EXPECT_EQ(json.at("curves").size(), 3u);
    EXPECT_EQ(json.at("curves").at(0).at("diverged"), true);
    EXPECT_EQ(json.at("curves").at(0).at("residuals").size(), symmetric.residuals.size());
    EXPECT_EQ(json.at("bins"), 64);
    if (!why.empty()) GTEST_SKIP() << why;
    const std::string plot = text("convergence.svg");
    for (const char* words :
         {"symmetric, diverges", "asymmetric, 4 to 1", "asymmetric, as many as it takes", "</svg>"})
        EXPECT_NE(plot.find(words), std::string::npos) << words;
    EXPECT_EQ(plot.find("4 to 1, diverges"), std::string::npos);
}

TEST(Convergence, CanBeCancelledAndNeedsLight) {
    Scene scene = test::furnished_room(5);
    ConvergenceSetup setup = setup_of(scene, 10);
    for (const double from : {0.1, 0.4}) {
        setup.progress = [&](double done) { return done < from; };
        EXPECT_THROW(measure_convergence(setup), Error) << from;
    }
    scene.lights.clear();
    EXPECT_THROW(measure_convergence(setup_of(scene, 10)), Error);
}

}  // namespace
}  // namespace clgi::lab
