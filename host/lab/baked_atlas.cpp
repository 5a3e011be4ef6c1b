// SPDX-License-Identifier: MIT
#include "lab/baked_atlas.hpp"

namespace clgi::lab {

io::Image baked_image(const AtlasLayout& atlas, const std::vector<glm::vec3>& irradiance,
                      const std::string& effects, bool dilate) {
    io::Image out;
    out.width = atlas.size;
    out.height = atlas.size * atlas.pages;
    out.attributes = {{"clgi:quantity", "irradiance"},
                      {"clgi:unit", "lux"},
                      {"clgi:effects", effects},
                      {"clgi:uv_set", std::to_string(atlas.uv_set)}};
    const std::size_t texels =
        static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height);
    for (const char* name : {"R", "G", "B", "A"})
        out.channels.push_back({name, std::vector<float>(texels, 0.0f)});
    const auto put = [&](std::size_t texel, const glm::vec3& value, float alpha) {
        for (int c = 0; c < 3; ++c)
            out.channels[static_cast<std::size_t>(c)].values[texel] = value[c];
        out.channels[3].values[texel] = alpha;
    };
    for (std::size_t i = 0; i < atlas.texels.size(); ++i)
        if (dilate || atlas.texels[i].centre)
            put(atlas.texels[i].texel, irradiance[i], atlas.texels[i].centre ? 1.0f : 0.0f);
    if (dilate)
        for (const AtlasDilated& empty : atlas.dilated)
            put(empty.texel, irradiance[empty.source], 0.0f);
    return out;
}

}  // namespace clgi::lab
