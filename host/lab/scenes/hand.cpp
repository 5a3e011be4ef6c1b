// A hand that closes to a fist. [Kautz04, figure 1] shows a hand.
//
// The hand is one closed surface of 7,020 vertices and 14,036 triangles; five nails are open sheets
// of 3 x 3 squares, 80 vertices and 90 triangles; the table has 8 x 12 tiles of 3 x 3 squares,
// 1,536 vertices and 1,728 triangles.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include "lab/scenes/deforming.hpp"

#include "lab/scenes/flesh.hpp"
#include "scene/surfaces.hpp"

namespace clgi {
namespace hand_scene {
namespace {

constexpr double clip_length = 4.0;  // seconds
constexpr int keys = 61;
constexpr std::size_t hand_vertices = 7020;
const glm::dvec3 palm_side(0.0, 0.0, 1.0);

// A finger from its knuckle on: where its joints and its tip are, in metres, and how thick it is.
struct Finger {
    const char* name;
    glm::dvec3 joints[4];
    double radii[4];
    double delay;  // seconds after the first finger
};

const Finger fingers[] = {
    {"thumb",
     {{0.023, 0.112, 0.009}, {0.050, 0.146, 0.020}, {0.069, 0.171, 0.025}, {0.082, 0.193, 0.028}},
     {0.0150, 0.0122, 0.0112, 0.0085},
     0.30},
    {"index",
     {{0.0316, 0.1915, 0.0}, {0.0396, 0.2355, 0.0}, {0.0436, 0.2620, 0.0}, {0.0465, 0.2820, 0.0}},
     {0.0114, 0.0102, 0.0092, 0.0077},
     0.18},
    {"middle",
     {{0.0090, 0.1990, -0.001},
      {0.0102, 0.2490, -0.001},
      {0.0107, 0.2800, 0.0},
      {0.011, 0.302, 0.0}},
     {0.0117, 0.0105, 0.0095, 0.0079},
     0.12},
    {"ring",
     {{-0.0130, 0.1930, 0.0}, {-0.0176, 0.2385, 0.0}, {-0.0202, 0.2670, 0.0}, {-0.022, 0.288, 0.0}},
     {0.0112, 0.0100, 0.0091, 0.0076},
     0.06},
    {"little",
     {{-0.0335, 0.1800, 0.002},
      {-0.0425, 0.2140, 0.002},
      {-0.0480, 0.2345, 0.002},
      {-0.0525, 0.2510, 0.002}},
     {0.0099, 0.0088, 0.0080, 0.0068},
     0.0},
};

const glm::dvec3 wrist(0.0, 0.090, 0.0);

// Joints: 0 forearm, 1 palm, then three of each finger.
std::uint32_t joint(std::size_t finger, std::size_t k) {
    return static_cast<std::uint32_t>(2 + 3 * finger + k);
}

generated::Flesh flesh() {
    generated::Flesh out;
    out.blend = 0.0017;
    const auto add = [&](std::uint32_t of, const glm::dvec3& a, const glm::dvec3& b, double p,
                         double q) {
        out.bones.push_back({of, a, b, p, q});
    };
    for (const double x : {-0.011, 0.0, 0.011}) {
        add(0, {1.15 * x, 0.026, -0.002}, {0.95 * x, 0.088, 0.0}, 0.0205, 0.0180);
        add(1, {0.95 * x, 0.090, 0.0}, {1.2 * x, 0.108, 0.0}, 0.0172, 0.0150);
    }
    for (std::size_t finger = 1; finger < 5; ++finger) {
        const glm::dvec3 knuckle = fingers[finger].joints[0];
        const glm::dvec3 root(0.62 * knuckle.x, 0.108, -0.001);
        add(1, root, knuckle, 0.0140, fingers[finger].radii[0]);
        if (finger == 1) continue;
        const glm::dvec3 beside = fingers[finger - 1].joints[0];
        add(1, 0.5 * (root + glm::dvec3(0.62 * beside.x, 0.108, -0.001)),
            0.5 * (knuckle + beside) - glm::dvec3(0.0, 0.006, 0.0), 0.0140, 0.0100);
    }
    // The balls of the thumb and of the little finger.
    add(1, {0.018, 0.112, 0.007}, {0.030, 0.140, 0.009}, 0.0150, 0.0130);
    add(1, {-0.022, 0.112, 0.006}, {-0.031, 0.160, 0.006}, 0.0135, 0.0100);
    for (std::size_t finger = 0; finger < 5; ++finger)
        for (std::size_t k = 0; k < 3; ++k) {
            const Finger& f = fingers[finger];
            const std::uint32_t of = joint(finger, k);
            add(of, f.joints[k], f.joints[k + 1], f.radii[k], f.radii[k + 1]);
            // Pads on the side of the palm.
            const glm::dvec3 pad = glm::mix(f.joints[k], f.joints[k + 1], 0.5) + 0.0010 * palm_side;
            add(of, pad, glm::mix(pad, f.joints[k + 1], 0.3), 0.93 * f.radii[k + 1],
                0.90 * f.radii[k + 1]);
        }
    return out;
}

double eased(double share) {
    const double s = std::clamp(share, 0.0, 1.0);
    return s * s * s * (s * (6.0 * s - 15.0) + 10.0);
}

// How far a finger is closed: open at both ends of the clip.
double closed(double time, double delay) {
    return eased((time - 0.35 - delay) / 1.1) - eased((time - 2.55 - 0.6 * delay) / 1.05);
}

glm::dquat arc(const glm::dvec3& from, const glm::dvec3& to) {
    const glm::dvec3 a = glm::normalize(from), b = glm::normalize(to);
    return glm::normalize(glm::dquat(1.0 + glm::dot(a, b), glm::cross(a, b)));
}

// The turns of a finger's joints to their parents, by how far it is closed.
std::array<glm::dquat, 3> turns_of(const Finger& finger, bool thumb, double share) {
    const auto part = [&](std::size_t k) { return finger.joints[k + 1] - finger.joints[k]; };
    std::array<glm::dquat, 3> turns;
    if (thumb) {
        // Across the fingers, over their middle parts.
        const glm::dvec3 to[3] = {{0.22, 0.72, 0.66}, {-0.36, 0.52, 0.78}, {-0.88, 0.42, 0.22}};
        glm::dquat before(1.0, 0.0, 0.0, 0.0);
        for (std::size_t k = 0; k < 3; ++k) {
            const glm::dquat now =
                glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0), arc(part(k), to[k]), share);
            turns[k] = glm::inverse(before) * now;
            before = now;
        }
        return turns;
    }
    const double bends[3] = {1.42, 1.72, 1.15};  // radians
    const glm::dvec3 axis = glm::normalize(glm::cross(part(0), palm_side));
    const glm::dquat straight = glm::slerp(glm::dquat(1.0, 0.0, 0.0, 0.0),
                                           arc(part(0), {0.25 * part(0).x, part(0).y, 0.0}), share);
    for (std::size_t k = 0; k < 3; ++k) turns[k] = glm::angleAxis(bends[k] * share, axis);
    turns[0] = straight * turns[0];
    return turns;
}

void add_nail(Scene& scene, const generated::Flesh& flesh, const Finger& finger,
              std::uint32_t material) {
    const glm::dvec3 from = finger.joints[2], axis = finger.joints[3] - from;
    glm::dvec3 back = -palm_side;
    if (&finger == fingers) back = {0.45, -0.35, -0.82};  // of the thumb
    const glm::dvec3 along = glm::normalize(axis);
    back = glm::normalize(back - along * glm::dot(back, along));
    const glm::dvec3 across = glm::cross(along, back);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k) {
            const double angle = 0.85 * (2.0 * k / 3.0 - 1.0);
            const double far = 0.45 + 0.65 * i / 3.0 - 0.10 * std::abs(angle);
            const glm::dvec3 out = back * std::cos(angle) + across * std::sin(angle);
            scene.positions.push_back(flesh.leave(from + far * axis, out, 0.0005));
        }
    for (std::uint32_t i = 0; i < 3; ++i)
        for (std::uint32_t k = 0; k < 3; ++k) {
            const std::uint32_t a = first + 4 * i + k, b = a + 1, c = a + 5, d = a + 4;
            scene.triangles.push_back({{a, b, c}, material});
            scene.triangles.push_back({{a, c, d}, material});
        }
}

}  // namespace
}  // namespace hand_scene

