// SPDX-License-Identifier: MIT
#include "report/settings_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace clgi::report {
namespace {

// Placing a negative light costs a look at every indirect light: beyond this many the square of
// the count would rule the frame time.
constexpr int most_negative_lights = 4096;

}  // namespace

Settings settings_of(const Front& front, const Choice& choice) {
    const Rung& rung = front.rungs[choice.rung];
    const int negative = static_cast<int>(std::lround(front.negative_share * choice.lights));
    return {choice.lights, std::clamp(negative, 1, most_negative_lights), rung.step,
            rung.threshold};
}

SecondOrderOptions applied(SecondOrderOptions options, const Settings& settings) {
    options.emitters.vpls = settings.lights;
    options.negative_vpls = settings.negative_vpls;
    options.low_resolution_step = settings.step;
    options.discontinuity_threshold = settings.threshold;
    return options;
}

double predicted_ms(const CostModel& model, const Choice& choice) {
    return model.fixed_ms + model.ms_per_light[choice.rung] * choice.lights;
}

double predicted_error(const ErrorModel& model, const Choice& choice) {
    const auto at = std::lower_bound(
        model.sampling.begin(), model.sampling.end(), choice.lights,
        [](const ErrorModel::Sample& sample, int lights) { return sample.lights < lights; });
    const double error = at == model.sampling.end() ? model.sampling.back().error : at->error;
    const double square = error * error;
    return std::sqrt(std::max(square + model.added[choice.rung], 0.25 * square));
}

Choice within_budget(const Front& front, const CostModel& model, double budget_ms) {
    for (std::size_t rung = front.rungs.size(); rung-- > 0;) {
        const double lights = (budget_ms - model.fixed_ms) / model.ms_per_light[rung];
        if (lights >= front.rungs[rung].from_lights)
            return {rung, static_cast<int>(std::min<double>(lights, most_lights))};
    }
    return {};
}

std::optional<Choice> within_error(const CostModel& cost, const ErrorModel& model, double error) {
    std::optional<Choice> best;
    for (std::size_t rung = 0; rung < model.added.size(); ++rung)
        for (const ErrorModel::Sample& sample : model.sampling) {
            const Choice choice{rung, sample.lights};
            if (predicted_error(model, choice) > error) continue;
            if (!best || predicted_ms(cost, choice) < predicted_ms(cost, *best)) best = choice;
        }
    return best;
}

Choice most_accurate(const CostModel& cost, const ErrorModel& model) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t rung = 0; rung < model.added.size(); ++rung)
        for (const ErrorModel::Sample& sample : model.sampling)
            least = std::min(least, predicted_error(model, {rung, sample.lights}));
    return within_error(cost, model, 1.01 * least).value_or(Choice{});
}

}  // namespace clgi::report
