// Settings of second-order illumination for a frame time or an error: fronts of time against error,
// measured once, scaled by pictures of this scene on this device (docs/plan.md).
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/advanced/kit/progress.hpp>
#include <clgi/device_scene.hpp>
#include <clgi/plan.hpp>
#include <clgi/second_order.hpp>
#include <optional>

namespace clgi {

// The options that tuning sets.
struct SecondOrderSettings {
    int vpls = 0;           // EmitterOptions::vpls
    int negative_vpls = 0;  // the others as in SecondOrderOptions
    int low_resolution_step = 4;
    float discontinuity_threshold = 0.0f;  // infinity: no pixel is refined
};
CLGI_API SecondOrderOptions with_settings(SecondOrderOptions options,
                                          const SecondOrderSettings& settings);

// What tuning is to reach; at least one of the two. With both, the error counts as far as the time
// allows.
struct TuningTarget {
    // Median time of a frame, ms above 0: to be met, not only to stay under. A frame lasts, on the
    // host's clock, from render() until the queue is empty, shadow maps and G-buffer included.
    std::optional<double> frame_ms;
    // Root mean squared difference of luminance from the converged picture over the mean luminance
    // of that, above 0. The converged picture has the same effects, SecondOrderTuning's
    // converged_vpls, every pixel in full, and is the mean of a few replicates.
    std::optional<double> error;
};

struct SecondOrderTuning {
    static constexpr int fewest_vpls = 16, most_vpls = 1 << 20;  // that are tried
    static constexpr int converged_vpls = 50000;

    SecondOrderSettings settings;
    double frame_ms = 0.0;        // of the last pictures with these settings, median
    std::optional<double> error;  // estimated; none if only a time was requested
    // Whether the target was reached. A time is met within a tenth, an error with a margin of 15 %.
    bool meets_time = true, meets_error = true;
    double milliseconds = 0.0;  // that tuning took
};

// Renders pictures of different settings, and leaves the solver at the settings found. Its other
// options stay as they are; if it has no negative VPLs, the settings have none. queue, scene: the
// solver's. Waits, some 0.3 s for each setting that is timed, and with an error for seconds,
// because it renders the converged picture. Returns nothing if progress cancelled. The solver then
// has the options that it had, as after an exception. Throws Error for a request out of range, or
// where the solver renders no indirect light; otherwise what the solver throws.
CLGI_API std::optional<SecondOrderTuning> tune_second_order(
    const cl::CommandQueue& queue, const DeviceScene& scene, SecondOrderSolver& solver,
    const Camera& camera, const TuningTarget& request, const Progress& progress = nullptr);

// Tunes the renderer of a plan that chose second-order illumination for a time: settings whose time
// was measured replace those whose time was predicted. The plan then has them with the measured
// time; its error stays that of the predicted settings. Does nothing for other plans. Waits. False
// if progress cancelled.
CLGI_API bool tune(const cl::CommandQueue& queue, Renderer& renderer, Plan& plan,
                   const Camera& camera, const Progress& progress = nullptr);

}  // namespace clgi
