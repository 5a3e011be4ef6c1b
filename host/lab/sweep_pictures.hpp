// A sweep of pictures of one camera: second-order illumination, antiradiance, or all systems that a
// scene admits, beside the path tracer. A frame is what is done anew when lights change and
// geometry stands still.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/renderer.hpp>
#include <string>
#include <vector>

#include "lab/sweep_run.hpp"
#include "plan/second_order_fronts.hpp"

namespace clgi::lab {

inline constexpr const char* second_order_method = "second-order";
inline constexpr const char* antiradiance_method = "antiradiance";
inline constexpr const char* light_atlas_method = "light atlas";
inline constexpr const char* dynamic_transfer_method = "dynamic transfer";

struct PictureSweep {
    int camera = 0;
    int width = 320;
    int height = 240;
    std::vector<std::string> methods = {second_order_method};  // of the four
};

// Names of truths: all light; direct light and one bounce that nothing blocks; indirect light
// alone.
inline constexpr const char* full_truth = "full";
inline constexpr const char* unshadowed_truth = "unshadowed";
inline constexpr const char* indirect_truth = "indirect";

// The truths that pictures are compared with, where second-order illumination is among the methods:
// "full", "one-bounce", "unshadowed".
enum PictureTruth { all_light, one_bounce, unshadowed_bounce };
constexpr int picture_truths = 3;
// Else full_truth, and without an environment indirect_truth: what antiradiance adds to direct
// light.

// Methods that the scene does not admit are left out; transfer needs an environment. Throws what
// its parts throw, InputError where the scene admits none of them, and Error when cancelled.
Sweep sweep_pictures(const SweepSetup& setup, const PictureSweep& pictures);

// ---- settings -----------------------------------------------------------------------------------

struct PictureSetting : SweepSetting {
    RendererOptions options;
    bool estimate = false;  // of antiradiance: its error, from a picture with twice as many bins
};

// Of second-order illumination. The first of each series that varies one knob is that knob's least
// accurate setting; that of "math" is strict math on floats. front: of the scene's main light; a
// sweep that is not quick has a series "front" of where each of its refinements begins to pay.
std::vector<PictureSetting> second_order_settings(bool quick, const BuildOptions& build = {},
                                                  const SecondOrderFront* front = nullptr);
// Of a sweep of antiradiance alone, or quick ones beside other systems.
std::vector<PictureSetting> antiradiance_settings(bool quick, const BuildOptions& build = {},
                                                  bool alone = true);
// Those whose charts fit. Where those of the usual page do not, all pages are larger.
std::vector<PictureSetting> light_atlas_settings(const Scene& scene, bool quick);
std::vector<PictureSetting> dynamic_transfer_settings(bool quick);
std::string name_of(Iteration iteration);  // "auto", as --iteration has it

// ---- a frame ------------------------------------------------------------------------------------

// What all methods draw. What it refers to must outlive the task.
struct PictureTask {
    const SweepSetup& setup;
    const Camera& camera;
    int width, height;
    DeviceScene& scene;
    const Programs& programs;
    const std::vector<SweepTruth>& truths;
    bool alone;       // one method: with all of its settings, and the error that it tells of itself
    int shadow_size;  // alike for all, but for second-order illumination, which varies it
};

struct PictureMethod {
    std::vector<std::string> knobs;  // columns of tables
    std::vector<PictureSetting> settings;
};
// name: one of the four.
PictureMethod picture_method(const std::string& name, const PictureTask& task);

// As Turns::measure; a result has its picture and all errors. first: of its method, whose kernels
// are not built yet. Throws what Renderer throws, and Error when cancelled.
Measured measure_picture(const PictureTask& task, const PictureSetting& setting, bool first,
                         SweepPoint* result, const Progress& part);

}  // namespace clgi::lab
