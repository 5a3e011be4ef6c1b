// One bake of a light atlas: timed as a whole, and as a picture.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/kit/progress.hpp>
#include <clgi/io/image.hpp>
#include <clgi/light_atlas.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi::lab {

// Laid out like the ground truth of reference_picture.hpp: R, G, B in lux and A: 1 where the centre
// of a texel is covered, else 0. Pages lie below each other. irradiance: by AtlasLayout::texels.
// dilate: also texels that are covered in part, and empty ones that interpolation reads, with A =
// 0; else these are 0.
io::Image baked_image(const AtlasLayout& atlas, const std::vector<glm::vec3>& irradiance,
                      const std::string& effects, bool dilate);

struct BakeJob {
    const Programs& programs;
    cl::CommandQueue queue;
    const Scene& scene;
    const DeviceScene& on_device;  // the same
    VplOptions vpls;
    AtlasOptions atlas;
    LightAtlasOptions options;
};

struct TimedBake {
    // From the scene's buffers to the filled atlas, the layout on the host included. Kernels are
    // part of it unless they were built before.
    double seconds = 0.0;
    double layout_seconds = 0.0;        // of these: patches, VPLs, charts, texels
    std::vector<glm::vec3> irradiance;  // of each texel of the layout, lux
    LightAtlasStatus status;
};

// Nothing when progress cancelled.
std::optional<TimedBake> timed_bake(const BakeJob& job, const Progress& progress = nullptr);

}  // namespace clgi::lab
