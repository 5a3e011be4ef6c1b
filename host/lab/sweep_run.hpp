// What every sweep does: lists of settings, measured in turn so that other load on the machine
// meets all of them alike; progress in parts, errors of a result, fronts.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <clgi/advanced/kit/progress.hpp>
#include <clgi/reference.hpp>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/mask.hpp"
#include "lab/sweep.hpp"

namespace clgi::lab {

// ---- settings -----------------------------------------------------------------------------------

// Settings by series: the knob that is varied alone, from the least accurate value on, or "grid".
template <typename Setting>
class SettingList {
public:
    // name: tells method and knobs of a setting from its options.
    SettingList(bool quick, void (*name)(Setting&)) : quick_(quick), name_(name) {}

    void add(const std::string& series, Setting one) {
        one.series = series;
        name_(one);
        settings.push_back(std::move(one));
    }

    // base with one knob at each of the values, equal ones behind each other once. set(setting,
    // value) turns the knob.
    template <typename Value, typename Set>
    void vary(const std::string& series, const Setting& base, std::vector<Value> values,
              const Set& set) {
        values.erase(std::unique(values.begin(), values.end()), values.end());
        for (const Value& value : values) {
            Setting one = base;
            set(one, value);
            add(series, std::move(one));
        }
    }
    template <typename Set>
    void vary(const std::string& series, const Setting& base, const std::vector<int>& quick,
              const std::vector<int>& full, const Set& set) {
        vary(series, base, quick_ ? quick : full, set);
    }

    std::vector<Setting> settings;

private:
    bool quick_;
    void (*name_)(Setting&);
};

// ---- progress -----------------------------------------------------------------------------------

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

// ---- settings in turn ---------------------------------------------------------------------------

// What measuring a setting once gave.
struct Measured {
    std::vector<double> milliseconds;  // of frames or bakes, one at least
    std::optional<double> once;        // milliseconds before all frames
    std::size_t non_finite = 0;        // of SweepPoint's results
    bool again = true;                 // in further rounds; false: noise is small beside such times
};

struct Turns {
    int rounds = 3;
    // Measures a setting. result: its picture and errors go there, in the first round; later null.
    // Returns early once `part`, which takes the share of this setting that is done, says false.
    std::function<Measured(std::size_t setting, SweepPoint* result, const Progress& part)> measure;
    // What a setting costs, in any unit; none: all alike.
    std::function<double(std::size_t setting)> work;
    // Whether two settings are the same, and measured once, whatever series they are in; none:
    // those with the same method and knobs.
    std::function<bool(std::size_t a, std::size_t b)> same;
};

// A point for each setting, in their order, with the medians of all rounds. Throws what measure
// throws, and Error when progress cancelled. non_finite: what results held is added to it.
std::vector<SweepPoint> measure_in_turn(const std::vector<SweepSetting>& settings,
                                        const Turns& turns, const SweepProgress& progress,
                                        std::size_t& non_finite);

// Adds points for settings with more than their names.
template <typename Setting>
void add_points(Sweep& sweep, const std::vector<Setting>& settings, const Turns& turns,
                const SweepProgress& progress) {
    for (SweepPoint& point :
         measure_in_turn({settings.begin(), settings.end()}, turns, progress, sweep.non_finite))
        sweep.points.push_back(std::move(point));
}

// ---- truths and results -------------------------------------------------------------------------

// A sweep without results yet, of a setup's scene and device.
Sweep sweep_of(SweepOf of, const SweepSetup& setup);

// Adds a truth. picture: without channels where its making was cancelled, which throws Error.
void add_truth(Sweep& sweep, const std::string& name, const std::string& effects,
               io::Image picture);

// Errors and energy of point.picture. mask: the pixels that count; null: all.
void judge(SweepPoint& point, const std::vector<SweepTruth>& truths, const Mask* mask = nullptr);

// The path tracer's options for a truth; another seed for what is compared with it.
reference::Options tracing(const std::string& effects, int samples, std::uint64_t seed = 1);
inline constexpr std::uint64_t baseline_seed = 77;

// Adds a point of the path tracer for the truth.
void add_traced(Sweep& sweep, const std::string& truth, int samples, double seconds,
                io::Image picture, const Mask* mask = nullptr);

// Adds points of the path tracer for the truth: irradiance at places with 1, 4, 16 and more
// samples. image_of: what was found as a picture. counted: the pixels that count.
void trace_irradiance(Sweep& sweep, const SweepSetup& setup, const SweepTruth& truth,
                      const reference::PathTracer& tracer,
                      const std::vector<reference::Place>& places,
                      const std::function<io::Image(const reference::Irradiance&)>& image_of,
                      const Mask& counted, const SweepProgress& progress);

// ---- fronts of error against milliseconds: what is worth its time -------------------------------

struct Cost {
    double milliseconds;
    double error;
};

// Indices of the points that no other beats in both, by time. Points of equal cost: the first.
std::vector<std::size_t> pareto_front(const std::vector<Cost>& points);

// The time at which a curve reaches an error: along straight lines in log-log, beyond its last
// point by the root of time, as unbiased noise falls. Nothing for an empty curve.
// curve: by time, errors above 0.
std::optional<double> time_to_reach(const std::vector<Cost>& curve, double error);

// Marks the points on the Pareto front of each method, against each truth; none that were given up.
// A point of the path tracer belongs to the truth that it is named after.
void mark_fronts(Sweep& sweep);

}  // namespace clgi::lab
