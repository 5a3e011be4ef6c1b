// SPDX-License-Identifier: MIT
#include "methods/light_atlas/lookup.hpp"

#include <clgi/advanced/adjacency.hpp>
#include <clgi/error.hpp>
#include <string>

namespace clgi {

AtlasLookup::AtlasLookup(const AtlasLayout& atlas) : atlas_(atlas) {
    const auto side = static_cast<std::size_t>(atlas.size);
    listed_.assign(side * side * static_cast<std::size_t>(atlas.pages), no_index);
    for (std::uint32_t i = 0; i < atlas.texels.size(); ++i) listed_[atlas.texels[i].texel] = i;
}

AtlasTaps AtlasLookup::at(std::uint32_t chart, const glm::dvec2& place) const {
    const glm::dvec2 corner = glm::floor(place - 0.5), part = place - 0.5 - corner;
    const auto size = static_cast<std::size_t>(atlas_.size);
    const auto page = static_cast<std::size_t>(atlas_.charts[chart].page);
    AtlasTaps own, other;
    double own_weight = 0.0, other_weight = 0.0;
    for (int tap = 0; tap < 4; ++tap) {
        const glm::ivec2 at = glm::clamp(glm::ivec2(corner) + glm::ivec2(tap & 1, tap >> 1),
                                         glm::ivec2(0), glm::ivec2(atlas_.size - 1));
        const double weight =
            (tap & 1 ? part.x : 1.0 - part.x) * (tap >> 1 ? part.y : 1.0 - part.y);
        const std::uint32_t texel = listed_[(page * size + static_cast<std::size_t>(at.y)) * size +
                                            static_cast<std::size_t>(at.x)];
        if (texel == no_index || !(weight > 0.0)) continue;
        // A chart that has none of the four takes those of others, as any sampler would.
        const bool is_own = atlas_.texels[texel].chart == chart;
        AtlasTaps& to = is_own ? own : other;
        (is_own ? own_weight : other_weight) += weight;
        to.texel[static_cast<std::size_t>(to.count)] = texel;
        to.weight[static_cast<std::size_t>(to.count++)] = weight;
    }
    AtlasTaps& out = own.count > 0 ? own : other;
    for (double& weight : out.weight) weight /= own.count > 0 ? own_weight : other_weight;
    return out;
}

glm::dvec2 atlas_place(const AtlasLayout& atlas, std::uint32_t triangle, double b1, double b2) {
    const glm::vec2* uv = &atlas.uvs[3 * std::size_t{triangle}];
    return glm::dvec2(uv[0]) + b1 * (glm::dvec2(uv[1]) - glm::dvec2(uv[0])) +
           b2 * (glm::dvec2(uv[2]) - glm::dvec2(uv[0]));
}

void need_layout_of(const char* name, const Scene& scene, const AtlasLayout& atlas) {
    const std::size_t triangles = scene.triangles.size();
    if (atlas.uvs.size() != 3 * triangles || atlas.triangle_chart.size() != triangles ||
        atlas.triangle_page.size() != triangles)
        throw Error(std::string(name) + ": the layout has " +
                    std::to_string(atlas.triangle_chart.size()) + " triangles, the scene " +
                    std::to_string(triangles));
}

void need_light_of(const char* name, const AtlasLayout& atlas, std::size_t values) {
    if (values != atlas.texels.size())
        throw Error(std::string(name) + ": light for " + std::to_string(values) +
                    " texels, the layout has " + std::to_string(atlas.texels.size()));
}

}  // namespace clgi
