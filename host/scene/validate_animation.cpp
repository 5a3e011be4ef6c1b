// What Scene::animation promises.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/scene.hpp>
#include <cmath>
#include <string>

#include "scene/validate.hpp"

namespace clgi {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw InputError("animation: " + what); }

void check_index(const std::string& who, const char* array, std::size_t index, std::size_t size) {
    if (index < size) return;
    refuse(who + " names " + entry(array, index) + ", there are " + std::to_string(size));
}

// That `count` values from `first` on are there.
void check_span(const std::string& who, const char* array, std::uint64_t first, std::uint64_t count,
                std::size_t size) {
    if (first <= size && count <= size - first) return;
    refuse(who + " reads " + std::to_string(count) + " " + array + " from " +
           std::to_string(first) + " on, there are " + std::to_string(size));
}

bool columns_finite(const glm::dmat4& m) {
    return is_finite(m[0]) && is_finite(m[1]) && is_finite(m[2]) && is_finite(m[3]);
}

void check_nodes(const Animation& animation) {
    for (std::size_t i = 0; i < animation.nodes.size(); ++i) {
        const AnimatedNode& node = animation.nodes[i];
        const std::string name = entry("node", i);
        if (node.parent < -1 || node.parent >= static_cast<int>(i))
            refuse(name + " has parent " + std::to_string(node.parent) + ", one before it needed");
        const glm::dvec4 turn(node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w);
        if (!is_finite(node.translation) || !is_finite(turn) || !is_finite(node.scale) ||
            (node.matrix && !columns_finite(*node.matrix)))
            refuse(name + " has a transform that is not finite");
        check_span(name, "weights", node.first_weight, node.weight_count, animation.weights.size());
    }
    for (std::size_t i = 0; i < animation.weights.size(); ++i)
        if (!std::isfinite(animation.weights[i])) refuse(entry("weight", i) + " is not finite");
}

void check_curve(const std::string& name, const Curve& curve) {
    if (curve.components == 0 || curve.times.empty()) refuse(name + " has no keys");
    const std::size_t parts = curve.interpolation == Interpolation::cubic ? 3 : 1;
    const std::size_t needed = curve.times.size() * parts * curve.components;
    if (curve.values.size() != needed)
        refuse(name + " has " + std::to_string(curve.values.size()) + " numbers, " +
               std::to_string(needed) + " needed");
    for (std::size_t key = 0; key < curve.times.size(); ++key)
        if (!std::isfinite(curve.times[key]) ||
            (key > 0 && !(curve.times[key] > curve.times[key - 1])))
            refuse(name + " has key times that do not rise at key " + std::to_string(key));
    const auto finite = [](float value) { return std::isfinite(value); };
    if (!std::all_of(curve.values.begin(), curve.values.end(), finite))
        refuse(name + " has values that are not finite");
}

void check_clips(const Animation& animation) {
    for (std::size_t i = 0; i < animation.clips.size(); ++i) {
        const AnimationClip& clip = animation.clips[i];
        for (std::size_t c = 0; c < clip.curves.size(); ++c)
            check_curve(entry("clip", i) + ", " + entry("curve", c), clip.curves[c]);
        for (std::size_t c = 0; c < clip.channels.size(); ++c) {
            const Channel& channel = clip.channels[c];
            const std::string name = entry("clip", i) + ", " + entry("channel", c);
            check_index(name, "node", channel.node, animation.nodes.size());
            check_index(name, "curve", channel.curve, clip.curves.size());
            std::size_t needed = channel.target == ChannelTarget::rotation ? 4 : 3;
            if (channel.target == ChannelTarget::weights)
                needed = animation.nodes[channel.node].weight_count;
            const std::size_t components = clip.curves[channel.curve].components;
            if (components != needed)
                refuse(name + " has a curve of " + std::to_string(components) + " components, " +
                       std::to_string(needed) + " needed");
        }
    }
}

void check_skins(const Animation& animation) {
    for (std::size_t i = 0; i < animation.skins.size(); ++i) {
        const Skin& skin = animation.skins[i];
        const std::string name = entry("skin", i);
        if (skin.inverse_binds.size() != skin.joints.size())
            refuse(name + " has " + std::to_string(skin.inverse_binds.size()) +
                   " inverse bind matrices for " + std::to_string(skin.joints.size()) + " joints");
        for (const std::uint32_t joint : skin.joints)
            check_index(name, "node", joint, animation.nodes.size());
        for (const glm::dmat4& matrix : skin.inverse_binds)
            if (!columns_finite(matrix))
                refuse(name + " has an inverse bind matrix that is not finite");
    }
}