Scene hand_like(const HandOptions& options) {
    using namespace hand_scene;
    generated::check_color("hand-like", "skin", options.skin, 1.0);
    generated::check_range("hand-like", "roughness", options.roughness, 0.05, 1.0);

    Scene scene;
    scene.name = "hand-like";
    const std::uint32_t light = generated::add_material(scene, "light tile", {0.66f, 0.64f, 0.60f});
    const std::uint32_t dark = generated::add_material(scene, "dark tile", {0.36f, 0.43f, 0.47f});
    const std::uint32_t skin = generated::add_material(scene, "skin", options.skin);
    const std::uint32_t nail =
        generated::add_material(scene, "nail", glm::min(1.25f * options.skin, glm::vec3(0.95f)));
    for (const std::uint32_t material : {skin, nail}) {
        scene.materials[material].roughness = options.roughness;
        scene.materials[material].specular = options.roughness < 1.0f ? 1.0f : 0.0f;
    }
    generated::add_tiles(scene, {8, 12}, 3, 0.05, {light, dark});

    generated::Rig rig(scene, "fist", clip_length);
    std::vector<int> parents;
    const auto add_node = [&](const std::string& name, int parent, const glm::dvec3& at,
                              const glm::dvec3& from) {
        parents.push_back(parent);
        return rig.add_node(name, parent, at - from);
    };
    add_node("forearm", -1, glm::dvec3(0.0), glm::dvec3(0.0));
    const std::uint32_t palm = add_node("palm", 0, wrist, glm::dvec3(0.0));
    for (const Finger& finger : fingers)
        for (std::size_t k = 0; k < 3; ++k)
            add_node(std::string(finger.name) + " " + std::to_string(k + 1),
                     k == 0 ? static_cast<int>(palm) : static_cast<int>(parents.size()) - 1,
                     finger.joints[k], k == 0 ? wrist : finger.joints[k - 1]);
    const int joints = rig.add_skin();

    const generated::Flesh body = flesh();
    const generated::FleshMesh mesh = generated::mesh_of(body, hand_vertices);
    const std::vector<std::vector<double>> weights = generated::weights_of(body, mesh, parents, 6);
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    scene.positions.insert(scene.positions.end(), mesh.positions.begin(), mesh.positions.end());
    for (const auto& [a, b, c] : mesh.triangles)
        scene.triangles.push_back({{first + a, first + b, first + c}, skin});
    generated::smooth_normals(scene);
    rig.follow_joints(rig.end_moving_part("hand", palm), joints, weights);

    for (std::size_t finger = 0; finger < 5; ++finger) {
        const std::size_t begin = scene.positions.size();
        add_nail(scene, body, fingers[finger], nail);
        generated::smooth_normals(scene);
        const std::vector<glm::dvec3> points(scene.positions.begin() + begin,
                                             scene.positions.end());
        rig.follow_joints(rig.end_moving_part("nail", palm), joints,
                          generated::weights_near(points, mesh, weights));
    }

    std::vector<glm::dquat> sways;
    for (int key = 0; key < keys; ++key) {
        const double share = closed(clip_length * key / (keys - 1), 0.2);
        sways.push_back(glm::angleAxis(0.22 * share, glm::normalize(glm::dvec3(0.8, -0.6, 0.0))));
    }
    rig.turn(palm, sways);
    for (std::size_t finger = 0; finger < 5; ++finger) {
        std::array<std::vector<glm::dquat>, 3> turns;
        for (int key = 0; key < keys; ++key) {
            const double share = closed(clip_length * key / (keys - 1), fingers[finger].delay);
            const auto now = turns_of(fingers[finger], finger == 0, share);
            for (std::size_t k = 0; k < 3; ++k) turns[k].push_back(now[k]);
        }
        for (std::size_t k = 0; k < 3; ++k) rig.turn(joint(finger, k), turns[k]);
    }

    generated::add_daylight(scene, {-0.55f, -0.8f, -0.6f}, 2.2f);
    scene.cameras.push_back(
        generated::look_at("camera", {0.17, 0.24, 0.52}, {0.0, 0.150, 0.0}, 0.60f));
    rig.finish();
    return scene;
}

}  // namespace clgi
