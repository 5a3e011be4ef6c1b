// Flat faces, panels, lamps and cameras of the generated scenes.
// SPDX-License-Identifier: MIT
#include "scene/surfaces.hpp"

#include <clgi/error.hpp>
#include <sstream>

namespace clgi::generated {

void check_range(const char* scene, const char* option, double got, double low, double high) {
    if (got >= low && got <= high) return;
    std::ostringstream text;
    text << scene << ": " << option << " is " << got << ", needs " << low << " to " << high;
    throw Error(text.str());
}

void check_color(const char* scene, const char* option, const glm::vec3& got, double high) {
    for (int channel = 0; channel < 3; ++channel) {
        check_range(scene, option, got[channel], 0.0, high);
    }
}

std::uint32_t add_material(Scene& scene, const std::string& name, const glm::vec3& reflectance) {
    Material material;
    material.name = name;
    material.base_color = glm::vec4(reflectance, 1.0f);
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

void add_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners, std::uint32_t material) {
    const auto base = static_cast<std::uint32_t>(scene.positions.size());
    const glm::vec3 normal(
        glm::normalize(glm::cross(corners[2] - corners[0], corners[3] - corners[1])));
    for (const glm::dvec3& corner : corners) {
        scene.positions.push_back(corner);
        scene.normals.push_back(normal);
    }
    scene.triangles.push_back({{base, base + 1, base + 2}, material});
    scene.triangles.push_back({{base, base + 2, base + 3}, material});
}

void add_panel(Scene& scene, const Panel& panel, std::uint32_t material, const Opening& opening) {
    const auto place = [&](double first, double second) {
        glm::dvec3 at(0.0);
        at[panel.axis] = panel.offset;
        at[(panel.axis + 1) % 3] = first;
        at[(panel.axis + 2) % 3] = second;
        return at;
    };
    for (std::size_t i = 0; i + 1 < panel.first.size(); ++i) {
        for (std::size_t j = 0; j + 1 < panel.second.size(); ++j) {
            const double a0 = panel.first[i], a1 = panel.first[i + 1];
            const double b0 = panel.second[j], b1 = panel.second[j + 1];
            if (opening && opening(place(0.5 * (a0 + a1), 0.5 * (b0 + b1)))) continue;
            if (panel.facing > 0) {
                add_quad(scene, {place(a0, b0), place(a1, b0), place(a1, b1), place(a0, b1)},
                         material);
            } else {
                add_quad(scene, {place(a0, b0), place(a0, b1), place(a1, b1), place(a1, b0)},
                         material);
            }
        }
    }
}

void add_solid(Scene& scene, const glm::dvec3& origin, const std::array<glm::dvec3, 3>& edges,
               std::uint32_t material) {
    glm::dvec3 u = edges[0], v = edges[1];
    const glm::dvec3 w = edges[2];
    if (glm::dot(glm::cross(u, v), w) < 0.0) std::swap(u, v);
    const auto at = [&](int i, int j, int k) {
        return origin + u * double(i) + v * double(j) + w * double(k);
    };
    add_quad(scene, {at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0)}, material);
    add_quad(scene, {at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1)}, material);
    add_quad(scene, {at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)}, material);
    add_quad(scene, {at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0)}, material);
    add_quad(scene, {at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0)}, material);
    add_quad(scene, {at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1)}, material);
}

void end_part(Scene& scene, const std::string& name) {
    Part part;
    part.name = name;
    if (!scene.parts.empty()) {
        part.first_triangle = scene.parts.back().first_triangle + scene.parts.back().triangle_count;
    }
    part.triangle_count = static_cast<std::uint32_t>(scene.triangles.size()) - part.first_triangle;
    scene.parts.push_back(part);
}

void smooth_normals(Scene& scene) {
    std::vector<glm::dvec3> sums(scene.positions.size(), glm::dvec3(0.0));
    for (const SceneTriangle& triangle : scene.triangles) {
        const auto& [a, b, c] = triangle.vertex;
        const glm::dvec3 doubled_area = glm::cross(scene.positions[b] - scene.positions[a],
                                                   scene.positions[c] - scene.positions[a]);
        for (const std::uint32_t vertex : triangle.vertex) sums[vertex] += doubled_area;
    }
    scene.normals.clear();
    for (const glm::dvec3& sum : sums) {
        const double length = glm::length(sum);
        scene.normals.emplace_back(length > 0.0 ? sum / length : glm::dvec3(0.0, 1.0, 0.0));
    }
}

Light spot(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
           const glm::vec3& intensity, float outer_angle) {
    Light light = point(name, position, intensity);
    light.kind = Light::Kind::spot;
    light.direction = glm::vec3(glm::normalize(target - position));
    light.outer_angle = outer_angle;
    light.inner_angle = 0.8f * outer_angle;
    return light;
}

Light point(const std::string& name, const glm::dvec3& position, const glm::vec3& intensity) {
    Light light;
    light.name = name;
    light.kind = Light::Kind::point;
    light.position = position;
    light.intensity = intensity;
    return light;
}

Camera look_at(const std::string& name, const glm::dvec3& position, const glm::dvec3& target,
               float vertical_fov) {
    Camera camera;
    camera.name = name;
    camera.vertical_fov = vertical_fov;
    return clgi::look_at(camera, position, target);
}

}  // namespace clgi::generated
