// From a time or an error to settings: a front, scaled by what pictures of this scene on this
// device took and showed.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/tuning.hpp>
#include <optional>
#include <vector>

#include "plan/second_order_fronts.hpp"

namespace clgi {

// A point of a front.
struct FrontPoint {
    std::size_t refinement = 0;
    int vpls = SecondOrderTuning::fewest_vpls;
};

// time = fixed + VPLs * rate of the refinement.
struct FrameTimeModel {
    double fixed_ms = 0.0;           // next to no VPLs: views, pixels, direct light
    std::vector<double> ms_per_vpl;  // by refinement
};

// error^2 = sampling^2 + what interpolation adds, relative to the mean of the picture. It may add
// less than nothing: it evens out some of the noise of few VPLs.
struct FrameErrorModel {
    struct Sample {
        int vpls;
        double error;
    };
    std::vector<Sample> sampling;  // of pictures lit in full, by rising numbers of VPLs
    std::vector<double> added;     // by refinement, a square
};

CLGI_API SecondOrderSettings settings_of(const SecondOrderFront& front, const FrontPoint& point);

double predicted_ms(const FrameTimeModel& model, const FrontPoint& point);
double predicted_error(const FrameErrorModel& model, const FrontPoint& point);

// The finest refinement that pays with as many VPLs as the time buys there. The cheapest point of
// all where even that is too dear. A longer time never gives a coarser refinement or a quicker
// picture.
FrontPoint within_time(const SecondOrderFront& front, const FrameTimeModel& model, double ms);

// The cheapest point whose predicted error is at most `error`, of the numbers of VPLs that were
// sampled; none where no such point is.
std::optional<FrontPoint> within_error(const FrameTimeModel& time, const FrameErrorModel& model,
                                       double error);

// The sampled point of the least predicted error, the cheapest of those within a hundredth of it.
FrontPoint most_accurate(const FrameTimeModel& time, const FrameErrorModel& model);

}  // namespace clgi
