// A sweep of pictures of one camera: second-order illumination, antiradiance, or all systems that a
// scene admits, beside the path tracer.
// SPDX-License-Identifier: MIT
#pragma once

#include "lab/picture_methods.hpp"
#include "lab/sweep.hpp"
#include "plan/second_order_fronts.hpp"

namespace clgi::lab {

struct PictureSweep {
    int camera = 0;
    int width = 320;
    int height = 240;
    // Names of picture_methods.hpp; those that the scene does not admit are left out.
    std::vector<std::string> methods = {second_order_method};
};

// The truths that pictures are compared with, where second-order illumination is among the methods:
// "full", "one-bounce", "unshadowed".
enum PictureTruth { all_light, one_bounce, unshadowed_bounce };
constexpr int picture_truths = 3;
// Else full_truth, and without an environment indirect_truth: what antiradiance adds to direct
// light.

// Throws what its parts throw, InputError where the scene admits none of the methods, and Error
// when cancelled.
Sweep sweep_pictures(const SweepSetup& setup, const PictureSweep& pictures);

// The settings of second-order illumination that such a sweep tries, by series. The first of each
// series that varies one knob is that knob's least accurate setting; that of "math" is strict math
// on floats. front: of the scene's main light; a sweep that is not quick has a series "front" of
// where each of its refinements begins to pay.
std::vector<PictureSetting> second_order_settings(bool quick, const BuildOptions& build = {},
                                                  const SecondOrderFront* front = nullptr);

}  // namespace clgi::lab
