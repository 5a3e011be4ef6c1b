// SPDX-License-Identifier: MIT
#include "methods/antiradiance/element_surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "methods/antiradiance/halve.hpp"
#include "methods/antiradiance/leaf_vertices.hpp"
#include "methods/antiradiance/patch_weights.hpp"
#include "methods/antiradiance/vertex_cells.hpp"

namespace clgi {
namespace {

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

bool is_double_sided(const Scene& scene, std::uint32_t triangle) {
    return scene.materials[scene.triangles[triangle].material].double_sided;
}

// The middles of halves of vertex patches, of those that hold the middles of four equal shares of
// the area.
void sample_vertex_patches(const ElementTree& tree, std::uint32_t leaf, bool lit,
                           const std::vector<std::uint32_t>& on_device, double scale,
                           std::vector<SurfaceSample>& out) {
    const std::uint32_t first = tree.first_patches[leaf], end = tree.first_patches[leaf + 1];
    std::vector<double> reached(2 * std::size_t{end - first});  // area up to the end of each half
    double sum = 0.0;
    for (std::uint32_t half = 0; half < reached.size(); ++half) {
        sum += 0.5 * glm::length(vector_area(tree.vertex_patches[first + half / 2]));
        reached[half] = sum;
    }
    const auto area = static_cast<float>(tree.areas[leaf] * scale * scale / leaf_samples);
    for (std::uint32_t k = 0; k < leaf_samples; ++k) {
        const double wanted = (k + 0.5) / leaf_samples * sum;
        const auto half = static_cast<std::uint32_t>(
            std::upper_bound(reached.begin(), reached.end() - 1, wanted) - reached.begin());
        const VertexPatch& vertex_patch = tree.vertex_patches[first + half / 2];
        // Corner, middle of an edge and centroid: 11, 5 and 2 of 18, in the order of the triangle.
        float weights[3] = {0.0f, 0.0f, 0.0f};
        const std::uint32_t beside = (half % 2 == 0) == !tree.backs[leaf] ? 1 : 2;
        weights[vertex_patch.corner] = 11.0f / 18.0f;
        weights[(vertex_patch.corner + beside) % 3] = 5.0f / 18.0f;
        weights[(vertex_patch.corner + 3 - beside) % 3] = 2.0f / 18.0f;
        out.push_back(
            {lit ? on_device[vertex_patch.triangle] : no_index, weights[1], weights[2], area});
    }
}

// Triangles whose leaves are at their vertices: as patches behind those of the elements, the
// corners of which are the vertices of these leaves.
void show_vertices(const ElementTree& tree, const LeafVertices& shared,
                   const std::vector<std::uint32_t>& on_device, ElementSurface& out) {
    for (std::uint32_t row = 0; row < out.leaves.size(); ++row) {
        const std::uint32_t i = out.leaves[row];
        if (!tree.is_vertex(i)) continue;
        for (std::uint32_t k = tree.first_patches[i]; k < tree.first_patches[i + 1]; ++k) {
            const std::uint32_t t = on_device[tree.vertex_patches[k].triangle];
            if (t == no_index) continue;
            TrianglePatches& root = out.roots[t];
            std::uint32_t& patch = tree.backs[i] ? root.back : root.front;
            if (patch == ELEMENT_NONE) {
                patch = static_cast<std::uint32_t>(out.patches.size());
                const float second = tree.backs[i] ? 0.0f : 1.0f, vertex_patch = 1.0f - second;
                out.patches.push_back({{0.0f, 0.0f, second, vertex_patch},
                                       {vertex_patch, second, 0.0f, 0.0f},
                                       {},
                                       0});
            }
            const std::uint32_t corner =
                tree.vertex_patches[k].corner;  // backs are wound the other way
            out.patches[patch].vertex[tree.backs[i] ? (3 - corner) % 3 : corner] =
                shared.of_vertex_patches[k];
        }
    }
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
        if (tree.is_vertex(i)) {
            const bool lit = !tree.backs[i] || is_double_sided(scene, tree.triangles[i]);
            sample_vertex_patches(tree, i, lit, on_device, scale, out.samples);
            continue;
        }
        const PatchCorners& patch = out.patches[i];
        const glm::vec2 a(patch.weights), b(patch.weights.z, patch.weights.w), c(patch.last);
        const std::uint32_t triangle = tree.triangles[i];
        const bool dark = tree.backs[i] && !is_double_sided(scene, triangle);
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
    show_vertices(tree, shared, on_device, out);
    return out;
}

// Radiance times cosine times an area of 1/2 to 1, so never more than radiance. A half holds it
// from 2^-24 to 2^16 of the frame's exposure, with all bits from 2^-14 on.
void set_row_exponents(std::vector<Element>& elements) {
    constexpr int most = 50;  // differences of two are exponents of floats as well
    for (Element& element : elements)
        if (element.normal.w > 0.0f)
            element.row_exponent = std::clamp(std::ilogb(element.normal.w) + 1, -most, most);
}

}  // namespace clgi
