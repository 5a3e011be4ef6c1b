// SPDX-License-Identifier: MIT
#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/error.hpp>

namespace clgi {

AtlasLayout atlas_of_whole(const AtlasLayout& part, const std::vector<std::uint32_t>& triangles,
                           std::size_t count) {
    if (part.triangle_chart.size() != triangles.size())
        throw Error("atlas-of-whole: the layout has " + std::to_string(part.triangle_chart.size()) +
                    " triangles, " + std::to_string(triangles.size()) + " are named");
    AtlasLayout out = part;
    out.uvs.assign(3 * count, glm::vec2(0.0f));
    out.triangle_page.assign(count, no_index);
    out.triangle_chart.assign(count, no_index);
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        const std::size_t to = triangles[t];
        if (to >= count)
            throw Error("atlas-of-whole: triangle " + std::to_string(to) + " is named of " +
                        std::to_string(count));
        out.triangle_page[to] = part.triangle_page[t];
        out.triangle_chart[to] = part.triangle_chart[t];
        for (std::size_t k = 0; k < 3; ++k) out.uvs[3 * to + k] = part.uvs[3 * t + k];
    }
    for (AtlasTexel& texel : out.texels) texel.triangle = triangles[texel.triangle];
    return out;
}

}  // namespace clgi
