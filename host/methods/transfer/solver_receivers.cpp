// Which receivers a scene has.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "methods/transfer/solver_state.hpp"
#include "scene/base_color.hpp"

namespace clgi {

SceneReceivers::SceneReceivers(const Scene& scene, const DeviceScene& device)
    : other_side(device.info().vertex_count, RECEIVER_NONE),
      exponents(device.info().vertex_count, 0.0f) {
    if (scene.positions.size() != device.file_vertex_count())
        throw Error("dynamic-transfer: the scene has " + std::to_string(scene.positions.size()) +
                    " vertices, that of the device has " +
                    std::to_string(device.file_vertex_count()));
    std::vector<std::uint32_t> of_file(scene.positions.size(), 0);
    for (std::uint32_t v = 0; v < other_side.size(); ++v) of_file[device.vertex_order()[v]] = v;
    std::vector<bool> double_sided(other_side.size(), false);
    for (const SceneTriangle& triangle : scene.triangles) {
        const Material& material = scene.materials[triangle.material];
        const float exponent = reflectance(material).exponent;
        for (const std::uint32_t corner : triangle.vertex) {
            exponents[of_file[corner]] = exponent;
            if (material.double_sided) double_sided[of_file[corner]] = true;
        }
    }
    for (std::uint32_t v = 0; v < other_side.size(); ++v)
        if (double_sided[v]) {
            other_side[v] = count();
            fronts.push_back(v);
            exponents.push_back(exponents[v]);
        }
}

void SceneReceivers::add_other_sides(BlockerLevels& levels) const {
    if (levels.receivers_per_list != 1) return;
    std::vector<std::uint32_t>&lists = levels.lists, &ranges = levels.ranges, &near = levels.near;
    for (const std::uint32_t v : fronts) {
        for (std::uint32_t i = 2 * lists[v]; i < 2 * lists[v + 1]; ++i)
            ranges.push_back(std::uint32_t{ranges[i]});
        lists.push_back(static_cast<std::uint32_t>(ranges.size() / 2));
        if (levels.near_lists.empty()) continue;
        for (std::uint32_t i = levels.near_lists[v]; i < levels.near_lists[v + 1]; ++i)
            near.push_back(std::uint32_t{near[i]});
        if (near.size() > RECEIVER_NONE)
            throw DeviceError(
                "dynamic-transfer: lists of singles have more than 2^32 triangles; "
                "give more triangles in coarse");
        levels.near_lists.push_back(static_cast<std::uint32_t>(near.size()));
    }
}

std::vector<float> SceneReceivers::reflectances(const Scene& scene, const DeviceScene& device,
                                                std::size_t stride) const {
    const BaseColorMeans base_colors(scene);
    std::vector<glm::dvec3> sum(scene.positions.size(), glm::dvec3(0.0));
    std::vector<int> count(scene.positions.size(), 0);
    for (const SceneTriangle& triangle : scene.triangles) {
        const Material& material = scene.materials[triangle.material];
        const glm::dvec3 base = base_colors(triangle);
        for (const std::uint32_t corner : triangle.vertex) {
            const glm::dvec3 colour =
                scene.colors.empty() ? glm::dvec3(1.0) : glm::dvec3(scene.colors[corner]);
            sum[corner] += colour * base * double{reflectance(material).diffuse};
            ++count[corner];
        }
    }
    std::vector<float> out(3 * stride, 0.0f);
    for (std::size_t i = 0; i < exponents.size(); ++i) {
        const std::size_t vertex =
            i < other_side.size() ? i : std::size_t{fronts[i - other_side.size()]};
        const std::uint32_t of_file = device.vertex_order()[vertex];
        for (int c = 0; c < 3; ++c)
            out[static_cast<std::size_t>(c) * stride + i] =
                static_cast<float>(sum[of_file][c] / std::max(count[of_file], 1));
    }
    return out;
}

}  // namespace clgi
