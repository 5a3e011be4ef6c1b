// From a time or an error to settings: a front of rungs, scaled by what a probe of this scene on
// this device found.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>
#include <optional>
#include <vector>

#include "report/fronts.hpp"

namespace clgi::report {

constexpr int fewest_lights = 16;
constexpr int most_lights = 1 << 20;

struct Settings {
    int lights = 0;
    int negative_vpls = 0;
    int step = 4;
    float threshold = 0.0f;
};

struct Choice {
    std::size_t rung = 0;
    int lights = fewest_lights;
};

// time = fixed + lights * rate of the rung.
struct CostModel {
    double fixed_ms = 0.0;             // next to no lights: views, pixels, direct light
    std::vector<double> ms_per_light;  // by rung
};

// error^2 = sampling^2 + what interpolation adds, relative to the mean of the picture. It may add
// less than nothing: it evens out some of the noise of few lights.
struct ErrorModel {
    struct Sample {
        int lights;
        double error;
    };
    std::vector<Sample> sampling;  // of pictures lit in full, by rising numbers of lights
    std::vector<double> added;     // by rung, a square
};

Settings settings_of(const Front& front, const Choice& choice);
SecondOrderOptions applied(SecondOrderOptions options, const Settings& settings);

double predicted_ms(const CostModel& model, const Choice& choice);
double predicted_error(const ErrorModel& model, const Choice& choice);

// The finest rung that pays with as many lights as the budget buys there. The cheapest choice of
// all where even that is too dear. A larger budget never gives a coarser rung or a shorter time.
Choice within_budget(const Front& front, const CostModel& model, double budget_ms);

// The cheapest choice whose predicted error is at most `error`, of the numbers of lights that were
// sampled; none where no such choice is.
std::optional<Choice> within_error(const CostModel& cost, const ErrorModel& model, double error);

// The sampled choice of the least predicted error, the cheapest of those within a hundredth of it.
Choice most_accurate(const CostModel& cost, const ErrorModel& model);

}  // namespace clgi::report
