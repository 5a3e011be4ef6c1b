// SPDX-License-Identifier: MIT
#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/error.hpp>
#include <cmath>

#include "methods/light_atlas/placement.hpp"

namespace clgi {
namespace {

void need_range(const char* what, int got, int least, int most) {
    if (got < least || got > most)
        throw Error(std::string("atlas: ") + what + " is " + std::to_string(got) + ", " +
                    std::to_string(least) + " to " + std::to_string(most) + " needed");
}

// The largest of the sizes that pages are tried at.
int largest_page(const AtlasOptions& options) {
    int size = options.size;
    while (2 * size <= options.largest_size) size *= 2;
    return size;
}

void check(const Scene& scene, const std::vector<std::uint32_t>& region_of,
           const AtlasOptions& options) {
    need_range("size", options.size, 1, 8192);
    need_range("largest_size", options.largest_size, 0, 8192);
    need_range("padding", options.padding, 1, 64);
    need_range("most_pages", options.most_pages, 1, 64);
    const auto size = static_cast<std::uint64_t>(largest_page(options));
    const std::uint64_t texels = size * size * std::uint64_t(options.most_pages);
    if (texels > 0xffffffffu)
        throw Error("atlas: most_pages of " + std::to_string(options.most_pages) + " at size " +
                    std::to_string(size) + " has " + std::to_string(texels) +
                    " texels, fewer than 2^32 needed");
    if (!(options.texels_per_metre >= 0.0) || !std::isfinite(options.texels_per_metre))
        throw Error("atlas: texels_per_metre is " + std::to_string(options.texels_per_metre) +
                    ", 0 or more needed");
    if (!region_of.empty() && region_of.size() != scene.triangles.size())
        throw Error("atlas: region_of has " + std::to_string(region_of.size()) + " numbers, " +
                    std::to_string(scene.triangles.size()) + " triangles need one each");
    if (scene.triangles.empty()) throw InputError("atlas: the scene has no triangles");
    validate(scene);
}

// The UV set that the options ask for; uv_set is -1 if charts are to be made.
LightmapUvs choose_uvs(const Scene& scene, const AtlasOptions& options, AtlasLayout& out) {
    switch (options.uvs) {
        case AtlasUvs::charts:
            return {};
        case AtlasUvs::automatic: {
            LightmapUvs found = lightmap_uvs(scene, options.size, {1});
            // Worth a word only if somebody meant it to be a lightmap.
            if (found.uv_set < 0 && found.meant)
                out.warnings.push_back("charts were made: " + found.faults);
            return found;
        }
        case AtlasUvs::set_0:
        case AtlasUvs::set_1:
            break;
    }
    LightmapUvs found = lightmap_uvs(scene, options.size, {options.uvs == AtlasUvs::set_0 ? 0 : 1});
    if (found.uv_set < 0) throw InputError("atlas: there is no lightmap: " + found.faults);
    return found;
}

// On the smallest pages from the options' size on that hold all charts; sets that size.
AtlasPlacement place_on_pages(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                              const Adjacency* mesh, AtlasOptions options, int& size) {
    const int largest = largest_page(options);
    for (;; options.size *= 2) {
        try {
            size = options.size;
            return place_by_regions(scene, region_of, mesh, options);
        } catch (const InputError&) {  // that they do not fit
            if (options.size == largest) throw;
        }
    }
}

}  // namespace

glm::dvec3 doubled_area_of(const Scene& scene, std::uint32_t triangle) {
    const auto& vertex = scene.triangles[triangle].vertex;
    const glm::dvec3& first = scene.positions[vertex[0]];
    return glm::cross(scene.positions[vertex[1]] - first, scene.positions[vertex[2]] - first);
}

AtlasLayout make_atlas(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                       const AtlasOptions& options) {
    return make_atlas(scene, region_of, nullptr, options);
}

AtlasLayout make_atlas(const Scene& scene, const std::vector<std::uint32_t>& region_of,
                       const Adjacency* mesh, const AtlasOptions& options) {
    check(scene, region_of, options);
    AtlasLayout out;
    out.size = options.size;
    const LightmapUvs lightmap = choose_uvs(scene, options, out);
    out.uv_set = lightmap.uv_set;
    out.warnings.insert(out.warnings.end(), lightmap.warnings.begin(), lightmap.warnings.end());
    if (out.uv_set < 0 && region_of.empty())
        throw Error("atlas: region_of is empty, a number for each triangle needed for charts");
    const AtlasPlacement placed = out.uv_set >= 0
                                      ? place_by_uvs(scene, out.uv_set, options.size)
                                      : place_on_pages(scene, region_of, mesh, options, out.size);
    out.pages = placed.pages;
    out.texels_per_metre = placed.texels_per_metre;
    list_texels(scene, placed, out);
    list_dilated(options.padding, out);
    return out;
}

}  // namespace clgi
