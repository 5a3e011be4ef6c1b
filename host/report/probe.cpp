// SPDX-License-Identifier: MIT
#include "report/probe.hpp"
#include "report/luminance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "report/ask.hpp"
#include "report/preview.hpp"
#include "report/timing.hpp"

namespace clgi::report {
namespace {

constexpr int probe_lights = 512;          // enough to rise above the fixed costs
constexpr double enough_ms = 300.0;        // frames that a median is taken over
constexpr double pixels_enough = 20000.0;  // to settle a mean
constexpr int converged_replicates = 4;
constexpr int converged_area_samples = 64;
constexpr int nearly_converged_lights = 32768;
// Between one number of lights and the next that is tried.
constexpr double lights_step = 1.41421356;

double mean(const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

SecondOrderOptions smaller(SecondOrderOptions options) {
    const double pixels = static_cast<double>(options.width) * options.height;
    const double scale = std::min(1.0, std::sqrt(pixels_enough / pixels));
    options.width = std::max(1, static_cast<int>(std::lround(options.width * scale)));
    options.height = std::max(1, static_cast<int>(std::lround(options.height * scale)));
    return options;
}

double squared_difference(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return a.empty() ? 0.0 : sum / static_cast<double>(a.size());
}

}  // namespace

Probe::Probe(const cl::CommandQueue& queue, SecondOrderSolver& solver, const Camera& camera,
             const Front& front, std::function<bool()> go_on)
    : queue_(queue),
      solver_(solver),
      camera_(camera),
      front_(front),
      options_(solver.options()),
      small_(smaller(options_)),
      go_on_(std::move(go_on)) {}

void Probe::check() const {
    if (go_on_ && !go_on_()) throw Cancelled();
}

std::vector<double> Probe::luminance(const SecondOrderOptions& options) {
    check();
    solver_.reconfigure(options);
    solver_.render(camera_);
    return luminance_of(radiance_picture(queue_, solver_));
}

std::vector<double> Probe::frame_times(const Choice& choice) {
    solver_.reconfigure(applied(options_, settings_of(front_, choice)));
    const double first = time_frame(solver_, queue_, camera_);
    const int frames = std::clamp(static_cast<int>(enough_ms / first), 3, 9);
    std::vector<double> times;
    for (int frame = 0; frame < frames; ++frame) {
        check();
        times.push_back(time_frame(solver_, queue_, camera_));
    }
    return times;
}

double Probe::frame_ms(const Choice& choice) { return spread(frame_times(choice)).median; }

CostModel Probe::cost() {
    // Shares of one and the same machine: its least times compare, its medians only when it idles.
    CostModel out;
    out.fixed_ms = spread(frame_times({0, fewest_lights})).min;
    double least = 0.0;
    for (std::size_t rung = 0; rung < front_.rungs.size(); ++rung) {
        const double ms = spread(frame_times({rung, probe_lights})).min;
        // A finer rung is never the cheaper one.
        least = std::max(
            {least, (ms - out.fixed_ms) / probe_lights, 1e-3 * out.fixed_ms / probe_lights});
        out.ms_per_light.push_back(least);
    }
    return out;
}

SecondOrderOptions Probe::in_full(const SecondOrderOptions& size, int lights) const {
    SecondOrderOptions out = applied(size, settings_of(front_, {0, lights}));
    out.low_resolution_step = 1;
    return out;
}

void Probe::converge() {
    SecondOrderOptions options = in_full(small_, converged_lights);
    options.emitters.area_samples = std::max(options.emitters.area_samples, converged_area_samples);
    std::vector<double> square;
    for (int k = 1; k <= converged_replicates; ++k) {
        options.emitters.replicate = static_cast<std::uint32_t>(k);
        const std::vector<double> y = luminance(options);
        converged_.resize(y.size());
        square.resize(y.size());
        for (std::size_t i = 0; i < y.size(); ++i) {
            converged_[i] += y[i] / converged_replicates;
            square[i] += y[i] * y[i] / converged_replicates;
        }
    }
    level_ = mean(converged_);
    for (std::size_t i = 0; i < square.size(); ++i)
        square[i] = std::max(square[i] - converged_[i] * converged_[i], 0.0);
    converged_variance_ = mean(square) / (converged_replicates - 1);

    if (small_.width == options_.width && small_.height == options_.height) {
        nearly_ = nearly_small_ = converged_;
        return;
    }
    const auto nearly = [&](const SecondOrderOptions& size) {
        SecondOrderOptions fewer = in_full(size, nearly_converged_lights);
        fewer.emitters.replicate = converged_replicates + 1;
        return luminance(fewer);
    };
    nearly_ = nearly(options_);
    nearly_small_ = nearly(small_);
}

// The pixels that err most are few: all are looked at, against a picture of many lights. How much
// that differs from the converged one is found at fewer pixels, from pictures lit in full:
//
//   |P - C|^2 = |P - M|^2 + (|F - C|^2 - |F - M|^2)
//
// P: the picture, F: lit in full with as many lights, M: of many lights, C: converged.
double Probe::error(const Choice& choice) {
    if (converged_.empty()) converge();
    if (!(level_ > 0.0)) return 0.0;
    const std::vector<double> picture = luminance(applied(options_, settings_of(front_, choice)));
    const double apart = squared_difference(picture, nearly_);
    double further = -converged_variance_;
    if (nearly_ != converged_) {
        const std::vector<double> full = luminance(in_full(small_, choice.lights));
        further += squared_difference(full, converged_) - squared_difference(full, nearly_small_);
    }
    return std::sqrt(std::max(apart + further, 0.25 * apart)) / level_;
}

std::vector<ErrorModel::Sample> Probe::sampling(double error) {
    if (converged_.empty()) converge();
    std::vector<ErrorModel::Sample> out;
    for (double lights = fewest_lights; lights < converged_lights; lights *= lights_step) {
        const int count = static_cast<int>(std::lround(lights));
        const double apart = squared_difference(luminance(in_full(small_, count)), converged_);
        // The converged picture's own noise is in the difference, not in the error.
        const double square = std::max(apart - converged_variance_, 0.25 * apart);
        out.push_back({count, level_ > 0.0 ? std::sqrt(square) / level_ : 0.0});
        if (out.back().error < 0.7 * error) break;
    }
    return out;
}

}  // namespace clgi::report
