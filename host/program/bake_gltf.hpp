// The GLB files that a bake writes: one that shows its light, and one for engines with lightmaps.
// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/App.hpp>
#include <clgi/advanced/atlas_light.hpp>
#include <optional>
#include <string>
#include <vector>

namespace clgi::program {

struct BakeGltfFlags {
    std::string lit;        // empty: none
    std::string unwrapped;  // empty: none
    int detail = 0;         // texels of its textures across one of the atlas; 0: by the scene
    bool lights = false;
};
void add_bake_gltf_flags(CLI::App& command, BakeGltfFlags& flags);

// What was chosen for the GLB that shows the light.
struct LitGltf {
    int detail = 1;
    double stops = 0.0;  // exposure
};

// Writes the files that the flags name. stops: exposure; none: from the radiance of the texels.
std::optional<LitGltf> save_bake_gltf(const Scene& scene, const AtlasLayout& atlas,
                                      const std::vector<glm::vec3>& irradiance,
                                      const std::optional<float>& stops,
                                      const BakeGltfFlags& flags);

}  // namespace clgi::program
