// save_glb: lights and cameras.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <glm/gtc/quaternion.hpp>

#include "io/gltf_writer.hpp"

namespace clgi::io::gltf {

namespace {

using tinygltf::Value;

tinygltf::Light light_of(const Light& light) {
    const auto [color, strength] = color_and_strength(light.intensity);
    tinygltf::Light written;
    written.name = utf8(light.name);
    written.color = numbers(color);
    written.intensity = strength;
    written.type = "directional";
    if (light.kind == Light::Kind::directional) return written;
    written.type = light.kind == Light::Kind::spot ? "spot" : "point";
    written.range = light.range;
    written.spot.innerConeAngle = light.inner_angle;
    written.spot.outerConeAngle = light.outer_angle;
    return written;
}

tinygltf::Camera camera_of(const Camera& camera, double scene_size) {
    const bool perspective = camera.kind == Camera::Kind::perspective;
    tinygltf::Camera written;
    written.name = utf8(camera.name);
    written.type = perspective ? "perspective" : "orthographic";
    written.perspective.yfov = camera.vertical_fov;
    // glTF wants a near distance above 0; 0 here means that it is for the reader to choose.
    written.perspective.znear = camera.near > 0.0f ? camera.near : 1e-3 * scene_size;
    written.orthographic.xmag = written.orthographic.ymag = camera.half_height;
    written.orthographic.znear = camera.near;
    // tinygltf writes a far distance in any case. Nobody reads this one.
    written.perspective.zfar = written.orthographic.zfar = 2.0 * camera.near + 10.0 * scene_size;
    return written;
}

// A rotation that takes -Z to a direction.
glm::dquat turn_to(const glm::dvec3& direction) {
    const glm::dvec3 forward = glm::normalize(direction);
    const bool upright = std::abs(forward.y) < 0.9;
    return glm::quatLookAt(forward, upright ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0));
}

Node node_at(const glm::dvec3& position, const glm::dquat& rotation) {
    Node node;
    node.translation = numbers(position);
    node.rotation = {rotation.x, rotation.y, rotation.z, rotation.w};
    return node;
}

// Which of `count` lights or cameras no node carries.
std::vector<std::size_t> still(const std::vector<Carried>& carried, std::size_t count) {
    std::vector<bool> moved(count);
    for (const Carried& item : carried) moved[item.index] = true;
    std::vector<std::size_t> list;
    for (std::size_t i = 0; i < count; ++i)
        if (!moved[i]) list.push_back(i);
    return list;
}

}  // namespace

LightWriter::LightWriter(const Scene& scene, GlbModel& out) : scene_(scene), out_(out) {
    const double size = glm::length(bounds(scene).high - bounds(scene).low);
    size_ = size > 0.0 ? size : 1.0;
}

void LightWriter::put_light(const Light& light, Node& node) {
    const int index = add(out_.model.lights, light_of(light));
    node.extensions["KHR_lights_punctual"] = Value(Value::Object{{"light", Value(index)}});
}

void LightWriter::put_camera(const Camera& camera, Node& node) {
    node.camera = add(out_.model.cameras, camera_of(camera, size_));
}

void LightWriter::add_static() {
    const Animation none;
    const Animation& animation = scene_.animation ? *scene_.animation : none;
    for (const std::size_t i : still(animation.lights, scene_.lights.size())) {
        const Light& light = scene_.lights[i];
        const bool directed = light.kind != Light::Kind::point;
        Node node =
            node_at(light.position, directed ? turn_to(light.direction) : glm::dquat(1, 0, 0, 0));
        put_light(light, node);
        out_.add_root(std::move(node));
    }
    for (const std::size_t i : still(animation.cameras, scene_.cameras.size())) {
        const Camera& camera = scene_.cameras[i];
        const glm::dmat3 axes(camera.right, camera.up, -camera.forward);
        Node node = node_at(camera.position, glm::normalize(glm::quat_cast(axes)));
        put_camera(camera, node);
        out_.add_root(std::move(node));
    }
}

}  // namespace clgi::io::gltf
