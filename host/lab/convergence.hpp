// How the iterations of antiradiance come to rest, or do not, step by step.
// [Dachsbacher07, section 2.2 and figure 5]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/antiradiance.hpp>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "lab/sweep_files.hpp"

namespace clgi::lab {

struct ConvergenceSetup {
    cl::CommandQueue queue;
    const Scene& scene;
    AntiradianceOptions options;  // iteration, steps, through_steps and residual are not used
    int steps = 100;              // of each curve, at most
    Progress progress;            // false cancels
};

struct ConvergenceCurve {
    std::string name;  // "symmetric", "asymmetric, 4 to 1": steps that let light through for one
                       // that reflects
    Iteration iteration = Iteration::symmetric;
    int through_steps = 0;          // 0: as many as it takes
    bool diverged = false;          // and was given up after the last step
    std::vector<double> residuals;  // by step
    std::vector<double> errors;     // leaf_difference() to the converged solution, by step
};

struct Convergence {
    std::string scene, device;
    std::size_t triangles = 0, elements = 0, leaves = 0, links = 0;
    int bins = 0;
    // The solution that errors are against: of the asymmetric iteration.
    std::size_t solution_steps = 0;
    double solution_residual = 0.0;
    std::vector<ConvergenceCurve> curves;
};

// Root mean square of the difference of luminance over the mean luminance of the second, both
// weighted by area. Not a number where a value is none; 0 where the second is black.
double leaf_difference(const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b,
                       const std::vector<double>& areas);

// Throws what AntiradianceSolver throws, and Error when cancelled or where no light arrives.
Convergence measure_convergence(const ConvergenceSetup& setup);

// What it says in sentences.
std::vector<std::string> summary(const Convergence& convergence);

// convergence.csv: a row a step; convergence.json: the same, with device, scene and summary.
std::string convergence_csv(const Convergence& convergence);
std::string convergence_json(const Convergence& convergence, const SweepNote& note);

// convergence.csv, .json and .svg in a folder; returns a line to print when there is no plot.
std::string save_convergence(const Convergence& convergence, const SweepNote& note,
                             const std::filesystem::path& folder);

}  // namespace clgi::lab
