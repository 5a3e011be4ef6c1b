// Settings of a sweep measured in turn, so that other load on the machine meets all of them alike.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/progress.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "lab/sweep.hpp"
#include "lab/sweep_run.hpp"

namespace clgi::lab {

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

// Lists of settings with more than their names.
template <typename Setting>
std::vector<SweepSetting> names_of(const std::vector<Setting>& settings) {
    return {settings.begin(), settings.end()};
}

}  // namespace clgi::lab
