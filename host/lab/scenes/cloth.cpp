// A cloth that is shaken above a floor. [Kautz04, figure 1] shows such a scene.
//
// The cloth is a grid of 32 x 32 squares, 1,089 vertices and 2,048 triangles; the floor one of
// 16 x 16, 289 vertices and 512 triangles. Points of the grid keep their distances by position
// based dynamics in small steps: a step moves every point by its velocity, then sanitises the
// length of each edge, diagonal and double edge once. [derived: from Verlet integration with
// constraints]
// SPDX-License-Identifier: MIT
#include <cmath>
#include <glm/gtc/constants.hpp>
#include "lab/scenes/deforming.hpp"

#include "lab/scenes/rigging.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace cloth_scene {
namespace {

constexpr int cells = 32;
constexpr double side = 1.5;         // of the cloth at rest
constexpr double clip_length = 3.2;  // seconds
constexpr double step = 1.0 / 720.0;
constexpr double floor_gap = 0.015;  // between floor and cloth

struct Link {
    std::uint32_t a, b;
    double length;
    double stiffness;  // share of the error that a step sanitises
};

class Sheet {
public:
    Sheet() {
        for (int i = 0; i <= cells; ++i)
            for (int k = 0; k <= cells; ++k)
                places_.emplace_back((double(i) / cells - 0.5) * side, 0.6,
                                     (double(k) / cells - 0.5) * side);
        before_ = places_;
        for (int i = 0; i <= cells; ++i)
            for (int k = 0; k <= cells; ++k) {
                link(i, k, 1, 0, 1.0);
                link(i, k, 0, 1, 1.0);
                link(i, k, 1, 1, 0.4);
                link(i, k, 1, -1, 0.4);
                link(i, k, 2, 0, 0.06);
                link(i, k, 0, 2, 0.06);
            }
    }

    void advance(double time) {
        for (std::size_t v = 0; v < places_.size(); ++v) {
            const glm::dvec3 moved = (places_[v] - before_[v]) * (1.0 - 1.2 * step);
            before_[v] = places_[v];
            places_[v] += moved + glm::dvec3(0.0, -9.81 * step * step, 0.0);
        }
        hold(time);
        for (const Link& one : links_) {
            const glm::dvec3 between = places_[one.b] - places_[one.a];
            const double length = glm::length(between);
            const double error = (length - one.length) / length;
            const glm::dvec3 mend = between * (0.5 * one.stiffness * error);
            places_[one.a] += mend;
            places_[one.b] -= mend;
        }
        hold(time);
        for (std::size_t v = 0; v < places_.size(); ++v) {
            if (places_[v].y >= floor_gap) continue;
            places_[v].y = floor_gap;
            // Friction: what touches the floor hardly slides.
            before_[v] = glm::mix(before_[v], places_[v], 0.2);
        }
    }

    const std::vector<glm::dvec3>& places() const { return places_; }

private:
    static std::uint32_t at(int i, int k) {
        return static_cast<std::uint32_t>(i * (cells + 1) + k);
    }

    void link(int i, int k, int di, int dk, double stiffness) {
        if (i + di > cells || k + dk > cells || k + dk < 0) return;
        links_.push_back({at(i, k), at(i + di, k + dk),
                          side / cells * std::sqrt(double(di * di + dk * dk)), stiffness});
    }

    // The corners, on paths of their own that close after a clip.
    void hold(double time) {
        const double turn = 2.0 * glm::pi<double>() * time / clip_length;
        for (int corner = 0; corner < 4; ++corner) {
            const int i = corner / 2, k = corner % 2;
            const double phase = turn + (i != k ? 0.9 : 0.0) + 0.35 * corner;
            const double reach = side * (0.405 - 0.065 * std::cos(phase));
            const double lift = 0.62 + 0.12 * std::sin(phase + 0.8) + (i == 0 ? 0.10 : 0.0);
            places_[at(i * cells, k * cells)] = {(2 * i - 1) * reach, lift, (2 * k - 1) * reach};
        }
    }

