// SPDX-License-Identifier: MIT
#include "plan/tuning_models.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clgi {
namespace {

// Placing a negative VPL costs a look at every VPL: beyond this many the square of the count would
// rule the frame time.
constexpr int most_negative_vpls = 4096;

}  // namespace

SecondOrderSettings settings_of(const SecondOrderFront& front, const FrontPoint& point) {
    const Refinement& refinement = front.refinements[point.refinement];
    const int negative = static_cast<int>(std::lround(front.negative_share * point.vpls));
    return {point.vpls, std::clamp(negative, 1, most_negative_vpls), refinement.step,
            refinement.threshold};
}

SecondOrderOptions with_settings(SecondOrderOptions options, const SecondOrderSettings& settings) {
    options.emitters.vpls = settings.vpls;
    options.negative_vpls = settings.negative_vpls;
    options.low_resolution_step = settings.low_resolution_step;
    options.discontinuity_threshold = settings.discontinuity_threshold;
    return options;
}

double predicted_ms(const FrameTimeModel& model, const FrontPoint& point) {
    return model.fixed_ms + model.ms_per_vpl[point.refinement] * point.vpls;
}

double predicted_error(const FrameErrorModel& model, const FrontPoint& point) {
    const auto at = std::lower_bound(
        model.sampling.begin(), model.sampling.end(), point.vpls,
        [](const FrameErrorModel::Sample& sample, int vpls) { return sample.vpls < vpls; });
    const double error = at == model.sampling.end() ? model.sampling.back().error : at->error;
    const double square = error * error;
    return std::sqrt(std::max(square + model.added[point.refinement], 0.25 * square));
}

FrontPoint within_time(const SecondOrderFront& front, const FrameTimeModel& model, double ms) {
    for (std::size_t i = front.refinements.size(); i-- > 0;) {
        const double vpls = (ms - model.fixed_ms) / model.ms_per_vpl[i];
        if (vpls >= front.refinements[i].from_vpls)
            return {i, static_cast<int>(std::min<double>(vpls, SecondOrderTuning::most_vpls))};
    }
    return {};
}

std::optional<FrontPoint> within_error(const FrameTimeModel& time, const FrameErrorModel& model,
                                       double error) {
    std::optional<FrontPoint> best;
    for (std::size_t i = 0; i < model.added.size(); ++i)
        for (const FrameErrorModel::Sample& sample : model.sampling) {
            const FrontPoint point{i, sample.vpls};
            if (predicted_error(model, point) > error) continue;
            if (!best || predicted_ms(time, point) < predicted_ms(time, *best)) best = point;
        }
    return best;
}

FrontPoint most_accurate(const FrameTimeModel& time, const FrameErrorModel& model) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < model.added.size(); ++i)
        for (const FrameErrorModel::Sample& sample : model.sampling)
            least = std::min(least, predicted_error(model, {i, sample.vpls}));
    return within_error(time, model, 1.01 * least).value_or(FrontPoint{});
}

}  // namespace clgi
