// Filling the atlas as the paper does: a mesh over each VPL's view, projected into the charts.
// [Schaerfig16, sections 4.1 to 4.3]
// SPDX-License-Identifier: MIT
#include <clgi/error.hpp>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

using namespace light_atlas;

// device: the device's number of each of the scene's triangles.
void LightAtlasSolver::State::upload_charts(const AtlasLayout& atlas_layout,
                                            const std::vector<std::uint32_t>& device) {
    const std::size_t triangles = device.size();
    if (atlas_layout.uvs.size() != 3 * triangles || atlas_layout.triangle_chart.size() != triangles)
        throw Error("light-atlas: the atlas has " +
                    std::to_string(atlas_layout.triangle_chart.size()) + " triangles, the scene " +
                    std::to_string(triangles));
    std::vector<glm::vec2> uvs(3 * triangles);
    std::vector<std::uint32_t> charts(triangles);
    for (std::size_t t = 0; t < triangles; ++t) {
        charts[device[t]] = atlas_layout.triangle_chart[t];
        for (std::size_t k = 0; k < 3; ++k) uvs[3 * device[t] + k] = atlas_layout.uvs[3 * t + k];
    }
    std::vector<float4> boxes;
    for (const AtlasChart& chart : atlas_layout.charts)
        boxes.emplace_back(chart.column, chart.row, chart.column + chart.width,
                           chart.row + chart.height);
    const std::size_t stride = b.texel_stride;
    const auto size = static_cast<std::uint32_t>(atlas_layout.size);
    std::vector<std::uint32_t> places(PLACE_PLANES * stride);
    for (std::size_t i = 0; i < atlas_layout.texels.size(); ++i) {
        const AtlasTexel& texel = atlas_layout.texels[i];
        places[PLACE_CHART * stride + i] = texel.chart;
        places[PLACE_COLUMN * stride + i] = texel.texel % size;
        places[PLACE_ROW * stride + i] = texel.texel / size % size;
    }
    record.write(b.mesh.uvs, uvs.data(), uvs.size() * sizeof(glm::vec2));
    record.write(b.mesh.charts, charts.data(), charts.size() * sizeof(std::uint32_t));
    record.write(b.mesh.boxes, boxes.data(), boxes.size() * sizeof(float4));
    record.write(b.mesh.places, places.data(), places.size() * sizeof(std::uint32_t));
}

void LightAtlasSolver::State::project(std::uint32_t first, std::uint32_t count) {
    const std::uint32_t squares = mesh_squares(options.mesh);
    const MeshParams params{count, static_cast<std::uint32_t>(options.hemicube_size), squares,
                            options.kernel};
    record("atlas.geometry", std::size_t{count} * MESH_CORNERS(squares), [&](const WaitList& wait) {
        return atlas.geometry(queue, params, scene, b.views, b.pixels, b.mesh, wait);
    });
    record("atlas.replicate", std::size_t{count} * MESH_TRIANGLES(squares),
           [&](const WaitList& wait) { return atlas.replicate(queue, params, b.mesh, wait); });
    record("atlas.project", std::size_t{count} * b.texel_count, [&](const WaitList& wait) {
        return atlas.project(queue, fill_params(first, count), params, b.sites, b.views, b.pixels,
                             b.mesh, b.texels.planes, b.gathered, b.filled, wait);
    });
}

}  // namespace clgi
