// A scene that shows the light of its atlas: glTF knows no lightmap, but every viewer shows
// emission.
//
// A black metal without gloss reflects nothing (a black dielectric would mirror 4 % of what a
// viewer puts around it), so what a texel emits is all that is seen. [docs/cli.md, "The GLB of a
// bake"]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/atlas_light.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <map>

#include "methods/light_atlas/lookup.hpp"
#include "methods/light_atlas/placement.hpp"
#include "scene/merge.hpp"
#include "scene/texture_pool.hpp"

namespace clgi {
namespace {

using Rgba = std::array<std::uint8_t, 4>;

Rgba encoded(const glm::dvec3& radiance) {
    if (!std::isfinite(radiance.r + radiance.g + radiance.b)) return {255, 0, 255, 255};
    return {srgb_byte(radiance.r), srgb_byte(radiance.g), srgb_byte(radiance.b), 255};
}

std::vector<Texture> pages_of(const AtlasLayout& atlas, const std::vector<glm::vec3>& radiance,
                              double exposure) {
    const auto pages = static_cast<std::size_t>(atlas.pages);
    const std::size_t texels = std::size_t(atlas.size) * std::size_t(atlas.size);
    std::vector<glm::dvec4> sum(pages, glm::dvec4(0.0));  // of what is finite, and how many
    for (std::size_t i = 0; i < radiance.size(); ++i) {
        const glm::dvec3 value = glm::dvec3(radiance[i]) * exposure;
        if (std::isfinite(value.r + value.g + value.b))
            sum[atlas.texels[i].texel / texels] += glm::dvec4(glm::min(value, 1.0), 1.0);
    }
    std::vector<Texture> out(pages);
    for (std::size_t page = 0; page < pages; ++page) {
        Texture& texture = out[page];
        texture.name = "baked light " + std::to_string(page);
        texture.width = texture.height = atlas.size;
        texture.wrap_s = texture.wrap_t = Wrap::clamp_to_edge;
        const Rgba mean = encoded(glm::dvec3(sum[page]) / std::max(1.0, sum[page].w));
        for (std::size_t i = 0; i < texels; ++i)
            texture.rgba.insert(texture.rgba.end(), mean.begin(), mean.end());
    }
    const auto put = [&](std::uint32_t texel, std::size_t of) {
        const Rgba rgba = encoded(glm::dvec3(radiance[of]) * exposure);
        std::copy(rgba.begin(), rgba.end(), &out[texel / texels].rgba[4 * (texel % texels)]);
    };
    for (std::size_t i = 0; i < radiance.size(); ++i) put(atlas.texels[i].texel, i);
    for (const AtlasDilated& empty : atlas.dilated) put(empty.texel, empty.source);
    return out;
}

// The material of a page's triangles; page `no_index` for those that the atlas has not.
Material lit(const Material& material, std::uint32_t page, bool named, int first_page,
             const LitSceneOptions& options) {
    Material out = material;
    if (page != no_index && named) out.name += " page " + std::to_string(page);
    out.emission = glm::vec3(page == no_index ? 0.0f : 1.0f);
    out.emission_texture = {};
    if (page != no_index) out.emission_texture = {first_page + static_cast<int>(page), 1};
    out.metallic_roughness_texture = out.normal_texture = {};
    if (options.lights) return out;
    out.base_color = glm::vec4(0.0f, 0.0f, 0.0f, material.base_color.a);
    out.metallic = out.roughness = out.specular = 1.0f;  // what readers take where nothing is said
    // Readers that take one UV set for all textures of a material (VTK) take that of the base
    // colour.
    if (out.alpha_mode == AlphaMode::opaque) out.base_texture = out.emission_texture;
    return out;
}

// Forgets textures that no material reads.
void drop_unread(Scene& scene) {
    std::vector<int> kept(scene.textures.size(), -1);
    std::vector<Texture> textures;
    for (Material& material : scene.materials)
        for (TextureSlot* slot : texture_slots(material)) {
            if (slot->texture < 0) continue;
            const auto old = static_cast<std::size_t>(slot->texture);
            if (kept[old] < 0) {
                kept[old] = static_cast<int>(textures.size());
                textures.push_back(std::move(scene.textures[old]));
            }
            slot->texture = kept[old];
        }
    scene.textures = std::move(textures);
}

// UV set 0 of a triangle, whose corners are its own: what a mask or a base colour read on set 1
// moves there. Where nothing of the scene is read, it repeats the atlas, for viewers that know one
// set.
void place(const Scene& scene, std::size_t triangle, Material& material, Scene& out) {
    const TextureSlot& was = scene.materials[scene.triangles[triangle].material].base_texture;
    const int reads = material.base_texture.texture;
    const bool kept = reads >= 0 && reads == was.texture;
    if (kept) material.base_texture.uv_set = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        glm::vec4& uv = out.uvs[3 * triangle + k];
        if (!kept) {
            uv = glm::vec4(uv.z, uv.w, uv.z, uv.w);
        } else if (was.uv_set == 1) {
            const glm::vec4& both = scene.uvs[scene.triangles[triangle].vertex[k]];
            uv = glm::vec4(both.z, both.w, uv.z, uv.w);
        }
    }
}

}  // namespace

Scene with_atlas_light(const Scene& scene, const AtlasLayout& atlas,
                       const std::vector<glm::vec3>& radiance, const LitSceneOptions& options) {
    need_layout_of("with_atlas_light", scene, atlas);
    need_light_of("with_atlas_light", atlas, radiance.size());
    if (!(options.exposure > 0.0f) || !std::isfinite(options.exposure))
        throw Error("with_atlas_light: exposure is " + std::to_string(options.exposure) +
                    ", above 0 needed");
    Scene out = with_corner_uvs(scene, atlas, AtlasPages::each);
    const auto first_page = static_cast<int>(out.textures.size());
    for (Texture& page : pages_of(atlas, radiance, double{options.exposure}))
        out.textures.push_back(std::move(page));
    out.materials.clear();
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> made;  // by material and page
    for (std::size_t t = 0; t < out.triangles.size(); ++t) {
        const std::uint32_t of = scene.triangles[t].material, page = atlas.triangle_page[t];
        const auto next = static_cast<std::uint32_t>(out.materials.size());
        const auto [found, is_new] = made.try_emplace({of, page}, next);
        if (is_new)
            out.materials.push_back(
                lit(scene.materials[of], page, atlas.pages > 1, first_page, options));
        out.triangles[t].material = found->second;
        place(scene, t, out.materials[found->second], out);
    }
    drop_unread(out);
    merge_equal_vertices(out);
    if (!options.lights) out.lights.clear();
    for (Light& light : out.lights) light.intensity *= options.exposure;
    return out;
}

}  // namespace clgi
