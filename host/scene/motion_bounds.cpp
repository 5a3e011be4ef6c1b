// range_matrices and motion_bounds: what the matrices of a pose do to whole groups of vertices.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/scene.hpp>
#include <cmath>

#include "scene/range_matrices.hpp"

namespace clgi {
namespace {

constexpr std::size_t most_keys = 10000, most_moments = 1000;  // with times between keys
constexpr std::size_t most_steps = std::size_t{1} << 22;       // over all samples: a second of work

struct Box {
    glm::dvec3 low = glm::dvec3(INFINITY);
    glm::dvec3 high = glm::dvec3(-INFINITY);

    bool empty() const { return !(low.x <= high.x); }
    void add(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
};

// Around what every matrix places; and around what each target adds at a weight of 1.
struct RangeBoxes {
    std::vector<Box> rest;
    std::vector<Box> targets;
};

RangeBoxes boxes_of(const Animation& animation, const PosedRange& range) {
    RangeBoxes out;
    const std::size_t joints =
        range.skin < 0 ? 0 : animation.skins[static_cast<std::size_t>(range.skin)].joints.size();
    out.rest.resize(joints + 1);
    out.targets.resize(range.target_count);
    for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
        const glm::dvec3 at = animation.rest_positions[range.first_rest + v];
        if (range.influence_count == 0) out.rest.back().add(at);
        for (std::uint32_t i = 0; i < range.influence_count; ++i) {
            const Influence& influence =
                animation
                    .influences[range.first_influence + std::uint64_t{i} * range.vertex_count + v];
            if (influence.weight > 0.0f) out.rest[influence.joint].add(at);
        }
        for (std::uint32_t t = 0; t < range.target_count; ++t)
            out.targets[t].add(animation.differences[range.first_difference +
                                                     std::uint64_t{t} * range.vertex_count + v]);
    }
    return out;
}

// A vertex lies between the places that its joints give it, so the box around those holds it.
void add(const RangeBoxes& boxes, const std::vector<glm::dmat4>& matrices, const double* weights,
         Box& out) {
    glm::dvec3 below(0.0), above(0.0);
    for (std::size_t t = 0; t < boxes.targets.size(); ++t) {
        const glm::dvec3 a = weights[t] * boxes.targets[t].low;
        const glm::dvec3 b = weights[t] * boxes.targets[t].high;
        below += glm::min(a, b);
        above += glm::max(a, b);
    }
    for (std::size_t m = 0; m < matrices.size(); ++m) {
        if (boxes.rest[m].empty()) continue;
        const glm::dvec3 low = boxes.rest[m].low + below, high = boxes.rest[m].high + above;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1) ? high.x : low.x, (corner & 2) ? high.y : low.y,
                               (corner & 4) ? high.z : low.z);
            const glm::dvec3 placed(matrices[m] * glm::dvec4(p, 1.0));
            if (glm::length(placed) <= 1e18) out.add(placed);  // others are refused or left behind
        }
    }
}

// `count` of them or all, evenly, the first and the last one among them. count >= 2.
std::vector<double> even_choice(const std::vector<double>& all, std::size_t count) {
    if (all.size() <= count) return all;
    std::vector<double> out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(all[i * (all.size() - 1) / (count - 1)]);
    return out;
}

// All keys, then up to three times between any two; at most `most`.
std::vector<double> sample_times(const AnimationClip& clip, std::size_t most) {
    std::vector<bool> used(clip.curves.size());  // channels may share a curve
    for (const Channel& channel : clip.channels) used[channel.curve] = true;
    std::vector<double> keys;
    for (std::size_t curve = 0; curve < used.size(); ++curve)
        if (used[curve])
            keys.insert(keys.end(), clip.curves[curve].times.begin(),
                        clip.curves[curve].times.end());
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<double> out = even_choice(keys, std::min(most, most_keys));
    const std::size_t left =
        std::min(most, most_moments) - std::min({most, most_moments, out.size()});
    std::vector<double> between;
    for (std::size_t key = 0; key + 1 < out.size(); ++key)
        for (int i = 1; i < 4; ++i)
            between.push_back(out[key] + (out[key + 1] - out[key]) * 0.25 * i);
    if (left < 2) return out;
    between = even_choice(between, left);
    out.insert(out.end(), between.begin(), between.end());
    return out;
}

}  // namespace

std::vector<glm::dmat4> range_matrices(const Animation& animation, const PosedRange& range,
                                       const Pose& pose) {
    const auto from_centre = [&](glm::dmat4 matrix) {
        matrix[3] = matrix * glm::dvec4(range.centre, 1.0);
        return matrix;
    };
    std::vector<glm::dmat4> out;
    if (range.skin >= 0) {
        const Skin& skin = animation.skins[static_cast<std::size_t>(range.skin)];
        for (std::size_t j = 0; j < skin.joints.size(); ++j)
            out.push_back(from_centre(pose.matrices[skin.joints[j]] * skin.inverse_binds[j]));
    }
    out.push_back(from_centre(pose.matrices[range.node] * range.placement));
    return out;
}

std::optional<Bounds> motion_bounds(const Scene& scene, std::size_t clip) {
    if (!scene.animation || scene.animation->ranges.empty()) return std::nullopt;
    const Animation& animation = *scene.animation;
    std::vector<RangeBoxes> boxes;
    std::size_t steps = animation.nodes.size();  // of a sample
    for (const Channel& channel : animation.clips[clip].channels)
        steps += animation.clips[clip].curves[channel.curve].components;
    for (const PosedRange& range : animation.ranges) {
        boxes.push_back(boxes_of(animation, range));
        steps += boxes.back().rest.size() + boxes.back().targets.size();
    }
    Box box;
    const auto add_pose = [&](const Pose& pose) {
        for (std::size_t r = 0; r < boxes.size(); ++r) {
            const PosedRange& range = animation.ranges[r];
            add(boxes[r], range_matrices(animation, range, pose),
                pose.weights.data() + animation.nodes[range.node].first_weight, box);
        }
    };
    const std::size_t most = std::max<std::size_t>(most_steps / steps, 2);
    add_pose(pose_at(animation, clip, 0.0));
    for (const double time : sample_times(animation.clips[clip], most))
        add_pose(pose_at(animation, clip, time));
    if (box.empty()) return std::nullopt;
    const glm::dvec3 margin = (box.high - box.low) / 16.0;
    return Bounds{box.low - margin, box.high + margin};
}

}  // namespace clgi
