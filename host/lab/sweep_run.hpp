// What every sweep does: progress in parts, errors of a result, fronts.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "lab/mask.hpp"
#include "lab/sweep.hpp"

namespace clgi::lab {

// Progress through the parts of a sweep.
class SweepProgress {
public:
    explicit SweepProgress(const std::function<bool(double)>& progress) : progress_(progress) {}

    // Begins the part of the whole from `from` to `from + span`.
    void part(double from, double span);
    // The share of the part that is done. False: cancelled.
    bool goes_on(double share) const;
    // Throws Error if cancelled.
    void report(double share) const;

private:
    const std::function<bool(double)>& progress_;
    double from_ = 0.0, span_ = 1.0;
};

[[noreturn]] void throw_cancelled();

// Errors and energy of point.picture. mask: the pixels that count; null: all.
void judge(SweepPoint& point, const std::vector<SweepTruth>& truths, const Mask* mask = nullptr);

// A sweep without results yet, of a setup's scene and device.
Sweep sweep_of(SweepOf of, const SweepSetup& setup);

// The path tracer's options for a truth; another seed for what is compared with it.
reference::Options tracing(const std::string& effects, int samples, std::uint64_t seed = 1);

// Adds points of the path tracer for the truth: irradiance at places with 1, 4, 16 and more
// samples. image_of: what was found as a picture. counted: the pixels that count.
void trace_irradiance(Sweep& sweep, const SweepSetup& setup, const SweepTruth& truth,
                      const reference::PathTracer& tracer,
                      const std::vector<reference::Place>& places,
                      const std::function<io::Image(const reference::Irradiance&)>& image_of,
                      const Mask& counted, const SweepProgress& progress);

// Marks the points on the Pareto front of each method, against each truth; none that were given up.
// A point of the path tracer belongs to the truth that it is named after.
void mark_fronts(Sweep& sweep);

}  // namespace clgi::lab
