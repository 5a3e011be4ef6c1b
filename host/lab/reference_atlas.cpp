// SPDX-License-Identifier: MIT
#include "lab/reference_atlas.hpp"

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
    io::Image out = irradiance_image(
        blank_irradiance(atlas.size, atlas.size * atlas.pages, {"R", "G", "B", "A", "error.Y"}),
        atlas.texels, irradiance, effects);
    out.attributes["clgi:uv_set"] = std::to_string(atlas.uv_set);
    for (const std::uint32_t texel : atlas.texels) out.channels[3].values[texel] = 1.0f;
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
