// A few frames that tell what settings cost and how far off they are, on this scene and device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <functional>
#include <vector>

#include "report/settings_model.hpp"

namespace clgi::report {

class Probe {
public:
    Probe(const cl::CommandQueue& queue, SecondOrderSolver& solver, const Camera& camera,
          const Front& front, std::function<bool()> go_on);

    // Median time of some frames, after one that warms up.
    double frame_ms(const Choice& choice);

    // Frames with next to no lights, and with some at every rung.
    CostModel cost();

    // Errors of pictures lit in full, up to the number of lights that takes them below `error`.
    // These pictures, and the converged one, have no more pixels than settle a mean.
    std::vector<ErrorModel::Sample> sampling(double error);

    // The error of the very picture that the choice gives.
    double error(const Choice& choice);

private:
    std::vector<double> frame_times(const Choice& choice);
    std::vector<double> luminance(const SecondOrderOptions& options);
    SecondOrderOptions in_full(const SecondOrderOptions& size, int lights) const;
    void converge();
    void check() const;

    const cl::CommandQueue& queue_;
    SecondOrderSolver& solver_;
    const Camera& camera_;
    const Front& front_;
    SecondOrderOptions options_;  // as the solver came
    SecondOrderOptions small_;    // the same at fewer pixels
    std::function<bool()> go_on_;
    // Luminances, the converged picture's at fewer pixels; empty: not rendered yet.
    std::vector<double> converged_, nearly_, nearly_small_;
    double level_ = 0.0;               // mean of the converged picture
    double converged_variance_ = 0.0;  // mean, of what is left of noise in it
};

}  // namespace clgi::report
