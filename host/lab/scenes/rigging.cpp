// SPDX-License-Identifier: MIT
#include "lab/scenes/rigging.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "scene/surfaces.hpp"

namespace clgi::generated {

Rig::Rig(Scene& scene, const std::string& clip, double duration) : scene_(scene) {
    scene.animation.emplace();
    scene.animation->clips.push_back({clip, duration, {}, {}});
}

std::uint32_t Rig::add_node(const std::string& name, int parent, const glm::dvec3& translation) {
    AnimatedNode node;
    node.name = name;
    node.parent = parent;
    node.translation = translation;
    joints_.push_back(translation +
                      (parent < 0 ? glm::dvec3(0.0) : joints_[static_cast<std::size_t>(parent)]));
    animation().nodes.push_back(node);
    return static_cast<std::uint32_t>(animation().nodes.size() - 1);
}

PosedRange& Rig::end_moving_part(const std::string& name, std::uint32_t node) {
    end_part(scene_, name);
    const Part& part = scene_.parts.back();
    PosedRange range;
    std::uint32_t first = UINT32_MAX, last = 0;
    for (std::uint32_t t = 0; t < part.triangle_count; ++t)
        for (const std::uint32_t vertex : scene_.triangles[part.first_triangle + t].vertex) {
            first = std::min(first, vertex);
            last = std::max(last, vertex);
        }
    range.first_vertex = first;
    range.vertex_count = last - first + 1;
    range.part = static_cast<std::uint32_t>(scene_.parts.size() - 1);
    range.node = node;
    Animation& to = animation();
    range.first_rest = static_cast<std::uint32_t>(to.rest_positions.size());
    for (std::uint32_t v = first; v <= last; ++v) {
        to.rest_positions.emplace_back(scene_.positions[v]);
        to.rest_normals.push_back(scene_.normals[v]);
    }
    to.ranges.push_back(range);
    return to.ranges.back();
}

int Rig::add_skin() {
    Skin skin;
    skin.joints.resize(joints_.size());
    std::iota(skin.joints.begin(), skin.joints.end(), 0u);
    for (const glm::dvec3& joint : joints_)
        skin.inverse_binds.push_back(glm::translate(glm::dmat4(1.0), -joint));
    animation().skins.push_back(skin);
    return static_cast<int>(animation().skins.size() - 1);
}

void Rig::follow_joints(PosedRange& range, int skin,
                        const std::vector<std::vector<double>>& weights) {
    constexpr std::uint32_t most = 4;
    std::vector<Influence>& to = animation().influences;
    range.skin = skin;
    range.influence_count = most;
    range.first_influence = to.size();
    to.resize(to.size() + std::size_t{most} * range.vertex_count);
    for (std::uint32_t v = 0; v < range.vertex_count; ++v) {
        std::vector<std::uint32_t> order(weights[v].size());
        std::iota(order.begin(), order.end(), 0u);
        std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
            return weights[v][a] > weights[v][b];
        });
        double sum = 0.0;
        for (std::uint32_t i = 0; i < most; ++i) sum += weights[v][order[i]];
        for (std::uint32_t i = 0; i < most; ++i) {
            const double share = weights[v][order[i]] / sum;
            if (share > 0.0)
                to[range.first_influence + std::uint64_t{i} * range.vertex_count + v] = {
                    order[i], static_cast<float>(share)};
        }
    }
}

void Rig::drive(std::uint32_t node, ChannelTarget target, Interpolation interpolation,
                std::uint32_t components, std::vector<float> values, std::size_t keys) {
    Curve curve;
    curve.interpolation = interpolation;
    curve.components = components;
    for (std::size_t key = 0; key < keys; ++key)
        curve.times.push_back(static_cast<float>(clip().duration * static_cast<double>(key) /
                                                 static_cast<double>(keys - 1)));
    curve.values = std::move(values);
    clip().channels.push_back({target, node, static_cast<std::uint32_t>(clip().curves.size())});
    clip().curves.push_back(std::move(curve));
}

void Rig::turn(std::uint32_t node, const std::vector<glm::dquat>& keys) {
    std::vector<float> values;
    for (const glm::dquat& q : keys)
        for (const double number : {q.x, q.y, q.z, q.w})
            values.push_back(static_cast<float>(number));
    drive(node, ChannelTarget::rotation, Interpolation::linear, 4, std::move(values), keys.size());
}

void Rig::shift(std::uint32_t node, const std::vector<glm::dvec3>& keys) {
    std::vector<float> values;
    for (const glm::dvec3& place : keys)
        for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(place[i]));
    drive(node, ChannelTarget::translation, Interpolation::linear, 3, std::move(values),
          keys.size());
}

void Rig::finish() {
    clip().duration = 0.0;
    for (const Curve& curve : clip().curves)
        clip().duration = std::max(clip().duration, double{curve.times.back()});
    Scene rest = posed(scene_, rest_pose(animation()));
    scene_.positions = std::move(rest.positions);
    scene_.normals = std::move(rest.normals);
    validate(scene_);
}

