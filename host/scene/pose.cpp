// Curves and nodes at a time. glTF 2.0, appendix C.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/animation.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <cstdlib>

#include "scene/node_matrix.hpp"

namespace clgi {
namespace {

using Values = std::vector<double>;

glm::dquat quaternion(const Values& xyzw) { return {xyzw[3], xyzw[0], xyzw[1], xyzw[2]}; }

Values unit(const Values& xyzw) {
    const glm::dquat q = quaternion(xyzw);
    if (!is_rotation(q)) return {0.0, 0.0, 0.0, 1.0};
    const double length = glm::length(q);
    return {q.x / length, q.y / length, q.z / length, q.w / length};
}

// On the sphere, the short way.
Values slerp(const Values& a, Values b, double share) {
    double cosine = 0.0;
    for (int i = 0; i < 4; ++i) cosine += a[i] * b[i];
    if (cosine < 0.0)
        for (double& component : b) component = -component;
    const double angle = std::acos(std::min(std::abs(cosine), 1.0));
    const double sine = std::sin(angle);
    Values out(4);
    for (int i = 0; i < 4; ++i)
        // Below this angle the chord is the arc, to a double's precision.
        out[i] =
            sine > 1e-8
                ? (a[i] * std::sin((1.0 - share) * angle) + b[i] * std::sin(share * angle)) / sine
                : a[i] + (b[i] - a[i]) * share;
    return unit(out);
}

// The first of a key's numbers: part 1 of a cubic key is its value, 0 and 2 are its tangents.
Values numbers(const Curve& curve, std::size_t key, std::size_t part) {
    const std::size_t parts = curve.interpolation == Interpolation::cubic ? 3 : 1;
    const float* first = curve.values.data() + (key * parts + part) * curve.components;
    return {first, first + curve.components};
}

Values cubic(const Curve& curve, std::size_t key, double share, double step) {
    const double t = share, t2 = t * t, t3 = t2 * t;
    const Values from = numbers(curve, key, 1), out = numbers(curve, key, 2);
    const Values in = numbers(curve, key + 1, 0), to = numbers(curve, key + 1, 1);
    Values value(curve.components);
    for (std::size_t i = 0; i < value.size(); ++i)
        value[i] = (2.0 * t3 - 3.0 * t2 + 1.0) * from[i] + step * (t3 - 2.0 * t2 + t) * out[i] +
                   (3.0 * t2 - 2.0 * t3) * to[i] + step * (t3 - t2) * in[i];
    return value;
}

glm::dmat4 local_matrix(const AnimatedNode& node) {
    return node.matrix ? *node.matrix : node_matrix(node.translation, node.rotation, node.scale);
}

Pose pose_of(const std::vector<AnimatedNode>& nodes, Values weights) {
    Pose pose;
    pose.weights = std::move(weights);
    pose.matrices.reserve(nodes.size());
    for (const AnimatedNode& node : nodes) {
        const glm::dmat4 local = local_matrix(node);
        pose.matrices.push_back(
            node.parent < 0 ? local : pose.matrices[static_cast<std::size_t>(node.parent)] * local);
    }
    return pose;
}

}  // namespace

std::vector<double> value_at(const Curve& curve, double seconds, bool rotation) {
    const std::vector<float>& times = curve.times;
    const std::size_t part = curve.interpolation == Interpolation::cubic ? 1 : 0;
    const auto whole = [&](const Values& value) { return rotation ? unit(value) : value; };
    const auto later = std::upper_bound(times.begin(), times.end(), seconds);
    if (later == times.begin()) return whole(numbers(curve, 0, part));
    const std::size_t key = static_cast<std::size_t>(later - times.begin()) - 1;
    if (later == times.end() || curve.interpolation == Interpolation::step)
        return whole(numbers(curve, key, part));

    const double step = double{times[key + 1]} - double{times[key]};
    const double share = (seconds - double{times[key]}) / step;
    if (curve.interpolation == Interpolation::cubic) return whole(cubic(curve, key, share, step));
    const Values from = numbers(curve, key, 0), to = numbers(curve, key + 1, 0);
    if (rotation) return slerp(unit(from), unit(to), share);
    Values value(from.size());
    for (std::size_t i = 0; i < value.size(); ++i)
        value[i] = from[i] * (1.0 - share) + to[i] * share;
    return value;
}

Pose rest_pose(const Animation& animation) { return pose_of(animation.nodes, animation.weights); }

Pose pose_at(const Animation& animation, std::size_t clip, double seconds) {
    if (clip >= animation.clips.size())
        throw Error("animation: clip " + std::to_string(clip) + " was asked for, there are " +
                    std::to_string(animation.clips.size()));
    if (!std::isfinite(seconds)) throw Error("animation: the time is not finite");
    std::vector<AnimatedNode> nodes = animation.nodes;
    Values weights = animation.weights;
    const AnimationClip& source = animation.clips[clip];
    for (const Channel& channel : source.channels) {
        AnimatedNode& node = nodes[channel.node];
        const bool turns = channel.target == ChannelTarget::rotation;
        const Values value = value_at(source.curves[channel.curve], seconds, turns);
        switch (channel.target) {
            case ChannelTarget::translation:
                node.translation = {value[0], value[1], value[2]};
                break;
            case ChannelTarget::rotation:
                node.rotation = quaternion(value);
                break;
            case ChannelTarget::scale:
                node.scale = {value[0], value[1], value[2]};
                break;
            case ChannelTarget::weights:
                std::copy(value.begin(), value.end(), weights.begin() + node.first_weight);
                break;
        }
    }
    return pose_of(nodes, std::move(weights));
}

std::size_t find_clip(const Animation& animation, const std::string& name_or_index) {
    const std::vector<AnimationClip>& clips = animation.clips;
    if (name_or_index.empty() && !clips.empty()) return 0;
    for (std::size_t i = 0; i < clips.size(); ++i)
        if (clips[i].name == name_or_index) return i;
    std::size_t used = 0;
    unsigned long index = 0;
    try {
        if (name_or_index.find_first_not_of("0123456789") == std::string::npos)
            index = std::stoul(name_or_index, &used);
    } catch (const std::exception&) {
        used = 0;
    }
    if (used > 0 && used == name_or_index.size() && index < clips.size()) return index;
    std::string all;
    for (std::size_t i = 0; i < std::min<std::size_t>(clips.size(), 8); ++i)
        all += (i > 0 ? ", " : "") + std::to_string(i) + " '" + clips[i].name + "'";
    if (clips.size() > 8) all += ", ...";
    throw Error("animation: '" + name_or_index + "' was asked for, there are " +
                (all.empty() ? "none" : all));
}

}  // namespace clgi
