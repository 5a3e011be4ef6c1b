// The triangles of a primitive, whatever its mode, and normals that are made of them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/gltf_accessor.hpp"
#include "io/gltf_primitive.hpp"

namespace clgi::io::gltf {

namespace {

constexpr std::uint32_t unused = UINT32_MAX;

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 1e-300 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

// Zero for a triangle without area. Its corners are still in the order of the file, which a
// mirroring transform has turned around.
glm::dvec3 front_of(const Corners& corner, const Pose& pose) {
    const glm::dvec3 a = pose.positions[corner[0]];
    const glm::dvec3 normal =
        unit_or_zero(glm::cross(pose.positions[corner[1]] - a, pose.positions[corner[2]] - a));
    return pose.mirrored[corner[0]] ? -normal : normal;
}

// For want of any direction, up.
glm::dvec3 or_up(const glm::dvec3& normal) {
    return normal == glm::dvec3(0.0) ? glm::dvec3(0.0, 1.0, 0.0) : normal;
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

std::vector<std::uint32_t> Renumberer::renumber(std::vector<Corners>& triangles) {
    std::vector<std::uint32_t> used;
    for (const Corners& triangle : triangles) {
        for (const std::uint32_t vertex : triangle) {
            if (vertex >= number_.size()) number_.resize(std::size_t{vertex} + 1, unused);
            if (number_[vertex] == unused) used.push_back(vertex);
            number_[vertex] = 0;
        }
    }
    std::sort(used.begin(), used.end());
    for (std::uint32_t i = 0; i < used.size(); ++i) number_[used[i]] = i;
    for (Corners& triangle : triangles) {
        for (std::uint32_t& vertex : triangle) vertex = number_[vertex];
    }
    for (const std::uint32_t vertex : used) number_[vertex] = unused;
    return used;
}

Topology triangles_of(const Document& document, const Primitive& primitive,
                      Renumberer& renumberer) {
    std::optional<AccessorReader> indices;
    if (primitive.indices >= 0)
        indices.emplace(document, document.model.accessors[primitive.indices]);
    const auto corner = [&](std::size_t i) {
        return indices ? indices->integer(i) : static_cast<std::uint32_t>(i);
    };

    Topology topology;
    const std::size_t count = triangle_count(document, primitive);
    topology.triangles.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        Corners triangle = {corner(i + 1), corner(i + 2), corner(0)};  // of a fan
        if (primitive.mode == TINYGLTF_MODE_TRIANGLES) {
            triangle = {corner(3 * i), corner(3 * i + 1), corner(3 * i + 2)};
        } else if (primitive.mode == TINYGLTF_MODE_TRIANGLE_STRIP) {
            triangle = {corner(i), corner(i + 1 + i % 2), corner(i + 2 - i % 2)};
        }
        const auto [a, b, c] = triangle;
        if (a != b && b != c && c != a) topology.triangles.push_back(triangle);
    }
    topology.vertices = renumberer.renumber(topology.triangles);
    return topology;
}

void make_flat(Topology& topology, Pose& pose) {
    Topology split;
    Pose flat;
    for (const Corners& corner : topology.triangles) {
        const glm::dvec3 normal = or_up(front_of(corner, pose));
        const auto first = static_cast<std::uint32_t>(split.vertices.size());
        split.triangles.push_back({first, first + 1, first + 2});
        for (const std::uint32_t vertex : corner) {
            split.vertices.push_back(topology.vertices[vertex]);
            flat.positions.push_back(pose.positions[vertex]);
            flat.normals.push_back(normal);
            flat.mirrored.push_back(pose.mirrored[corner[0]]);
        }
    }
    topology = std::move(split);
    pose = std::move(flat);
}

bool mend_normals(const Topology& topology, Pose& pose) {
    std::map<std::uint32_t, glm::dvec3> sums;
    for (std::uint32_t i = 0; i < pose.normals.size(); ++i) {
        if (pose.normals[i] == glm::dvec3(0.0)) sums.emplace(i, 0.0);
    }
    if (sums.empty()) return false;
    for (const Corners& corner : topology.triangles) {
        for (const std::uint32_t vertex : corner) {
            const auto sum = sums.find(vertex);
            if (sum != sums.end()) sum->second += front_of(corner, pose);
        }
    }
    for (const auto& [vertex, sum] : sums) pose.normals[vertex] = or_up(unit_or_zero(sum));
    return true;
}

}  // namespace clgi::io::gltf
