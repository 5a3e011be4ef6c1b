// SPDX-License-Identifier: MIT
#include "antiradiance/element_surface.hpp"

#include <algorithm>
#include <cstring>

#include "antiradiance/leaf_vertices.hpp"
#include "antiradiance/patch_weights.hpp"

namespace clgi {
namespace {

// Areas are those of the local frame, so that intensities are about as large in every scene.
void list_elements(const ElementTree& tree, const DirectionBins& bins, double scale,
                   ElementSurface& out) {
    const auto count = static_cast<std::uint32_t>(tree.count());
    out.elements.resize(count);
    std::uint32_t levels = 0, inner = 0;
    for (const bool back : {false, true}) {
        if (back) out.first_back = static_cast<std::uint32_t>(out.leaves.size());
        for (std::uint32_t i = 0; i < count; ++i)
            if (tree.is_leaf(i) && (tree.backs[i] != 0) == back) out.leaves.push_back(i);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
        Element& element = out.elements[i];
        element.parent = tree.parents[i] == no_index ? ELEMENT_NONE : tree.parents[i];
        element.end = tree.ends[i];
        if (tree.is_leaf(i)) continue;
        element.row = inner++;
        levels = std::max(levels, tree.levels[i] + 1);
        out.inner.push_back(i);
    }
    for (std::uint32_t row = 0; row < out.leaves.size(); ++row) {
        const std::uint32_t i = out.leaves[row];
        const glm::dvec3 normal = tree.normals[i] * bins.hemisphere_scale(tree.normals[i]);
        out.elements[i].normal = glm::vec4(glm::dvec4(normal, tree.areas[i] * scale * scale));
        out.elements[i].row = row;
    }
    const auto level = [&](std::uint32_t i) { return tree.levels[i]; };
    std::stable_sort(out.inner.begin(), out.inner.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return level(a) < level(b); });
    for (std::uint32_t l = 0; l <= levels; ++l)
        out.level_begins.push_back(static_cast<std::uint32_t>(
            std::partition_point(out.inner.begin(), out.inner.end(),
                                 [&](std::uint32_t i) { return level(i) < l; }) -
            out.inner.begin()));
}

}  // namespace

ElementSurface make_element_surface(const ElementTree& tree, const DirectionBins& bins,
                                    const Scene& scene, const DeviceScene& device) {
    ElementSurface out;
    list_elements(tree, bins, device.frame().scale, out);
    std::vector<std::uint32_t> on_device(scene.triangles.size(), no_index);
    for (std::uint32_t t = 0; t < device.triangle_order().size(); ++t)
        on_device[device.triangle_order()[t]] = t;
    out.roots.assign(device.info().triangle_count, {ELEMENT_NONE, ELEMENT_NONE, 0, 0});
    out.patches.resize(tree.count());
    for (std::uint32_t i = 0; i < tree.count(); ++i) {
        if (!tree.is_patch(i)) continue;
        const PatchWeights weights = patch_weights(tree, i, scene);
        out.patches[i].weights = {glm::vec2(weights[0]), glm::vec2(weights[1])};
        out.patches[i].last = {glm::vec2(weights[2]), 0.0f, 0.0f};
        const std::uint32_t t = on_device[tree.triangles[i]], parent = tree.parents[i];
        if (t == no_index || (parent != no_index && tree.is_patch(parent))) continue;
        (tree.backs[i] ? out.roots[t].back : out.roots[t].front) = i;
    }
    const double scale = device.frame().scale;
    for (const std::uint32_t i : out.leaves) {
        const PatchCorners& patch = out.patches[i];
        const glm::vec2 a(patch.weights), b(patch.weights.z, patch.weights.w), c(patch.last);
        const std::uint32_t triangle = tree.triangles[i];
        const bool dark =
            tree.backs[i] && !scene.materials[scene.triangles[triangle].material].double_sided;
        const auto area = static_cast<float>(tree.areas[i] * scale * scale / leaf_samples);
        const auto put = [&](const glm::vec2& at) {
            out.samples.push_back({dark ? no_index : on_device[triangle], at.x, at.y, area});
        };
        put((a + b + c) / 3.0f);
        put((4.0f * a + b + c) / 6.0f);
        put((a + 4.0f * b + c) / 6.0f);
        put((a + b + 4.0f * c) / 6.0f);
    }
    const LeafVertices shared = leaf_vertices(tree, out.leaves);
    out.first_leaves = shared.first;
    for (const auto& [row, share] : shared.leaves) {
        std::uint32_t bits = 0;
        std::memcpy(&bits, &share, sizeof(bits));
        out.vertex_leaves.emplace_back(row, bits);
    }
    for (std::size_t row = 0; row < out.leaves.size(); ++row)
        for (std::size_t k = 0; k < 3; ++k)
            out.patches[out.leaves[row]].vertex[k] = shared.vertices[row][k];
    return out;
}

}  // namespace clgi
