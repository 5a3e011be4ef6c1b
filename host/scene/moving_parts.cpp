// SPDX-License-Identifier: MIT
#include "scene/moving_parts.hpp"

#include <algorithm>

namespace clgi {
namespace {

// The property at rest, as curves have it.
std::vector<double> at_rest(const Animation& animation, const Channel& channel) {
    const AnimatedNode& node = animation.nodes[channel.node];
    switch (channel.target) {
        case ChannelTarget::translation:
            return {node.translation.x, node.translation.y, node.translation.z};
        case ChannelTarget::rotation:
            return {node.rotation.x, node.rotation.y, node.rotation.z, node.rotation.w};
        case ChannelTarget::scale:
            return {node.scale.x, node.scale.y, node.scale.z};
        case ChannelTarget::weights:
            break;
    }
    const auto first = animation.weights.begin() + node.first_weight;
    return {first, first + node.weight_count};
}

// Values equal the resting ones as floats, and tangents are zero: so is what lies between.
bool stays(const Curve& curve, const std::vector<double>& rest) {
    const std::size_t parts = curve.interpolation == Interpolation::cubic ? 3 : 1;
    for (std::size_t i = 0; i < curve.values.size(); ++i) {
        const std::size_t part = i / curve.components % parts;
        const bool is_value = parts == 1 || part == 1;
        const auto wanted = is_value ? static_cast<float>(rest[i % curve.components]) : 0.0f;
        if (curve.values[i] != wanted) return false;
    }
    return true;
}

bool moves(const MovingParts& parts, const Animation& animation, const PosedRange& range,
           std::uint32_t joint) {
    const bool follows_node =
        range.skin < 0 ||
        joint >= animation.skins[static_cast<std::size_t>(range.skin)].joints.size();
    const std::uint32_t node =
        follows_node ? range.node
                     : animation.skins[static_cast<std::size_t>(range.skin)].joints[joint];
    return parts.nodes[node] != 0;
}

}  // namespace

MovingParts moving_parts(const Animation& animation) {
    MovingParts out;
    out.nodes.assign(animation.nodes.size(), 0);
    out.weights.assign(animation.nodes.size(), 0);
    for (const AnimationClip& clip : animation.clips)
        for (const Channel& channel : clip.channels) {
            if (stays(clip.curves[channel.curve], at_rest(animation, channel))) continue;
            (channel.target == ChannelTarget::weights ? out.weights : out.nodes)[channel.node] = 1;
        }
    for (std::size_t node = 0; node < out.nodes.size(); ++node) {
        const int parent = animation.nodes[node].parent;  // below the node's own index
        if (parent >= 0 && out.nodes[static_cast<std::size_t>(parent)] != 0) out.nodes[node] = 1;
    }
    return out;
}

std::vector<std::uint8_t> moving_vertices(const Scene& scene) {
    std::vector<std::uint8_t> out;
    if (!scene.animation) return out;
    const Animation& animation = *scene.animation;
    const MovingParts parts = moving_parts(animation);
    out.assign(scene.positions.size(), 0);
    for (const PosedRange& range : animation.ranges) {
        const bool morphs = range.target_count > 0 && parts.weights[range.node] != 0;
        const bool placed = range.influence_count == 0 && parts.nodes[range.node] != 0;
        for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
            bool found = morphs || placed;
            for (std::uint32_t i = 0; i < range.influence_count && !found; ++i) {
                const Influence& influence =
                    animation.influences[range.first_influence +
                                         std::uint64_t{i} * range.vertex_count + v];
                found = influence.weight > 0.0f && moves(parts, animation, range, influence.joint);
            }
            if (found) out[range.first_vertex + v] = 1;
        }
    }
    if (std::find(out.begin(), out.end(), 1) == out.end()) out.clear();
    return out;
}

bool follows(const SceneTriangle& triangle, const std::vector<std::uint8_t>& moving) {
    return !moving.empty() && std::any_of(std::begin(triangle.vertex), std::end(triangle.vertex),
                                          [&](std::uint32_t v) { return moving[v] != 0; });
}

}  // namespace clgi