void add_tiles(Scene& scene, const std::array<int, 2>& count, int cells, double tile,
               const std::array<std::uint32_t, 2>& materials) {
    for (int odd = 0; odd < 2; ++odd) {
        for (int i = 0; i < count[0]; ++i)
            for (int k = 0; k < count[1]; ++k) {
                if ((i + k) % 2 != odd) continue;
                const auto first = static_cast<std::uint32_t>(scene.positions.size());
                const auto at = [&](int a, int b) {
                    return first + static_cast<std::uint32_t>(a * (cells + 1) + b);
                };
                for (int a = 0; a <= cells; ++a)
                    for (int b = 0; b <= cells; ++b) {
                        // Whole steps of a cell, so that neighbours meet exactly.
                        const double x = 0.5 * (2 * (i * cells + a) - count[0] * cells);
                        const double z = 0.5 * (2 * (k * cells + b) - count[1] * cells);
                        scene.positions.emplace_back(x * tile / cells, 0.0, z * tile / cells);
                        scene.normals.emplace_back(0.0f, 1.0f, 0.0f);
                    }
                for (int a = 0; a < cells; ++a)
                    for (int b = 0; b < cells; ++b) {
                        scene.triangles.push_back(
                            {{at(a, b), at(a, b + 1), at(a + 1, b + 1)}, materials[odd]});
                        scene.triangles.push_back(
                            {{at(a, b), at(a + 1, b + 1), at(a + 1, b)}, materials[odd]});
                    }
            }
        end_part(scene, odd == 0 ? "even tiles" : "odd tiles");
    }
}

void add_floor(Scene& scene, int cells, double side, std::uint32_t material) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int a = 0; a <= cells; ++a)
        for (int b = 0; b <= cells; ++b) {
            scene.positions.emplace_back((double(a) / cells - 0.5) * side, 0.0,
                                         (double(b) / cells - 0.5) * side);
            scene.normals.emplace_back(0.0f, 1.0f, 0.0f);
        }
    const auto at = [&](int a, int b) {
        return first + static_cast<std::uint32_t>(a * (cells + 1) + b);
    };
    for (int a = 0; a < cells; ++a)
        for (int b = 0; b < cells; ++b) {
            scene.triangles.push_back({{at(a, b), at(a, b + 1), at(a + 1, b + 1)}, material});
            scene.triangles.push_back({{at(a, b), at(a + 1, b + 1), at(a + 1, b)}, material});
        }
    end_part(scene, "floor");
}

void add_daylight(Scene& scene, const glm::vec3& direction, float lux) {
    Light sun;
    sun.name = "sun";
    sun.kind = Light::Kind::directional;
    sun.direction = glm::normalize(direction);
    sun.intensity = lux * glm::vec3(1.0f, 0.93f, 0.82f);
    scene.lights.push_back(sun);

    Environment sky;
    sky.width = 32;
    sky.height = 16;
    const glm::vec3 ground(0.18f, 0.16f, 0.14f), horizon(0.55f, 0.57f, 0.60f),
        zenith(0.75f, 0.90f, 1.15f);
    for (int row = 0; row < sky.height; ++row) {
        const float up = std::cos(glm::pi<float>() * (static_cast<float>(row) + 0.5f) / 16.0f);
        const glm::vec3 color = up > 0.0f ? glm::mix(horizon, zenith, std::sqrt(up))
                                          : glm::mix(horizon, ground, std::sqrt(-up));
        sky.texels.insert(sky.texels.end(), static_cast<std::size_t>(sky.width), color);
    }
    scene.environment = std::move(sky);
}

void close_rings(Scene& scene, std::uint32_t first, int rings, int sides, std::uint32_t material) {
    const auto at = [&](int ring, int side) {
        return first + static_cast<std::uint32_t>(ring * sides + side % sides);
    };
    const std::uint32_t bottom = at(rings, 0), top = bottom + 1;
    for (int side = 0; side < sides; ++side) {
        scene.triangles.push_back({{bottom, at(0, side), at(0, side + 1)}, material});
        for (int ring = 0; ring + 1 < rings; ++ring) {
            scene.triangles.push_back(
                {{at(ring, side), at(ring + 1, side), at(ring + 1, side + 1)}, material});
            scene.triangles.push_back(
                {{at(ring, side), at(ring + 1, side + 1), at(ring, side + 1)}, material});
        }
        scene.triangles.push_back({{top, at(rings - 1, side + 1), at(rings - 1, side)}, material});
    }
}

glm::dvec3 through(const std::vector<glm::dvec3>& points, double share) {
    const auto count = static_cast<int>(points.size());
    const double place = (share - std::floor(share)) * count;
    const int here = static_cast<int>(place) % count;
    const double t = place - std::floor(place);
    const auto at = [&](int i) {
        return points[static_cast<std::size_t>((here + i + count) % count)];
    };
    const glm::dvec3 from = at(0), to = at(1);
    const glm::dvec3 out = 0.5 * (to - at(-1)), in = 0.5 * (at(2) - from);
    const double t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * from + (t3 - 2.0 * t2 + t) * out +
           (3.0 * t2 - 2.0 * t3) * to + (t3 - t2) * in;
}

}  // namespace clgi::generated
