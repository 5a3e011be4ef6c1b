// The methods that draw the pictures of a sweep: the settings of each, and a frame of it. A frame
// is what is done anew when lights change and geometry stands still.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/renderer.hpp>
#include <string>
#include <vector>

#include "lab/sweep_turns.hpp"

namespace clgi::lab {

inline constexpr const char* second_order_method = "second-order";
inline constexpr const char* antiradiance_method = "antiradiance";
inline constexpr const char* light_atlas_method = "light atlas";
inline constexpr const char* dynamic_transfer_method = "dynamic transfer";

// Names of truths: all light; direct light and one bounce that nothing blocks; indirect light
// alone.
inline constexpr const char* full_truth = "full";
inline constexpr const char* unshadowed_truth = "unshadowed";
inline constexpr const char* indirect_truth = "indirect";

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

struct PictureSetting : SweepSetting {
    RendererOptions options;
    bool estimate = false;  // of antiradiance: its error, from a picture with twice as many bins
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

// Whether a method can light a scene at all; transfer needs an environment.
bool admits(const Scene& scene, const std::string& method);

}  // namespace clgi::lab
