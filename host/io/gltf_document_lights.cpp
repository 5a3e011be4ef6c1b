// Cameras and KHR_lights_punctual as the JSON declares them.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/gltf_document.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double largest = 1e18;  // metres, candela: its square is still a float

Camera read_perspective(const Value& value) {
    Camera camera;
    camera.kind = Camera::Kind::perspective;
    const double fov = value.at("yfov").number();
    if (fov <= 0.0 || fov >= std::numbers::pi) value.at("yfov").fail("is not within 0 and pi");
    // Below a micro-radian the picture is one point and its projection overflows.
    camera.vertical_fov = static_cast<float>(std::clamp(fov, 1e-6, 3.1415));
    const double near = value.at("znear").number();
    if (near <= 0.0 || near > largest) value.at("znear").fail("is not above 0");
    camera.near = static_cast<float>(near);
    if (const auto aspect = value.find("aspectRatio")) {
        if (aspect->number() <= 0.0) aspect->fail("is not above 0");
    }
    if (const auto far = value.find("zfar")) {
        if (far->number() <= 0.0) far->fail("is not above 0");
    }
    return camera;
}

Camera read_orthographic(const Value& value) {
    Camera camera;
    camera.kind = Camera::Kind::orthographic;
    value.at("xmag").number();
    const double half_height = std::abs(value.at("ymag").number());
    if (half_height < 1e-18 || half_height > largest) value.at("ymag").fail("is 0 or too large");
    camera.half_height = static_cast<float>(half_height);
    const double near = value.at("znear").number();
    if (near < 0.0 || near > largest) value.at("znear").fail("is negative or too large");
    if (value.at("zfar").number() <= near) value.at("zfar").fail("is not beyond znear");
    camera.near = static_cast<float>(near);
    return camera;
}

Camera read_camera(const Value& value) {
    const std::string type = value.at("type").text();
    Camera camera;
    if (type == "perspective") {
        camera = read_perspective(value.at("perspective"));
    } else if (type == "orthographic") {
        camera = read_orthographic(value.at("orthographic"));
    } else {
        value.at("type").fail("is \"" + printable(type) + "\"");
    }
    camera.name = value.name_or_empty();
    return camera;
}

void read_cone(const Value& value, Light& light, Warnings& warnings) {
    constexpr double right_angle = std::numbers::pi / 2.0;
    double outer = value.number_or("outerConeAngle", std::numbers::pi / 4.0);
    double inner = value.number_or("innerConeAngle", 0.0);
    if (outer <= 0.0) value.fail("has an outer cone angle that is not above 0");
    if (inner < 0.0) value.fail("has a negative inner cone angle");
    if (outer > right_angle + 1e-6) {
        warnings.add("a spot light wider than a hemisphere is narrowed to one");
    }
    outer = std::min(outer, right_angle);
    if (inner > outer) warnings.add("a spot light's inner cone is narrowed to its outer cone");
    light.outer_angle = static_cast<float>(std::max(outer, 1e-4));
    light.inner_angle = std::min(static_cast<float>(inner), light.outer_angle);
}

Light read_light(const Value& value, Warnings& warnings) {
    Light light;
    light.name = value.name_or_empty();
    const glm::dvec3 color = value.vec3_or("color", glm::dvec3(1.0));
    const double intensity = value.number_or("intensity", 1.0);
    for (int i = 0; i < 3; ++i) {
        if (color[i] < 0.0) value.at("color").fail("is negative");
        const double channel = color[i] * intensity;
        if (channel < 0.0) value.at("intensity").fail("is negative");
        if (channel > largest) value.fail("is brighter than 1e18");
        light.intensity[i] = static_cast<float>(channel);
    }

    const std::string type = value.at("type").text();
    if (type == "directional") {
        light.kind = Light::Kind::directional;
        return light;
    }
    light.kind = type == "spot" ? Light::Kind::spot : Light::Kind::point;
    if (type == "spot") {
        read_cone(value.at("spot"), light, warnings);
    } else if (type != "point") {
        value.at("type").fail("is \"" + printable(type) + "\"");
    }
    if (const auto range = value.find("range")) {
        const double metres = range->number();
        if (metres <= 0.0) range->fail("is not above 0");
        // A range that no scene can reach is none.
        light.range = metres < largest ? std::max(static_cast<float>(metres), 1e-18f) : 0.0f;
    }
    return light;
}

}  // namespace

void read_lights(const Value& root, Document& document) {
    const std::size_t cameras = entries(root, "cameras", max_rare_entries);
    for (std::size_t i = 0; i < cameras; ++i) {
        document.cameras.push_back(read_camera(root.at("cameras").item(i)));
    }
    const auto extension = root.extension("KHR_lights_punctual");
    if (!extension) return;
    const Value lights = extension->at("lights");
    for (std::size_t i = 0; i < lights.count(max_rare_entries); ++i) {
        document.lights.push_back(read_light(lights.item(i), document.warnings));
    }
}

}  // namespace clgi::io::gltf
