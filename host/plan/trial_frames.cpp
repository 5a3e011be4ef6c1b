// SPDX-License-Identifier: MIT
#include "plan/trial_frames.hpp"

#include <algorithm>
#include <cmath>

#include "core/opencl/timing.hpp"
#include "plan/picture_luminance.hpp"
#include "plan/replicate_mean.hpp"

namespace clgi {
namespace {

constexpr int timed_vpls = 512;            // enough to rise above the fixed costs
constexpr double enough_ms = 300.0;        // frames that a median is taken over
constexpr double pixels_enough = 20000.0;  // to settle a mean
constexpr int converged_replicates = 4;
constexpr int converged_area_samples = 64;
constexpr int nearly_converged_vpls = 32768;
// Between one number of VPLs and the next that is tried.
constexpr double vpls_step = 1.41421356;

SecondOrderOptions smaller(SecondOrderOptions options) {
    const double pixels = static_cast<double>(options.width) * options.height;
    const double scale = std::min(1.0, std::sqrt(pixels_enough / pixels));
    options.width = std::max(1, static_cast<int>(std::lround(options.width * scale)));
    options.height = std::max(1, static_cast<int>(std::lround(options.height * scale)));
    return options;
}

}  // namespace

TrialFrames::TrialFrames(const cl::CommandQueue& queue, SecondOrderSolver& solver,
                         const Camera& camera, const SecondOrderFront& front,
                         const Progress& progress)
    : queue_(queue),
      solver_(solver),
      camera_(camera),
      front_(front),
      options_(solver.options()),
      small_(smaller(options_)),
      progress_(progress) {}

void TrialFrames::next_part(double share, int pictures) {
    done_ = until_;
    until_ = share;
    step_ = (until_ - done_) / pictures;
}

void TrialFrames::report() {
    if (progress_ && !progress_(done_)) throw Cancelled();
    done_ = std::min(done_ + step_, until_);
}

SecondOrderSettings TrialFrames::settings(const FrontPoint& point) const {
    SecondOrderSettings out = settings_of(front_, point);
    if (options_.negative_vpls == 0) out.negative_vpls = 0;
    return out;
}

std::vector<double> TrialFrames::luminance(const SecondOrderOptions& options) {
    report();
    solver_.reconfigure(options);
    return picture_luminance(queue_, solver_, solver_.render(camera_));
}

std::vector<double> TrialFrames::frame_times(const FrontPoint& point) {
    solver_.reconfigure(with_settings(options_, settings(point)));
    const auto frame = [&] { return timing::time_frame(queue_, [&] { solver_.render(camera_); }); };
    report();
    const int frames = std::clamp(static_cast<int>(enough_ms / frame()), 3, most_timed);
    std::vector<double> times;
    for (int k = 0; k < frames; ++k) {
        report();
        times.push_back(frame());
    }
    return times;
}

double TrialFrames::frame_ms(const FrontPoint& point) {
    return timing::spread(frame_times(point)).median;
}

FrameTimeModel TrialFrames::time_model() {
    // Shares of one and the same machine: its least times compare, its medians only when it idles.
    FrameTimeModel out;
    out.fixed_ms = timing::spread(frame_times({0, SecondOrderTuning::fewest_vpls})).min;
    double least = 0.0;
    for (std::size_t i = 0; i < front_.refinements.size(); ++i) {
        const double ms = timing::spread(frame_times({i, timed_vpls})).min;
        // A finer refinement is never the cheaper one.
        least =
            std::max({least, (ms - out.fixed_ms) / timed_vpls, 1e-3 * out.fixed_ms / timed_vpls});
        out.ms_per_vpl.push_back(least);
    }
    return out;
}

SecondOrderOptions TrialFrames::in_full(const SecondOrderOptions& size, int vpls) const {
    SecondOrderOptions out = with_settings(size, settings({0, vpls}));
    out.low_resolution_step = 1;
    return out;
}

void TrialFrames::converge() {
    SecondOrderOptions options = in_full(small_, SecondOrderTuning::converged_vpls);
    options.emitters.area_samples = std::max(options.emitters.area_samples, converged_area_samples);
    ReplicateMean replicates;
    for (int k = 1; k <= converged_replicates; ++k) {
        options.emitters.replicate = static_cast<std::uint32_t>(k);
        replicates.add(luminance(options));
    }
    converged_ = replicates.mean();
    level_ = mean(converged_);
    converged_variance_ = mean(replicates.variance());

    if (small_.width == options_.width && small_.height == options_.height) {
        nearly_ = nearly_small_ = converged_;
        return;
    }
    const auto nearly = [&](const SecondOrderOptions& size) {
        SecondOrderOptions fewer = in_full(size, nearly_converged_vpls);
        fewer.emitters.replicate = converged_replicates + 1;
        return luminance(fewer);
    };
    nearly_ = nearly(options_);
    nearly_small_ = nearly(small_);
}

// The pixels that err most are few: all are looked at, against a picture of many VPLs. How much
// that differs from the converged one is found at fewer pixels, from pictures lit in full:
//
//   |P - C|^2 = |P - M|^2 + (|F - C|^2 - |F - M|^2)
//
// P: the picture, F: lit in full with as many VPLs, M: of many VPLs, C: converged.
double TrialFrames::error(const FrontPoint& point) {
    if (converged_.empty()) converge();
    if (!(level_ > 0.0)) return 0.0;
    const std::vector<double> picture = luminance(with_settings(options_, settings(point)));
    const double apart = mean_square_difference(picture, nearly_);
    double further = -converged_variance_;
    if (nearly_ != converged_) {
        const std::vector<double> full = luminance(in_full(small_, point.vpls));
        further +=
            mean_square_difference(full, converged_) - mean_square_difference(full, nearly_small_);
    }
    return std::sqrt(std::max(apart + further, 0.25 * apart)) / level_;
}

std::vector<FrameErrorModel::Sample> TrialFrames::sampling(double error) {
    if (converged_.empty()) converge();
    std::vector<FrameErrorModel::Sample> out;
    for (double vpls = SecondOrderTuning::fewest_vpls; vpls < SecondOrderTuning::converged_vpls;
         vpls *= vpls_step) {
        const int count = static_cast<int>(std::lround(vpls));
        const double apart = mean_square_difference(luminance(in_full(small_, count)), converged_);
        // The converged picture's own noise is in the difference, not in the error.
        const double square = std::max(apart - converged_variance_, 0.25 * apart);
        out.push_back({count, level_ > 0.0 ? std::sqrt(square) / level_ : 0.0});
        if (out.back().error < 0.7 * error) break;
    }
    return out;
}

}  // namespace clgi
