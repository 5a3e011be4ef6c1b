// Lights and cameras of a model as those of a Scene, at the origin.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/gltf_place.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double largest = 1e18;  // metres, candela: its square is still a float

void read_perspective(const tinygltf::PerspectiveCamera& source, const std::string& name,
                      Camera& camera) {
    if (source.yfov >= std::numbers::pi) refuse(name + ".yfov", "is not within 0 and pi");
    // Below a micro-radian the picture is one point and its projection overflows.
    camera.vertical_fov = static_cast<float>(std::clamp(source.yfov, 1e-6, 3.1415));
    if (source.znear > largest) refuse(name + ".znear", "is too large");
    camera.near = static_cast<float>(source.znear);
}

void read_orthographic(const tinygltf::OrthographicCamera& source, const std::string& name,
                       Camera& camera) {
    camera.kind = Camera::Kind::orthographic;
    const double half_height = std::abs(source.ymag);
    if (half_height < 1e-18 || half_height > largest) refuse(name + ".ymag", "is 0 or too large");
    camera.half_height = static_cast<float>(half_height);
    if (source.znear > largest) refuse(name + ".znear", "is too large");
    if (source.zfar <= source.znear) refuse(name + ".zfar", "is not beyond znear");
    camera.near = static_cast<float>(source.znear);
}

Camera read_camera(const tinygltf::Camera& source, const std::string& name) {
    Camera camera;
    camera.name = short_name(source.name);
    if (source.type == "perspective") {
        read_perspective(source.perspective, name + ".perspective", camera);
    } else {
        read_orthographic(source.orthographic, name + ".orthographic", camera);
    }
    return camera;
}

void read_cone(const tinygltf::SpotLight& cone, Light& light, Warnings& warnings) {
    constexpr double right_angle = std::numbers::pi / 2.0;
    double outer = cone.outerConeAngle;
    if (outer > right_angle + 1e-6) {
        warnings.add("a spot light wider than a hemisphere is narrowed to one");
    }
    outer = std::min(outer, right_angle);
    if (cone.innerConeAngle > outer) {
        warnings.add("a spot light's inner cone is narrowed to its outer cone");
    }
    light.outer_angle = static_cast<float>(std::max(outer, 1e-4));
    light.inner_angle = std::min(static_cast<float>(cone.innerConeAngle), light.outer_angle);
}

Light read_light(const tinygltf::Light& source, const std::string& name, Warnings& warnings) {
    Light light;
    light.name = short_name(source.name);
    for (int i = 0; i < 3; ++i) {
        const double color = source.color.empty() ? 1.0 : source.color[i];
        if (color < 0.0) refuse(name + ".color", "is negative");
        const double channel = color * source.intensity;
        if (channel < 0.0) refuse(name + ".intensity", "is negative");
        if (channel > largest) refuse(name, "is brighter than 1e18");
        light.intensity[i] = static_cast<float>(channel);
    }
    if (source.type == "directional") {
        light.kind = Light::Kind::directional;
        return light;
    }
    if (source.type == "spot") {
        light.kind = Light::Kind::spot;
        read_cone(source.spot, light, warnings);
    }
    // A range that no scene can reach is none, as is an absent one, 0.
    if (source.range > 0.0 && source.range < largest) {
        light.range = std::max(static_cast<float>(source.range), 1e-18f);
    }
    return light;
}

}  // namespace

void read_lights(Document& document) {
    const Model& model = document.model;
    for (std::size_t i = 0; i < model.cameras.size(); ++i) {
        document.cameras.push_back(read_camera(model.cameras[i], entry("cameras", i)));
    }
    for (std::size_t i = 0; i < model.lights.size(); ++i) {
        const std::string name = entry("extensions.KHR_lights_punctual.lights", i);
        document.lights.push_back(read_light(model.lights[i], name, document.warnings));
    }
}

}  // namespace clgi::io::gltf
