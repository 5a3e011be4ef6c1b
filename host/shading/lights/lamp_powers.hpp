// The power of emissive surfaces, lamp by lamp, and which parts of it points stand for.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>
#include <vector>

namespace clgi {

// A part of the power of all lamps, one after the other.
struct PowerStretch {
    double begin, end;
};

class LampPowers {
public:
    // triangles: those of a lamp one after the other. powers: of the triangles, at least 0.
    LampPowers(const std::vector<EmissiveTriangle>& triangles, const std::vector<double>& powers);

    double total() const { return ends_.empty() ? 0.0 : ends_.back(); }
    // `count` equal stretches of a total above 0; by_lamp: those cut in two in which one lamp ends
    // and the next begins, so that points of a lamp have its power, unless more lamps end than
    // there are stretches.
    std::vector<PowerStretch> stretches(int count, bool by_lamp) const;
    // The triangle at a place in [0, total).
    std::size_t at(double place) const;

private:
    std::vector<double> ends_;       // of the triangles
    std::vector<double> lamp_ends_;  // of lamps before the last
};

}  // namespace clgi
