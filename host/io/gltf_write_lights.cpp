// Lights and cameras of a GLB, each on a node of its own.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "io/gltf_write.hpp"

namespace clgi::io::gltf {

namespace {

tinygltf::Node node_at(const glm::dvec3& position, const glm::dquat& rotation) {
    tinygltf::Node node;
    node.translation = {position.x, position.y, position.z};
    node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
    return node;
}

// A rotation that takes -Z to a direction.
glm::dquat turn_to(const glm::dvec3& direction) {
    const glm::dvec3 forward = glm::normalize(direction);
    const glm::dvec3 helper =
        std::abs(forward.y) < 0.9 ? glm::dvec3(0.0, 1.0, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, helper));
    return glm::quat_cast(glm::dmat3(right, glm::cross(right, forward), -forward));
}

tinygltf::Light light_of(const Light& light) {
    const glm::dvec3 intensity(light.intensity);
    const double brightest = std::max({intensity.r, intensity.g, intensity.b});
    const glm::dvec3 color = brightest > 0.0 ? intensity / brightest : glm::dvec3(1.0);
    tinygltf::Light written;
    written.name = utf8(light.name);
    written.color = {color.r, color.g, color.b};
    written.intensity = brightest;
    if (light.kind == Light::Kind::directional) {
        written.type = "directional";
        return written;
    }
    written.type = light.kind == Light::Kind::spot ? "spot" : "point";
    written.range = light.range;
    written.spot.innerConeAngle = light.inner_angle;
    written.spot.outerConeAngle = light.outer_angle;
    return written;
}

tinygltf::Camera camera_of(const Camera& camera, double scene_size) {
    tinygltf::Camera written;
    written.name = utf8(camera.name);
    // tinygltf writes a far distance in any case. Nobody reads this one.
    const double far = 2.0 * camera.near + 10.0 * scene_size;
    if (camera.kind == Camera::Kind::perspective) {
        written.type = "perspective";
        written.perspective.yfov = camera.vertical_fov;
        // glTF wants a near distance above 0; 0 here means that it is for the reader to choose.
        written.perspective.znear = camera.near > 0.0f ? camera.near : 1e-3 * scene_size;
        written.perspective.zfar = far;
        return written;
    }
    written.type = "orthographic";
    written.orthographic.xmag = camera.half_height;
    written.orthographic.ymag = camera.half_height;
    written.orthographic.znear = camera.near;
    written.orthographic.zfar = far;
    return written;
}

}  // namespace

void write_lights(const Scene& scene, GlbDraft& draft) {
    for (const Light& light : scene.lights) {
        const bool directed = light.kind != Light::Kind::point;
        tinygltf::Node node =
            node_at(light.position, directed ? turn_to(light.direction) : glm::dquat(1, 0, 0, 0));
        const int index = add(draft.model.lights, light_of(light));
        node.extensions["KHR_lights_punctual"] =
            tinygltf::Value(tinygltf::Value::Object{{"light", tinygltf::Value(index)}});
        draft.roots.push_back(add(draft.model.nodes, std::move(node)));
    }
}

void write_cameras(const Scene& scene, GlbDraft& draft) {
    const Bounds box = bounds(scene);
    const double size = glm::length(box.high - box.low);
    for (const Camera& camera : scene.cameras) {
        const glm::dmat3 axes(camera.right, camera.up, -camera.forward);
        tinygltf::Node node = node_at(camera.position, glm::normalize(glm::quat_cast(axes)));
        node.camera = add(draft.model.cameras, camera_of(camera, size > 0.0 ? size : 1.0));
        draft.roots.push_back(add(draft.model.nodes, std::move(node)));
    }
}

}  // namespace clgi::io::gltf
