// SPDX-License-Identifier: MIT
#include "io/gltf_topology.hpp"

#include <algorithm>
#include <optional>

#include "io/gltf_accessor.hpp"

namespace clgi::io::gltf {

namespace {

// Renumbers vertices in the order of their ids. A table is faster; but a primitive of one triangle
// may point into an array of millions, and thousands of primitives into the same one.
void renumber(Topology& topology, std::size_t vertex_count) {
    std::vector<std::uint32_t>& used = topology.vertices;
    const std::size_t corners = topology.triangles.size() * 3;
    if (vertex_count <= corners * 4) {
        constexpr std::uint32_t unused = UINT32_MAX;
        std::vector<std::uint32_t> number(vertex_count, unused);
        for (const auto& triangle : topology.triangles) {
            for (const std::uint32_t vertex : triangle) number[vertex] = 0;
        }
        for (std::uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
            if (number[vertex] == unused) continue;
            number[vertex] = static_cast<std::uint32_t>(used.size());
            used.push_back(vertex);
        }
        for (auto& triangle : topology.triangles) {
            for (std::uint32_t& vertex : triangle) vertex = number[vertex];
        }
        return;
    }
    for (const auto& triangle : topology.triangles) {
        used.insert(used.end(), triangle.begin(), triangle.end());
    }
    std::sort(used.begin(), used.end());
    used.erase(std::unique(used.begin(), used.end()), used.end());
    for (auto& triangle : topology.triangles) {
        for (std::uint32_t& vertex : triangle) {
            const auto found = std::lower_bound(used.begin(), used.end(), vertex);
            vertex = static_cast<std::uint32_t>(found - used.begin());
        }
    }
}

}  // namespace

std::size_t triangle_count(const Document& document, const Primitive& primitive) {
    const int position = attribute(primitive.attributes, "POSITION");
    if (position < 0 || primitive.mode < TINYGLTF_MODE_TRIANGLES) return 0;
    const int source = primitive.indices >= 0 ? primitive.indices : position;
    const std::size_t corners = document.model.accessors[source].count;
    if (primitive.mode == TINYGLTF_MODE_TRIANGLES) return corners / 3;
    return std::max<std::size_t>(corners, 2) - 2;  // of a strip or a fan
}

Topology triangles_of(const Document& document, const Primitive& primitive) {
    std::optional<AccessorReader> indices;
    if (primitive.indices >= 0) indices.emplace(document, primitive.indices);
    const auto corner = [&](std::size_t i) {
        return indices ? indices->integer(i) : static_cast<std::uint32_t>(i);
    };

    Topology topology;
    const std::size_t count = triangle_count(document, primitive);
    topology.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        std::array<std::uint32_t, 3> triangle;
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            triangle = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
        } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            triangle = {corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)};
        } else {
            triangle = {corner(i + 1), corner(i + 2), corner(0)};
        }
        const auto [a, b, c] = triangle;
        if (a != b && b != c && c != a) topology.triangles.push_back(triangle);
    }
    const int position = attribute(primitive.attributes, "POSITION");
    renumber(topology, document.model.accessors[position].count);
    return topology;
}

}  // namespace clgi::io::gltf
