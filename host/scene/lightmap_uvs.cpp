// SPDX-License-Identifier: MIT
#include "scene/lightmap_uvs.hpp"

namespace clgi {
namespace {

std::string of(std::size_t some, std::size_t all) {
    return std::to_string(some) + " of " + std::to_string(all);
}

// Why a UV set is no lightmap; empty when it is one.
std::string fault_of(const UvTexels& found, const Scene& scene) {
    if (scene.uvs.empty()) return "the scene has no texture coordinates";
    if (found.without_area == scene.triangles.size()) return "no triangle has an area in it";
    if (found.outside > 0)
        return of(found.outside, scene.triangles.size()) + " triangles reach outside 0..1";
    if (found.texels.empty()) return "no triangle covers the centre of a texel";
    if (found.overlapping * 100 > found.texels.size())
        return "charts overlap: " + of(found.overlapping, found.texels.size()) +
               " texels are covered more than once";
    return "";
}

}  // namespace

LightmapUvs lightmap_uvs(const Scene& scene, int size, const std::vector<int>& sets) {
    LightmapUvs out;
    for (const int set : sets) {
        UvTexels found = uv_texels(scene, set, size);
        const std::string fault = fault_of(found, scene);
        if (!fault.empty()) {
            out.meant = out.meant || found.without_area < scene.triangles.size();
            out.faults += (out.faults.empty() ? "" : "; ");
            out.faults += "uv set " + std::to_string(set) + ": " + fault;
            continue;
        }
        if (found.overlapping > 0)
            out.warnings.push_back(of(found.overlapping, found.texels.size()) +
                                   " texels are covered more than once; the first triangle counts");
        if (found.without_area > 0)
            out.warnings.push_back(of(found.without_area, scene.triangles.size()) +
                                   " triangles have no area in uv set " + std::to_string(set));
        out.uv_set = set;
        out.found = std::move(found);
        return out;
    }
    return out;
}

}  // namespace clgi
