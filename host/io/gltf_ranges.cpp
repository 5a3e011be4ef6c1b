// The rest pose of vertices that move: what their primitive says, before nodes, skins and morph
// targets place them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "io/gltf_accessor.hpp"
#include "io/gltf_animation.hpp"
#include "scene/normals.hpp"

namespace clgi::io::gltf {

namespace {

bool is_finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// Of the triangles around each vertex, in the mesh's own space.
std::vector<glm::dvec3> triangle_normals(const Topology& topology,
                                         const std::vector<glm::dvec3>& positions) {
    std::vector<glm::dvec3> sums(positions.size());
    for (const Corners& corner : topology.triangles) {
        const glm::dvec3 a = positions[corner[0]];
        const glm::dvec3 normal =
            unit_or_zero(glm::cross(positions[corner[1]] - a, positions[corner[2]] - a));
        for (const std::uint32_t vertex : corner) sums[vertex] += normal;
    }
    return sums;
}

}  // namespace

bool AnimationReader::is_skinned(const AppendedPart& part) const {
    return document_.model.nodes[part.node].skin >= 0 &&
           attribute(part.primitive.attributes, "JOINTS_0") >= 0;
}

bool AnimationReader::is_moved(const AppendedPart& part) {
    if (moving_[part.node] || morphing_[part.node]) return true;
    if (!is_skinned(part)) return false;
    const int skin = document_.model.nodes[part.node].skin;
    const auto [found, fresh] = moving_skins_.try_emplace(skin);
    if (fresh) {
        const std::vector<int>& joints = document_.model.skins[skin].joints;
        found->second =
            std::any_of(joints.begin(), joints.end(), [&](int joint) { return moving_[joint]; });
    }
    return found->second;
}

void AnimationReader::read_rest(const AppendedPart& part, PosedRange& range) {
    const std::vector<std::uint32_t>& vertices = part.topology.vertices;
    const auto positions = reader_of(document_, part.primitive.attributes, "POSITION");
    std::vector<glm::dvec3> places;
    for (const std::uint32_t vertex : vertices) places.push_back(positions->vector<3>(vertex));
    glm::dvec3 low = places[0], high = places[0];
    for (const glm::dvec3& place : places) {
        low = glm::min(low, place);
        high = glm::max(high, place);
    }
    range.centre = 0.5 * low + 0.5 * high;
    for (const glm::dvec3& place : places) out_.rest_positions.emplace_back(place - range.centre);

    const auto normals = reader_of(document_, part.primitive.attributes, "NORMAL");
    std::vector<glm::dvec3> sanitised;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        glm::dvec3 normal(0.0, 1.0, 0.0);  // of a flat range, which does not read it
        if (normals) normal = unit_or_zero(normals->vector<3>(vertices[i]));
        if (normal == glm::dvec3(0.0)) {
            if (sanitised.empty()) sanitised = triangle_normals(part.topology, places);
            normal = unit_or_zero(sanitised[i]);
            if (normal == glm::dvec3(0.0)) normal.y = 1.0;
        }
        out_.rest_normals.emplace_back(normal);
    }
}

void AnimationReader::read_influences(const AppendedPart& part, PosedRange& range) {
    if (!is_skinned(part)) return;
    const int skin = document_.model.nodes[part.node].skin;
    const auto joint_count = static_cast<std::uint32_t>(document_.model.skins[skin].joints.size());
    std::vector<AccessorReader> joints, weights;
    while (const auto set = reader_of(document_, part.primitive.attributes,
                                      "JOINTS_" + std::to_string(joints.size()))) {
        const std::string name = "WEIGHTS_" + std::to_string(joints.size());
        weights.push_back(*reader_of(document_, part.primitive.attributes, name));
        joints.push_back(*set);
    }
    const std::vector<std::uint32_t>& vertices = part.topology.vertices;
    const auto read = [&](std::uint32_t vertex) {
        std::vector<std::pair<std::uint32_t, double>> found;
        double total = 0.0;
        for (std::size_t i = 0; i < 4 * joints.size(); ++i) {
            const double weight = weights[i / 4].number(vertex, i % 4);
            if (!(weight > 0.0) || !std::isfinite(weight)) continue;
            found.emplace_back(joints[i / 4].integer(vertex, i % 4), weight);
            total += weight;
        }
        for (auto& [joint, weight] : found) weight /= total;
        if (found.empty()) found.emplace_back(joint_count, 1.0);
        return found;
    };
    std::size_t most = 0;
    for (const std::uint32_t vertex : vertices) most = std::max(most, read(vertex).size());
    if (!spend(2 * most * vertices.size())) return;

    const auto [found, fresh] = skins_.try_emplace(skin, static_cast<int>(skins_.size()));
    if (fresh)
        for (const int joint : document_.model.skins[skin].joints) need(joint);
    range.skin = found->second;
    range.influence_count = static_cast<std::uint32_t>(most);
    range.first_influence = out_.influences.size();
    out_.influences.resize(out_.influences.size() + most * vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v) {
        Influence* of_vertex = out_.influences.data() + range.first_influence + v;
        for (const auto& [joint, weight] : read(vertices[v])) {
            *of_vertex = {joint, static_cast<float>(weight)};
            of_vertex += vertices.size();
        }
    }
}

void AnimationReader::read_differences(const AppendedPart& part, PosedRange& range) {
    const std::vector<Attributes>& targets = part.primitive.targets;
    if (targets.empty()) return;
    const auto has_normals = [](const Attributes& target) { return target.contains("NORMAL"); };
    range.morphs_normals = !part.flat && std::any_of(targets.begin(), targets.end(), has_normals);
    const std::vector<std::uint32_t>& vertices = part.topology.vertices;
    const std::size_t values = targets.size() * vertices.size();
    if (!spend((range.morphs_normals ? 6 : 3) * values)) return;
    range.target_count = static_cast<std::uint32_t>(targets.size());
    range.first_difference = out_.differences.size();
    const auto read = [&](const char* name) {
        for (const Attributes& target : targets) {
            const auto reader = reader_of(document_, target, name);
            for (const std::uint32_t vertex : vertices) {
                const glm::dvec3 value = reader ? reader->vector<3>(vertex) : glm::dvec3(0.0);
                out_.differences.emplace_back(is_finite(value) ? value : glm::dvec3(0.0));
            }
        }
    };
    read("POSITION");
    if (range.morphs_normals) read("NORMAL");
}

void AnimationReader::add(const AppendedPart& part, const Scene& scene) {
    if (!active_ || !is_moved(part)) return;
    // A skinned range has a matrix for each joint of its skin in every pose.
    const int skin = is_skinned(part) ? document_.model.nodes[part.node].skin : -1;
    const std::size_t joints = skin < 0 ? 0 : document_.model.skins[skin].joints.size();
    if (!spend(6 * part.topology.vertices.size() + 16 * joints)) return;
    PosedRange range;
    range.vertex_count = static_cast<std::uint32_t>(part.topology.vertices.size());
    range.first_vertex = static_cast<std::uint32_t>(scene.positions.size()) - range.vertex_count;
    range.part = static_cast<std::uint32_t>(scene.parts.size() - 1);
    range.node = static_cast<std::uint32_t>(part.node);
    range.flat = part.flat;
    range.placement = part.copy;
    range.first_rest = static_cast<std::uint32_t>(out_.rest_positions.size());
    need(part.node);
    read_rest(part, range);
    read_influences(part, range);
    read_differences(part, range);
    if (active_)
        out_.ranges.push_back(range);
    else
        out_ = {};
}

}  // namespace clgi::io::gltf