void check_influences(const Animation& animation, const PosedRange& range,
                      const std::string& name) {
    const std::uint64_t count = std::uint64_t{range.influence_count} * range.vertex_count;
    check_span(name, "influences", range.first_influence, count, animation.influences.size());
    if (range.skin < 0 && count > 0) refuse(name + " has influences, but no skin");
    if (range.skin < 0) return;
    check_index(name, "skin", static_cast<std::size_t>(range.skin), animation.skins.size());
    const std::size_t joints = animation.skins[static_cast<std::size_t>(range.skin)].joints.size();
    for (std::uint32_t v = 0; v < range.vertex_count && count > 0; ++v) {
        float sum = 0.0f;
        for (std::uint32_t i = 0; i < range.influence_count; ++i) {
            const Influence& influence =
                animation
                    .influences[range.first_influence + std::uint64_t{i} * range.vertex_count + v];
            check_index(name, "joint", influence.joint, joints + 1);
            if (!(influence.weight >= 0.0f)) refuse(name + " has a weight below 0");
            sum += influence.weight;
        }
        // 1e-3: weights of 8 or 16 bits that were made to sum to 1 by another hand.
        if (!(std::abs(sum - 1.0f) <= 1e-3f))
            refuse(name + " has weights of vertex " + std::to_string(v) + " that sum to " +
                   std::to_string(sum));
    }
}

// Each corner of a flat range writes the normal of its triangle to its vertex.
void check_flat(const PosedRange& range, const Scene& scene, const std::string& name) {
    std::vector<bool> used(range.vertex_count, false);
    const Part& part = scene.parts[range.part];
    for (std::uint32_t t = 0; t < part.triangle_count; ++t)
        for (const std::uint32_t vertex : scene.triangles[part.first_triangle + t].vertex) {
            if (used[vertex - range.first_vertex])
                refuse(name + " is flat, and two corners use " + entry("vertex", vertex));
            used[vertex - range.first_vertex] = true;
        }
}

void check_range(const Animation& animation, const PosedRange& range, const Scene& scene,
                 const std::string& name) {
    const std::size_t vertices = range.vertex_count;
    check_span(name, "vertices", range.first_vertex, vertices, scene.positions.size());
    check_span(name, "rest positions", range.first_rest, vertices, animation.rest_positions.size());
    check_span(name, "rest normals", range.first_rest, vertices, animation.rest_normals.size());
    check_index(name, "part", range.part, scene.parts.size());
    check_index(name, "node", range.node, animation.nodes.size());
    if (!columns_finite(range.placement) || !is_finite(range.centre))
        refuse(name + " has a placement or centre that is not finite");
    const Part& part = scene.parts[range.part];
    for (std::uint32_t t = 0; t < part.triangle_count; ++t)
        for (const std::uint32_t vertex : scene.triangles[part.first_triangle + t].vertex)
            if (vertex < range.first_vertex || vertex - range.first_vertex >= vertices)
                refuse(name + " does not have all vertices of " + entry("part", range.part));
    if (range.flat) check_flat(range, scene, name);
    check_influences(animation, range, name);
    if (range.target_count > animation.nodes[range.node].weight_count)
        refuse(name + " has " + std::to_string(range.target_count) + " morph targets, its node " +
               std::to_string(animation.nodes[range.node].weight_count) + " weights");
    const std::uint64_t rows = std::uint64_t{range.target_count} * (range.morphs_normals ? 2 : 1);
    check_span(name, "differences", range.first_difference, rows * vertices,
               animation.differences.size());
}

void check_vectors(const char* array, const std::vector<glm::vec3>& vectors) {
    for (std::size_t i = 0; i < vectors.size(); ++i)
        if (!is_finite(vectors[i])) refuse(entry(array, i) + " is not finite");
}

}  // namespace

void validate_animation(const Animation& animation, const Scene& scene) {
    check_nodes(animation);
    check_clips(animation);
    check_skins(animation);
    std::size_t end = 0;
    for (std::size_t i = 0; i < animation.ranges.size(); ++i) {
        const PosedRange& range = animation.ranges[i];
        const std::string name = entry("range", i);
        if (range.first_vertex < end) refuse(name + " begins before the last one ends");
        check_range(animation, range, scene, name);
        end = std::size_t{range.first_vertex} + range.vertex_count;
    }
    check_vectors("rest position", animation.rest_positions);
    check_vectors("rest normal", animation.rest_normals);
    check_vectors("difference", animation.differences);
    for (std::size_t i = 0; i < animation.lights.size(); ++i) {
        check_index("a carried light", "light", animation.lights[i].index, scene.lights.size());
        check_index("a carried light", "node", animation.lights[i].node, animation.nodes.size());
    }
    for (std::size_t i = 0; i < animation.cameras.size(); ++i) {
        check_index("a carried camera", "camera", animation.cameras[i].index, scene.cameras.size());
        check_index("a carried camera", "node", animation.cameras[i].node, animation.nodes.size());
    }
}

}  // namespace clgi
