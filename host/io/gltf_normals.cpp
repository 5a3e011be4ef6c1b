// SPDX-License-Identifier: MIT
#include "io/gltf_normals.hpp"

#include <cmath>
#include <map>

namespace clgi::io::gltf {

namespace {

glm::dvec3 unit_or_zero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 1e-300 && std::isfinite(length) ? v / length : glm::dvec3(0.0);
}

// Zero for a triangle without area. Its corners are still in the order of the file, which a
// mirroring transform has turned around.
glm::dvec3 front_of(const std::array<std::uint32_t, 3>& corner, const Pose& pose) {
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

void make_flat(Topology& topology, Pose& pose) {
    Topology split;
    Pose flat;
    for (const auto& corner : topology.triangles) {
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
    for (const auto& corner : topology.triangles) {
        for (const std::uint32_t vertex : corner) {
            const auto sum = sums.find(vertex);
            if (sum != sums.end()) sum->second += front_of(corner, pose);
        }
    }
    for (const auto& [vertex, sum] : sums) pose.normals[vertex] = or_up(unit_or_zero(sum));
    return true;
}

}  // namespace clgi::io::gltf
