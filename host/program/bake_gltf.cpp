// SPDX-License-Identifier: MIT
#include "program/bake_gltf.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <clgi/io/gltf.hpp>
#include <cmath>

#include "lab/preview.hpp"
#include "program/count_flag.hpp"

namespace clgi::program {
namespace {

constexpr int most_side = 8192;  // texels of a texture: what viewers and their devices take
constexpr int textured_side = 4096, textured_detail = 4;

// Light is smooth and has few texels; what it falls on may need more.
int detail_of(const Scene& scene, const AtlasLayout& atlas, int wanted) {
    if (wanted > 0) return std::min(wanted, std::max(1, most_side / atlas.size));
    const bool textured =
        std::any_of(scene.materials.begin(), scene.materials.end(), [](const Material& material) {
            return material.base_texture.texture >= 0 || material.emission_texture.texture >= 0;
        });
    return textured ? std::clamp(textured_side / atlas.size, 1, textured_detail) : 1;
}

float exposure_of(const std::vector<glm::vec3>& radiance, const std::optional<float>& stops) {
    if (stops) return std::exp2(*stops);
    io::Image texels{static_cast<int>(radiance.size()), 1, {}, {}};
    for (int c = 0; c < 3; ++c) {
        texels.channels.push_back({std::string(1, "RGB"[c]), {}});
        for (const glm::vec3& value : radiance) texels.channels.back().values.push_back(value[c]);
    }
    return lab::preview_exposure(texels);
}

}  // namespace

void add_bake_gltf_flags(CLI::App& command, BakeGltfFlags& flags) {
    command.add_option("--gltf", flags.lit, "GLB that shows the light of the atlas in any viewer")
        ->type_name("FILE")
        ->default_str("none");
    add_count(command, "--gltf-detail", flags.detail,
              "Texels of that file's textures across one of the atlas", 1, 64)
        ->default_str("4 with textures, else 1");
    command.add_flag("--gltf-lights", flags.lights,
                     "Keep lights and base colours in it: the viewer adds direct light");
    command
        .add_option("--unwrapped", flags.unwrapped,
                    "GLB of the scene as it is, with the atlas's UVs as set 1")
        ->type_name("FILE")
        ->default_str("none");
}

std::optional<LitGltf> save_bake_gltf(const Scene& scene, const AtlasLayout& atlas,
                                      const std::vector<glm::vec3>& irradiance,
                                      const std::optional<float>& stops,
                                      const BakeGltfFlags& flags) {
    if (!flags.unwrapped.empty()) io::save_glb(with_atlas_uvs(scene, atlas), flags.unwrapped);
    if (flags.lit.empty()) return std::nullopt;
    LitGltf out;
    out.detail = detail_of(scene, atlas, flags.detail);
    const AtlasLayout finer =
        out.detail > 1 ? finer_atlas(scene, atlas, out.detail) : AtlasLayout();
    const AtlasLayout& shown = out.detail > 1 ? finer : atlas;
    const std::vector<glm::vec3> radiance = atlas_radiance(
        scene, shown, out.detail > 1 ? finer_light(atlas, irradiance, finer) : irradiance);
    LitSceneOptions options;
    options.exposure = exposure_of(radiance, stops);
    options.lights = flags.lights;
    out.stops = std::log2(double{options.exposure});
    io::save_glb(with_atlas_light(scene, shown, radiance, options), flags.lit);
    return out;
}

}  // namespace clgi::program
