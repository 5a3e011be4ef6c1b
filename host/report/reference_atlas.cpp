// SPDX-License-Identifier: MIT
#include "report/reference_atlas.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>

#include "scene/lightmap_uvs.hpp"

namespace clgi::report {
AtlasPlaces atlas_places(const Scene& scene, int size, int uv_set) {
    const std::vector<int> sets = uv_set < 0 ? std::vector<int>{1, 0} : std::vector<int>{uv_set};
    const LightmapUvs lightmap = lightmap_uvs(scene, size, sets);
    if (lightmap.uv_set < 0) throw InputError("atlas: there is no lightmap: " + lightmap.faults);
    AtlasPlaces out;
    out.size = size;
    out.uv_set = lightmap.uv_set;
    out.warnings = lightmap.warnings;
    for (const UvTexel& texel : lightmap.found.texels) {
        const UvPlace place = place_at(scene, texel);
        out.texels.push_back(texel.texel);
        out.places.push_back({place.position, glm::vec3(place.normal), glm::vec3(place.geometric)});
    }
    return out;
}

io::Image atlas_image(const AtlasPlaces& atlas, const reference::Irradiance& irradiance,
                      const std::string& effects) {
    io::Image out;
    out.width = out.height = atlas.size;
    out.attributes = {{"clgi:quantity", "irradiance"},
                      {"clgi:unit", "lux"},
                      {"clgi:effects", effects.empty() ? "all" : effects},
                      {"clgi:samples", std::to_string(irradiance.samples)},
                      {"clgi:relative_error", fmt::format("{:.6g}", irradiance.relative_error)},
                      {"clgi:uv_set", std::to_string(atlas.uv_set)}};
    const std::size_t texels =
        static_cast<std::size_t>(atlas.size) * static_cast<std::size_t>(atlas.size);
    for (const char* name : {"R", "G", "B", "A", "error.Y"})
        out.channels.push_back({name, std::vector<float>(texels, 0.0f)});
    for (std::size_t i = 0; i < atlas.texels.size(); ++i) {
        const std::size_t texel = atlas.texels[i];
        for (int c = 0; c < 3; ++c)
            out.channels[static_cast<std::size_t>(c)].values[texel] = irradiance.values[i][c];
        out.channels[3].values[texel] = 1.0f;
        out.channels[4].values[texel] = irradiance.error[i];
    }
    return out;
}

}  // namespace clgi::report
