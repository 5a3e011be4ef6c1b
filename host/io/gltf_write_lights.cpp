// Lights and cameras of a GLB, each on a node of its own.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "io/gltf_write.hpp"

namespace clgi::io::gltf {

namespace {

nlohmann::json node_at(const glm::dvec3& position, const glm::dquat& rotation) {
    return {{"translation", {position.x, position.y, position.z}},
            {"rotation", {rotation.x, rotation.y, rotation.z, rotation.w}}};
}

// A rotation that takes -Z to a direction.
glm::dquat turn_to(const glm::dvec3& direction) {
    const glm::dvec3 forward = glm::normalize(direction);
    const glm::dvec3 helper =
        std::abs(forward.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, helper));
    return glm::quat_cast(glm::dmat3(right, glm::cross(right, forward), -forward));
}

nlohmann::json light_json(const Light& light) {
    const glm::dvec3 intensity(light.intensity);
    const double brightest = std::max({intensity.r, intensity.g, intensity.b});
    const glm::dvec3 color = brightest > 0.0 ? intensity / brightest : glm::dvec3(1.0);
    nlohmann::json json = {{"color", {color.r, color.g, color.b}}, {"intensity", brightest}};
    if (!light.name.empty()) json["name"] = light.name;
    if (light.range > 0.0f && light.kind != Light::Kind::directional) json["range"] = light.range;
    switch (light.kind) {
        case Light::Kind::directional:
            json["type"] = "directional";
            break;
        case Light::Kind::point:
            json["type"] = "point";
            break;
        case Light::Kind::spot:
            json["type"] = "spot";
            json["spot"] = {{"innerConeAngle", light.inner_angle},
                            {"outerConeAngle", light.outer_angle}};
            break;
    }
    return json;
}

nlohmann::json camera_json(const Camera& camera, double scene_size) {
    nlohmann::json json;
    if (!camera.name.empty()) json["name"] = camera.name;
    if (camera.kind == Camera::Kind::perspective) {
        // glTF wants a near distance above 0; 0 here means that it is for the reader to choose.
        const double near = camera.near > 0.0f ? camera.near : 1e-3 * scene_size;
        json["type"] = "perspective";
        json["perspective"] = {{"yfov", camera.vertical_fov}, {"znear", near}};
        return json;
    }
    json["type"] = "orthographic";
    json["orthographic"] = {{"xmag", camera.half_height},
                            {"ymag", camera.half_height},
                            {"znear", camera.near},
                            {"zfar", 2.0 * camera.near + 10.0 * scene_size}};
    return json;
}

}  // namespace

void write_lights(const Scene& scene, GlbDraft& draft, std::vector<int>& roots) {
    if (scene.lights.empty()) return;
    draft.declare_extension("KHR_lights_punctual");
    nlohmann::json lights = nlohmann::json::array();
    for (const Light& light : scene.lights) {
        const bool directed = light.kind != Light::Kind::point;
        nlohmann::json node =
            node_at(light.position, directed ? turn_to(light.direction) : glm::dquat(1, 0, 0, 0));
        node["extensions"]["KHR_lights_punctual"]["light"] = lights.size();
        lights.push_back(light_json(light));
        roots.push_back(draft.add("nodes", std::move(node)));
    }
    draft.json["extensions"]["KHR_lights_punctual"]["lights"] = std::move(lights);
}

void write_cameras(const Scene& scene, GlbDraft& draft, std::vector<int>& roots) {
    const Bounds box = bounds(scene);
    const double size = glm::length(box.high - box.low);
    for (const Camera& camera : scene.cameras) {
        const glm::dmat3 axes(camera.right, camera.up, -camera.forward);
        nlohmann::json node = node_at(camera.position, glm::normalize(glm::quat_cast(axes)));
        node["camera"] = draft.add("cameras", camera_json(camera, size > 0.0 ? size : 1.0));
        roots.push_back(draft.add("nodes", std::move(node)));
    }
}

}  // namespace clgi::io::gltf
