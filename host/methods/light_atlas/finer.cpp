// The charts of an atlas with more texels, for pictures whose textures are finer than their light.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/atlas_light.hpp>
#include <clgi/error.hpp>

#include "methods/light_atlas/lookup.hpp"
#include "methods/light_atlas/placement.hpp"

namespace clgi {
namespace {

constexpr int most_texels = 16384;  // a side
constexpr int padding = 2;          // one is what bilinear filters read; one for rounding

}  // namespace

AtlasLayout finer_atlas(const Scene& scene, const AtlasLayout& atlas, int times) {
    need_layout_of("finer_atlas", scene, atlas);
    if (times < 1 || times > most_texels / std::max(1, atlas.size))
        throw Error("finer_atlas: " + std::to_string(times) + " times " +
                    std::to_string(atlas.size) + " texels a side, 1 to " +
                    std::to_string(most_texels) + " texels needed");
    need_countable_texels("finer_atlas", atlas.size * times, atlas.pages);
    AtlasPlacement placed;
    placed.pages = atlas.pages;
    placed.texels_per_metre = atlas.texels_per_metre * times;
    placed.triangle_chart = atlas.triangle_chart;
    placed.charts = atlas.charts;
    for (AtlasChart& chart : placed.charts)
        for (int AtlasChart::*number :
             {&AtlasChart::column, &AtlasChart::row, &AtlasChart::width, &AtlasChart::height})
            chart.*number *= times;
    for (const glm::vec2& uv : atlas.uvs)
        placed.corners.push_back(glm::dvec2(uv) / double(atlas.size));
    AtlasLayout out;
    out.size = atlas.size * times;
    out.pages = atlas.pages;
    out.uv_set = atlas.uv_set;
    out.texels_per_metre = placed.texels_per_metre;
    list_texels(scene, placed, out);
    list_dilated(padding, out);
    return out;
}

std::vector<glm::vec3> finer_light(const AtlasLayout& atlas,
                                   const std::vector<glm::vec3>& irradiance,
                                   const AtlasLayout& finer) {
    need_light_of("finer_light", atlas, irradiance.size());
    if (finer.triangle_chart.size() != atlas.triangle_chart.size() ||
        finer.charts.size() != atlas.charts.size())
        throw Error("finer_light: the layouts have " + std::to_string(atlas.charts.size()) +
                    " and " + std::to_string(finer.charts.size()) + " charts, equal ones needed");
    const AtlasLookup lookup(atlas);
    std::vector<glm::vec3> out;
    out.reserve(finer.texels.size());
    for (const AtlasTexel& texel : finer.texels) {
        const glm::dvec2 place =
            atlas_place(atlas, texel.triangle, double{texel.b1}, double{texel.b2});
        out.emplace_back(lookup.at(texel.chart, place).of(irradiance));
    }
    return out;
}

}  // namespace clgi
