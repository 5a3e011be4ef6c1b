// SPDX-License-Identifier: MIT
#include "lab/sweep_turns.hpp"

#include <cstdint>

#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

// For each setting the first that is the same.
std::vector<std::size_t> first_of_each(const std::vector<SweepSetting>& settings,
                                       const Turns& turns) {
    const auto same = [&](std::size_t a, std::size_t b) {
        return turns.same ? turns.same(a, b)
                          : settings[a].method == settings[b].method &&
                                settings[a].knobs == settings[b].knobs;
    };
    std::vector<std::size_t> out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        std::size_t k = 0;
        while (k < i && !(out[k] == k && same(k, i))) ++k;
        out.push_back(k);
    }
    return out;
}

}  // namespace

std::vector<SweepPoint> measure_in_turn(const std::vector<SweepSetting>& settings,
                                        const Turns& turns, const SweepProgress& progress,
                                        std::size_t& non_finite) {
    const std::vector<std::size_t> first = first_of_each(settings, turns);
    const auto work = [&](std::size_t i) { return turns.work ? turns.work(i) : 1.0; };
    double all = 0.0, done = 0.0;
    for (std::size_t i = 0; i < settings.size(); ++i)
        if (first[i] == i) all += turns.rounds * work(i);
    std::vector<SweepPoint> results(settings.size());
    std::vector<std::vector<double>> times(settings.size()), once(settings.size());
    std::vector<std::uint8_t> again(settings.size(), 1);
    for (int round = 0; round < turns.rounds; ++round)
        for (std::size_t i = 0; i < settings.size(); ++i) {
            if (first[i] != i) continue;
            const double share = work(i) / all;
            progress.report(done);
            if (again[i]) {
                const Measured found = turns.measure(
                    i, round == 0 ? &results[i] : nullptr,
                    [&](double part) { return progress.goes_on(done + share * part); });
                progress.report(done);
                times[i].insert(times[i].end(), found.milliseconds.begin(),
                                found.milliseconds.end());
                if (found.once) once[i].push_back(*found.once);
                again[i] = found.again ? 1 : 0;
                if (round == 0) non_finite += found.non_finite;
            }
            done += share;
        }
    std::vector<SweepPoint> out;
    for (std::size_t i = 0; i < settings.size(); ++i) {
        SweepPoint point = results[first[i]];
        static_cast<SweepSetting&>(point) = settings[i];
        point.milliseconds = spread(times[first[i]]).median;
        if (!once[first[i]].empty()) point.once_milliseconds = spread(once[first[i]]).median;
        out.push_back(std::move(point));
    }
    return out;
}

}  // namespace clgi::lab
