// SPDX-License-Identifier: MIT
#include "lab/reference_atlas.hpp"

#include <fmt/format.h>

#include <clgi/error.hpp>

#include "lab/hash.hpp"
#include "lab/reference_picture.hpp"
#include "scene/lightmap_uvs.hpp"

namespace clgi::lab {
namespace {

void add_place(AtlasPlaces& atlas, const Scene& scene, const UvTexel& texel) {
    const UvPlace place = place_at(scene, texel);
    atlas.texels.push_back(texel.texel);
    atlas.places.push_back({place.position, glm::vec3(place.normal), glm::vec3(place.geometric)});
}

}  // namespace

AtlasPlaces atlas_places(const Scene& scene, int size, int uv_set) {
    const std::vector<int> sets = uv_set < 0 ? std::vector<int>{1, 0} : std::vector<int>{uv_set};
    const LightmapUvs lightmap = lightmap_uvs(scene, size, sets);
    if (lightmap.uv_set < 0) throw InputError("atlas: there is no lightmap: " + lightmap.faults);
    AtlasPlaces out;
    out.size = size;
    out.uv_set = lightmap.uv_set;
    out.warnings = lightmap.warnings;
    for (const UvTexel& texel : lightmap.found.texels) add_place(out, scene, texel);
    return out;
}

AtlasPlaces atlas_places(const Scene& scene, const AtlasLayout& layout) {
    AtlasPlaces out;
    out.size = layout.size;
    out.pages = layout.pages;
    out.uv_set = layout.uv_set;
    for (const AtlasTexel& texel : layout.texels)
        if (texel.centre)
            add_place(out, scene,
                      {texel.texel, texel.triangle, double{texel.b1}, double{texel.b2}});
    return out;
}

io::Image atlas_image(const AtlasPlaces& atlas, const reference::Irradiance& irradiance,
                      const std::string& effects) {
    io::Image out;
    out.width = atlas.size;
    out.height = atlas.size * atlas.pages;
    out.attributes = {{"clgi:quantity", "irradiance"},
                      {"clgi:unit", "lux"},
                      {"clgi:effects", effects.empty() ? "all" : effects},
                      {"clgi:samples", std::to_string(irradiance.samples)},
                      {"clgi:relative_error", fmt::format("{:.6g}", irradiance.relative_error)},
                      {"clgi:uv_set", std::to_string(atlas.uv_set)}};
    const std::size_t texels =
        static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
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

io::Image cached_atlas(const reference::PathTracer& tracer, const AtlasPlaces& atlas,
                       const reference::Options& options, const std::string& effects,
                       const std::filesystem::path& file, const std::string& scene,
                       const Progress& progress) {
    Hash hash;
    hash.add(tracer_version, scene, effects, atlas.size, atlas.pages, atlas.texels);
    for (const reference::Place& place : atlas.places)
        hash.add(place.position, place.normal, place.geometric);
    hash.add(options.samples, options.target, options.seed, options.roulette_depth);
    return kept_image(file, "atlas " + hash.text(), [&] {
        const reference::Irradiance found = tracer.irradiance(atlas.places, options, progress);
        return found.cancelled ? io::Image() : atlas_image(atlas, found, effects);
    });
}

}  // namespace clgi::lab
