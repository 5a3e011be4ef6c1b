// SPDX-License-Identifier: MIT
#include "methods/light_atlas/estimate.hpp"

#include <clgi/error.hpp>
#include <clgi/light_atlas.hpp>

#include "core/kit/ranges.hpp"

namespace clgi {
namespace light_atlas {

BakeCost bake_cost(double vpls, double texels, double triangles, bool occlusion) {
    if (occlusion)
        return {40.0 + vpls * (0.25 + 4e-5 * triangles) + 3e-5 * vpls * vpls +
                    1.3e-6 * vpls * texels + 2e-3 * triangles,
                2.0 * vpls * vpls + texels * (vpls / 8.0 + 150.0)};
    // VPLs near by take a time of their own for each texel.
    return {4.0 + vpls * (0.033 + 2e-6 * triangles) + 1.4e-5 * vpls * vpls +
                texels * (1e-4 + 1.6e-7 * vpls) + 7e-3 * triangles,
            2.0 * vpls * vpls + texels * 150.0};
}

}  // namespace light_atlas

void check_bake_fits(const cl::Device& device, const VplOptions& vpls) {
    const std::size_t samples = std::size_t{vpls.count} * vpls.samples_per_vpl;
    const std::size_t needed = light_atlas_least_bytes(vpls.count, samples);
    const std::size_t memory = device.getInfo<CL_DEVICE_GLOBAL_MEM_SIZE>();
    if (needed <= memory) return;
    const auto mb = [](std::size_t bytes) { return std::to_string(bytes / 1000000) + " MB"; };
    throw DeviceError("light-atlas: " + std::to_string(vpls.count) + " VPLs with " +
                      std::to_string(vpls.samples_per_vpl) + " samples each need " + mb(needed) +
                      " at the least, the device has " + mb(memory) +
                      "; lower the number of VPLs or of their samples");
}

Estimate estimate(const cl::Device& device, const DeviceScene& scene, const VplOptions& vpls,
                  const AtlasOptions& atlas, const LightAtlasOptions& options) {
    check_bake_fits(device, vpls);
    const double texels = 0.75 * atlas.size * atlas.size;
    const auto cost = light_atlas::bake_cost(vpls.count, texels, scene.info().triangle_count,
                                             occludes(options.occlusion));
    const std::size_t samples = std::size_t{vpls.count} * vpls.samples_per_vpl;
    return {static_cast<std::size_t>(cost.bytes) + light_atlas_least_bytes(vpls.count, samples),
            cost.ms * fitted_pairs / pairs_per_second(device)};
}

}  // namespace clgi
