// A few pictures that tell what settings cost and how far off they are, on this scene and device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/progress.hpp>
#include <clgi/second_order.hpp>
#include <vector>

#include "plan/tuning_models.hpp"

namespace clgi {

class TrialFrames {
public:
    struct Cancelled {};  // thrown before a picture if progress says so

    TrialFrames(const cl::CommandQueue& queue, SecondOrderSolver& solver, const Camera& camera,
                const SecondOrderFront& front, const Progress& progress);

    // Of a point, with the solver's options: without negative VPLs if those have none.
    SecondOrderSettings settings(const FrontPoint& point) const;

    // Median time of some frames, after one that warms up.
    double frame_ms(const FrontPoint& point);

    // Frames with next to no VPLs, and with some at every refinement.
    FrameTimeModel time_model();

    // Errors of pictures lit in full, up to the number of VPLs that takes them below `error`.
    // These pictures, and the converged one, have no more pixels than settle a mean.
    std::vector<FrameErrorModel::Sample> sampling(double error);

    // The error of the very picture that the point gives.
    double error(const FrontPoint& point);

    // The next pictures take progress from where it is to `share`; `pictures` of them at most.
    void next_part(double share, int pictures);

private:
    std::vector<double> frame_times(const FrontPoint& point);
    std::vector<double> luminance(const SecondOrderOptions& options);
    SecondOrderOptions in_full(const SecondOrderOptions& size, int vpls) const;
    void converge();
    void report();

    const cl::CommandQueue& queue_;
    SecondOrderSolver& solver_;
    const Camera& camera_;
    const SecondOrderFront& front_;
    SecondOrderOptions options_;  // as the solver came
    SecondOrderOptions small_;    // the same at fewer pixels
    const Progress& progress_;
    double done_ = 0.0, until_ = 0.0, step_ = 0.0;  // progress
    // Luminances, the converged picture's at fewer pixels; empty: not rendered yet.
    std::vector<double> converged_, nearly_, nearly_small_;
    double level_ = 0.0;               // mean of the converged picture
    double converged_variance_ = 0.0;  // mean, of what is left of noise in it
};

// Most pictures that a setting is timed by, and that sampling() renders with the converged ones.
inline constexpr int most_timed = 9;
inline constexpr int most_sampled = 32;

}  // namespace clgi
