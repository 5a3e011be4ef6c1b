// A sweep of second-order illumination: pictures of one camera.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/solvers/second_order.hpp>

#include "report/sweep.hpp"

namespace clgi::report {

struct PictureSweep {
    int camera = 0;
    int width = 320;
    int height = 240;
};

// The truths that pictures are compared with: "full", "one-bounce", "unshadowed".
enum PictureTruth { all_light, one_bounce, unshadowed_bounce };
constexpr int picture_truths = 3;

// Method "second-order". Throws what its parts throw, and Error when cancelled.
Sweep sweep_pictures(const SweepSetup& setup, const PictureSweep& pictures);

// The settings that such a sweep tries, by series. The first of each series that varies one knob is
// that knob's least accurate setting; that of "math" is strict math on floats.
struct Settings {
    std::string series;
    std::map<std::string, std::string> knobs;
    SecondOrderOptions options;
};
std::vector<Settings> second_order_settings(int width, int height, bool quick,
                                            const BuildOptions& build = {});

}  // namespace clgi::report