    std::vector<glm::dvec3> places_, before_;
    std::vector<Link> links_;
};

using State = std::vector<glm::dvec3>;

// States of the cloth at equal times, the last followed by the first. The first clips pass until
// the motion repeats itself; over the last quarter it is led to where it began.
std::vector<State> shaken(int count) {
    Sheet sheet;
    const auto steps = static_cast<int>(std::lround(clip_length / step / count));
    const double actual = clip_length / count / steps;
    const int lead = count / 4;
    std::vector<State> states;
    for (int state = -2 * count - lead; state < count; ++state) {
        if (state >= -lead) states.push_back(sheet.places());
        for (int i = 0; i < steps; ++i) sheet.advance((state * steps + i + 1) * actual);
    }
    for (int i = 0; i < lead; ++i) {
        const double share = double(i + 1) / (lead + 1);
        const double smooth = share * share * (3.0 - 2.0 * share);
        State& late = states[static_cast<std::size_t>(count + i)];
        const State& early = states[static_cast<std::size_t>(i)];
        for (std::size_t v = 0; v < late.size(); ++v) late[v] = glm::mix(late[v], early[v], smooth);
    }
    return {states.begin() + lead, states.end()};
}

// Weights with which cubic curves lead the cloth through all states. The tangent at a state points
// from the one before to the one after it.
std::vector<float> weights_through(int states) {
    const auto targets = static_cast<std::size_t>(states - 1);
    const auto pace = static_cast<float>(0.5 * states / clip_length);
    std::vector<float> values;
    for (int key = 0; key <= states; ++key) {
        std::vector<float> weights(targets, 0.0f), tangents(targets, 0.0f);
        const auto set = [&](std::vector<float>& list, int state, float value) {
            const int wrapped = (state + states) % states;
            if (wrapped > 0) list[static_cast<std::size_t>(wrapped - 1)] = value;
        };
        set(weights, key, 1.0f);
        set(tangents, key + 1, pace);
        set(tangents, key - 1, -pace);
        for (const std::vector<float>* list : {&tangents, &weights, &tangents})
            values.insert(values.end(), list->begin(), list->end());
    }
    return values;
}

}  // namespace
}  // namespace cloth_scene

Scene cloth(const ClothOptions& options) {
    using namespace cloth_scene;
    generated::check_color("cloth", "cloth", options.cloth, 1.0);
    generated::check_color("cloth", "floor", options.floor, 1.0);
    generated::check_range("cloth", "states", options.states, 4, 96);

    Scene scene;
    scene.name = "cloth";
    const std::uint32_t floor = generated::add_material(scene, "floor", options.floor);
    const std::uint32_t fabric = generated::add_material(scene, "cloth", options.cloth);
    scene.materials[fabric].double_sided = true;
    generated::add_floor(scene, 16, 3.2, floor);

    generated::Rig rig(scene, "shake", clip_length);
    const std::uint32_t node = rig.add_node("cloth", -1, glm::dvec3(0.0));
    const std::vector<State> states = shaken(options.states);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const std::size_t count = states[0].size();
    const auto at = [&](int i, int k) {
        return first + static_cast<std::uint32_t>(i * (cells + 1) + k);
    };
    for (int i = 0; i < cells; ++i)
        for (int k = 0; k < cells; ++k) {
            scene.triangles.push_back({{at(i, k), at(i, k + 1), at(i + 1, k + 1)}, fabric});
            scene.triangles.push_back({{at(i, k), at(i + 1, k + 1), at(i + 1, k)}, fabric});
        }
    std::vector<std::vector<glm::vec3>> normals;
    scene.positions.resize(first + count);
    for (std::size_t state = states.size(); state-- > 0;) {  // the first one stays
        std::copy(states[state].begin(), states[state].end(), scene.positions.begin() + first);
        generated::smooth_normals(scene);
        normals.insert(normals.begin(), {scene.normals.begin() + first, scene.normals.end()});
    }
    PosedRange& range = rig.end_moving_part("cloth", node);
    range.target_count = static_cast<std::uint32_t>(options.states - 1);
    range.morphs_normals = true;
    std::vector<glm::vec3>& differences = rig.animation().differences;
    for (std::size_t state = 1; state < states.size(); ++state)
        for (std::size_t v = 0; v < count; ++v)
            differences.emplace_back(states[state][v] - states[0][v]);
    for (std::size_t state = 1; state < states.size(); ++state)
        for (std::size_t v = 0; v < count; ++v)
            differences.emplace_back(normals[state][v] - normals[0][v]);
    rig.animation().nodes[node].weight_count = range.target_count;
    rig.animation().weights.assign(range.target_count, 0.0);
    rig.drive(node, ChannelTarget::weights, Interpolation::cubic, range.target_count,
              weights_through(options.states), states.size() + 1);

    generated::add_daylight(scene, {-0.5f, -1.0f, -0.35f}, 2.2f);
    scene.cameras.push_back(
        generated::look_at("camera", {1.35, 1.55, 2.15}, {0.0, 0.22, 0.0}, 0.62f));
    rig.finish();
    return scene;
}

}  // namespace clgi
