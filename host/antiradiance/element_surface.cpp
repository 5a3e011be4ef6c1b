// SPDX-License-Identifier: MIT
#include "antiradiance/element_surface.hpp"

#include <algorithm>
#include <cstring>

#include "antiradiance/halve.hpp"
#include "antiradiance/leaf_vertices.hpp"

namespace clgi {
namespace {

// Weights of the second and third corner of a triangle at a point in its plane.
glm::dvec2 weights_at(const std::array<glm::dvec3, 3>& corners, const glm::dvec3& point) {
    const glm::dvec3 edge1 = corners[1] - corners[0], edge2 = corners[2] - corners[0];
    const glm::dvec3 normal = glm::cross(edge1, edge2), to = point - corners[0];
    const double scale = 1.0 / glm::dot(normal, normal);
    return {scale * glm::dot(glm::cross(to, edge2), normal),
            scale * glm::dot(glm::cross(edge1, to), normal)};
}

// Where a patch with parts was cut; its parts are as many elements each.
std::uint32_t cut_of(const ElementTree& tree, std::size_t i) {
    if (!tree.is_patch(i) || tree.is_leaf(i)) return 0;
    const auto halves = halve(tree.corners[i]);
    std::uint32_t out = longest_edge(tree.corners[i]);
    for (std::uint32_t half = 0; half < 2; ++half)
        out |= longest_edge(halves[half]) << (2 + 2 * half);
    const std::size_t part = tree.ends[i + 1] - (i + 1);
    return 4 * part == tree.ends[i] - (i + 1) ? out | CUT_TWICE : out;
}

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
        element.cut = cut_of(tree, i);
        if (tree.is_leaf(i)) continue;
        element.row = inner++;
        levels = std::max(levels, tree.levels[i] + 1);
        out.inner.push_back(i);
    }
    for (std::uint32_t row = 0; row < out.leaves.size(); ++row)
        out.elements[out.leaves[row]].row = row;
    for (std::uint32_t i = 0; i < count; ++i) {
        const std::uint32_t parent = tree.parents[i];
        glm::dvec3 normal = tree.normals[i];
        if (parent != no_index && normal == tree.normals[parent])
            normal = glm::dvec3(out.elements[parent].normal);
        else if (tree.is_flat(i))
            normal *= bins.hemisphere_scale(normal);
        out.elements[i].normal = glm::vec4(glm::dvec4(normal, tree.areas[i] * scale * scale));
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
        const SceneTriangle& triangle = scene.triangles[tree.triangles[i]];
        std::array<glm::dvec3, 3> whole;
        for (std::size_t k = 0; k < 3; ++k) whole[k] = scene.positions[triangle.vertex[k]];
        glm::vec2 weights[3];
        for (std::size_t k = 0; k < 3; ++k)
            weights[k] = glm::vec2(weights_at(whole, tree.corners[i][k]));
        out.patches[i].weights = {weights[0], weights[1]};
        out.patches[i].last = {weights[2], 0.0f, 0.0f};
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
