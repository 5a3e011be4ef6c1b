// SPDX-License-Identifier: MIT
#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/error.hpp>

#include "methods/light_atlas/placement.hpp"
#include "scene/merge.hpp"

namespace clgi {

Scene with_corner_uvs(const Scene& scene, const AtlasLayout& atlas, AtlasPages pages) {
    if (atlas.uvs.size() != 3 * scene.triangles.size())
        throw Error("atlas: the layout has " + std::to_string(atlas.uvs.size() / 3) +
                    " triangles, the scene " + std::to_string(scene.triangles.size()));
    Scene out = scene;
    const std::size_t corners = 3 * scene.triangles.size();
    out.positions.resize(corners);
    out.normals.resize(corners);
    out.uvs.assign(corners, glm::vec4(0.0f));
    if (!scene.colors.empty()) out.colors.resize(corners);
    for (std::size_t t = 0; t < scene.triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t corner = 3 * t + k, from = scene.triangles[t].vertex[k];
            out.triangles[t].vertex[k] = static_cast<std::uint32_t>(corner);
            out.positions[corner] = scene.positions[from];
            out.normals[corner] = scene.normals[from];
            if (!scene.colors.empty()) out.colors[corner] = scene.colors[from];
            glm::vec2 uv = atlas.uvs[corner] / static_cast<float>(atlas.size);
            if (pages == AtlasPages::stacked) {
                const std::uint32_t page = atlas.triangle_page[t];
                uv.y = (uv.y + static_cast<float>(page < 64u ? page : 0u)) /
                       static_cast<float>(atlas.pages);
            }
            const glm::vec4 own = scene.uvs.empty() ? glm::vec4(0.0f) : scene.uvs[from];
            out.uvs[corner] = glm::vec4(own.x, own.y, uv.x, uv.y);
        }
    return out;
}

Scene with_atlas_uvs(const Scene& scene, const AtlasLayout& atlas, AtlasPages pages) {
    Scene out = with_corner_uvs(scene, atlas, pages);
    merge_equal_vertices(out);
    return out;
}

}  // namespace clgi
