// Lights and cameras, posed by their nodes.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <optional>

#include "io/gltf_place.hpp"
#include "io/gltf_text.hpp"

namespace clgi::io::gltf {

namespace {

constexpr double farthest = 1e18;  // metres

struct Axes {
    glm::dvec3 right;
    glm::dvec3 up;
    glm::dvec3 forward;  // -Z
};

// Orthogonal directions of a node; nothing where its matrix has no direction left.
std::optional<Axes> axes_of(const glm::dmat4& matrix) {
    const auto length = [](const glm::dvec3& v) { return glm::length(v); };
    const glm::dvec3 back(matrix[2]);
    const glm::dvec3 y(matrix[1]);
    if (!(length(back) > 1e-30) || !(length(y) > 1e-30)) return std::nullopt;
    const glm::dvec3 forward = -glm::normalize(back);
    const glm::dvec3 right = glm::cross(forward, glm::normalize(y));
    if (!(length(right) > 1e-9)) return std::nullopt;
    Axes axes;
    axes.forward = forward;
    axes.right = glm::normalize(right);
    axes.up = glm::cross(axes.right, forward);
    return axes;
}

bool is_near_enough(const glm::dmat4& matrix) {
    return glm::length(glm::dvec3(matrix[3])) <= farthest;
}

}  // namespace

void place_lights(Document& document, const std::vector<int>& nodes, Scene& scene) {
    for (const int index : nodes) {
        const Node& node = document.model.nodes[index];
        const tinygltf::Value* carried = extension(node.extensions, "KHR_lights_punctual");
        if (!carried) continue;
        Light light = document.lights[index_in(*carried, "light")];
        if (light.name.empty()) light.name = short_name(node.name);
        const glm::dmat4& matrix = document.matrices[index];
        const glm::dvec3 back(matrix[2]);
        const bool directed = light.kind != Light::Kind::point;
        if (!is_near_enough(matrix) || (directed && !(glm::length(back) > 1e-30))) {
            document.warnings.add("a light whose node has no direction or place is left out");
            continue;
        }
        light.position = glm::dvec3(matrix[3]);
        if (directed) light.direction = glm::vec3(-glm::normalize(back));
        scene.lights.push_back(std::move(light));
    }
}

void place_cameras(Document& document, const std::vector<int>& nodes, Scene& scene) {
    for (const int index : nodes) {
        const Node& node = document.model.nodes[index];
        if (node.camera < 0) continue;
        const glm::dmat4& matrix = document.matrices[index];
        const auto axes = axes_of(matrix);
        if (!axes || !is_near_enough(matrix)) {
            document.warnings.add("a camera whose node has no direction or place is left out");
            continue;
        }
        Camera camera = document.cameras[node.camera];
        if (camera.name.empty()) camera.name = short_name(node.name);
        camera.position = glm::dvec3(matrix[3]);
        camera.right = glm::vec3(axes->right);
        camera.up = glm::vec3(axes->up);
        camera.forward = glm::vec3(axes->forward);
        scene.cameras.push_back(std::move(camera));
    }
}

}  // namespace clgi::io::gltf
