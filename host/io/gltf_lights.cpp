// Lights and cameras: first at the origin, as the file describes them, then where their nodes are.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/gltf_document.hpp"
#include "scene/carried.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double largest = 1e18;  // metres, candela: its square is still a float

Camera read_camera(const tinygltf::Camera& source) {
    Camera camera;
    camera.name = short_name(source.name);
    if (source.type == "perspective") {
        const tinygltf::PerspectiveCamera& view = source.perspective;
        require(view.yfov < std::numbers::pi, ".perspective.yfov is not within 0 and pi");
        require(view.znear <= largest, ".perspective.znear is too large");
        // Below a micro-radian the picture is one point and its projection overflows.
        camera.vertical_fov = static_cast<float>(std::clamp(view.yfov, 1e-6, 3.1415));
        camera.near = static_cast<float>(view.znear);
        return camera;
    }
    camera.kind = Camera::Kind::orthographic;
    const tinygltf::OrthographicCamera& box = source.orthographic;
    const double half_height = std::abs(box.ymag);
    require(half_height >= 1e-18 && half_height <= largest, ".orthographic.ymag is 0 or too large");
    require(box.znear <= largest, ".orthographic.znear is too large");
    require(box.zfar > box.znear, ".orthographic.zfar is not beyond znear");
    camera.half_height = static_cast<float>(half_height);
    camera.near = static_cast<float>(box.znear);
    return camera;
}

void read_cone(const tinygltf::SpotLight& cone, Light& light, Warnings& warnings) {
    constexpr double right_angle = std::numbers::pi / 2.0;
    const double outer = std::min(cone.outerConeAngle, right_angle);
    if (cone.outerConeAngle > right_angle + 1e-6) {
        warnings.add("a spot light wider than a hemisphere is narrowed to one");
    }
    if (cone.innerConeAngle > outer) {
        warnings.add("a spot light's inner cone is narrowed to its outer cone");
    }
    light.outer_angle = static_cast<float>(std::max(outer, 1e-4));
    light.inner_angle = std::min(static_cast<float>(cone.innerConeAngle), light.outer_angle);
}

Light read_light(const tinygltf::Light& source, Warnings& warnings) {
    Light light;
    light.name = short_name(source.name);
    for (int i = 0; i < 3; ++i) {
        const double color = source.color.empty() ? 1.0 : source.color[i];
        const double channel = color * source.intensity;
        require(color >= 0.0, ".color is negative");
        require(channel >= 0.0, ".intensity is negative");
        require(channel <= largest, "is brighter than 1e18");
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
    each("cameras", document.model.cameras,
         [&](const tinygltf::Camera& camera) { document.cameras.push_back(read_camera(camera)); });
    each("extensions.KHR_lights_punctual.lights", document.model.lights,
         [&](const tinygltf::Light& light) {
             document.lights.push_back(read_light(light, document.warnings));
         });
}

void place_lights(Document& document, const std::vector<int>& nodes, Scene& scene) {
    for (const int index : nodes) {
        const Node& node = document.model.nodes[index];
        const tinygltf::Value* carried = extension(node.extensions, "KHR_lights_punctual");
        if (!carried) continue;
        Light light = document.lights[index_in(*carried, "light")];
        if (light.name.empty()) light.name = short_name(node.name);
        const NodePlace place(document.matrices[index]);
        const bool directed = light.kind != Light::Kind::point;
        if (!place.is_usable(directed ? place.forward : glm::dvec3(1.0))) {
            document.warnings.add("a light whose node has no direction or place is left out");
            continue;
        }
        carry(document.matrices[index], light);
        document.light_nodes.push_back(index);
        scene.lights.push_back(std::move(light));
    }
    for (const int index : nodes) {
        const Node& node = document.model.nodes[index];
        if (node.camera < 0) continue;
        const NodePlace place(document.matrices[index]);
        if (!place.is_usable(place.right)) {
            document.warnings.add("a camera whose node has no direction or place is left out");
            continue;
        }
        Camera camera = document.cameras[node.camera];
        if (camera.name.empty()) camera.name = short_name(node.name);
        carry(document.matrices[index], camera);
        document.camera_nodes.push_back(index);
        scene.cameras.push_back(std::move(camera));
    }
}

}  // namespace clgi::io::gltf
