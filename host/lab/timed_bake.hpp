// One bake of a light atlas, timed as a whole.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/kit/progress.hpp>
#include <clgi/light_atlas.hpp>
#include <optional>
#include <vector>

namespace clgi::lab {

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
