// SPDX-License-Identifier: MIT
#include "report/reference_atlas.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>

#include "scene/uv_texels.hpp"

namespace clgi::report {
namespace {

// Why a UV set is no lightmap; empty when it is one.
std::string fault_of(const UvTexels& found, const Scene& scene) {
    if (scene.uvs.empty()) return "the scene has no texture coordinates";
    if (found.without_area == scene.triangles.size()) return "no triangle has an area in it";
    if (found.outside > 0)
        return fmt::format("{} of {} triangles reach outside 0..1", found.outside,
                           scene.triangles.size());
    if (found.texels.empty()) return "no triangle covers the centre of a texel";
    if (found.overlapping * 100 > found.texels.size())
        return fmt::format("charts overlap: {} of {} texels are covered more than once",
                           found.overlapping, found.texels.size());
    return "";
}

}  // namespace

AtlasPlaces atlas_places(const Scene& scene, int size, int uv_set) {
    std::string faults;
    for (const int set : {1, 0}) {
        if (uv_set >= 0 && set != uv_set) continue;
        const UvTexels found = uv_texels(scene, set, size);
        const std::string fault = fault_of(found, scene);
        if (!fault.empty()) {
            faults += fmt::format("{}uv set {}: {}", faults.empty() ? "" : "; ", set, fault);
            continue;
        }
        AtlasPlaces out;
        out.size = size;
        out.uv_set = set;
        for (const UvTexel& texel : found.texels) {
            const UvPlace place = place_at(scene, texel);
            out.texels.push_back(texel.texel);
            out.places.push_back(
                {place.position, glm::vec3(place.normal), glm::vec3(place.geometric)});
        }
        if (found.overlapping > 0)
            out.warnings.push_back(
                fmt::format("{} of {} texels are covered more than once; the first triangle counts",
                            found.overlapping, found.texels.size()));
        if (found.without_area > 0)
            out.warnings.push_back(fmt::format("{} of {} triangles have no area in uv set {}",
                                               found.without_area, scene.triangles.size(), set));
        return out;
    }
    throw InputError("atlas: there is no lightmap: " + faults);
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
