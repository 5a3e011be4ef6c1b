// Small scenes put together by hand, and the numbers that make random ones.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/scene.hpp>
#include <cstdint>
#include <glm/glm.hpp>

namespace clgi::test {

// A sequence that is the same everywhere, unlike those of <random>'s distributions.
class Random {
public:
    explicit Random(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
    double operator()(double low, double high) {
        state_ = state_ * 6364136223846793005u + 1442695040888963407u;
        return low + (high - low) * static_cast<double>(state_ >> 11) * 0x1p-53;
    }
    int integer(int low, int high) {  // both included
        return low + static_cast<int>((*this)(0.0, high - low + 1.0));
    }

private:
    std::uint64_t state_;
};

// No triangles yet; material 0 is white paper of this reflectance.
inline Scene plain_scene(const glm::vec3& albedo = glm::vec3(0.5f)) {
    Scene scene;
    Material material;
    material.base_color = glm::vec4(albedo, 1.0f);
    scene.materials.push_back(material);
    return scene;
}

inline std::uint32_t add_material(Scene& scene, const Material& material) {
    scene.materials.push_back(material);
    return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

// Counter-clockwise seen from the front, with the face's own normal.
inline void add_triangle(Scene& scene, const glm::dvec3& a, const glm::dvec3& b,
                         const glm::dvec3& c, std::uint32_t material = 0) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const glm::dvec3 across = glm::cross(b - a, c - a);
    const double length = glm::length(across);
    const glm::vec3 normal = length > 0.0 ? glm::vec3(across / length) : glm::vec3(0, 0, 1);
    for (const glm::dvec3& corner : {a, b, c}) {
        scene.positions.push_back(corner);
        scene.normals.push_back(normal);
    }
    scene.triangles.push_back({{first, first + 1, first + 2}, material});
}

// Two triangles; texture coordinates (0,1), (1,1), (1,0), (0,0) at the corners if there are any.
inline void add_quad(Scene& scene, const std::array<glm::dvec3, 4>& corners,
                     std::uint32_t material = 0) {
    const auto first = static_cast<std::uint32_t>(scene.positions.size());
    const glm::vec3 normal(
        glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0])));
    for (const glm::dvec3& corner : corners) {
        scene.positions.push_back(corner);
        scene.normals.push_back(normal);
    }
    scene.triangles.push_back({{first, first + 1, first + 2}, material});
    scene.triangles.push_back({{first, first + 2, first + 3}, material});
}

// A horizontal square of side 2 * half about (0, y, 0) that faces up.
inline void add_floor(Scene& scene, double half, double y = 0.0, std::uint32_t material = 0) {
    add_quad(scene,
             {glm::dvec3(-half, y, half), {half, y, half}, {half, y, -half}, {-half, y, -half}},
             material);
}

// Six faces; facing +1 outward, -1 inward.
inline void add_box(Scene& scene, const glm::dvec3& low, const glm::dvec3& high, int facing,
                    std::uint32_t material = 0) {
    for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<glm::dvec3, 4> corners;
            for (int k = 0; k < 4; ++k) {
                // Counter-clockwise seen from +axis.
                const bool far_u = k == 1 || k == 2, far_v = k >= 2;
                corners[k][axis] = side > 0 ? high[axis] : low[axis];
                corners[k][u] = far_u ? high[u] : low[u];
                corners[k][v] = far_v ? high[v] : low[v];
            }
            if (side * facing < 0) std::swap(corners[1], corners[3]);
            add_quad(scene, corners, material);
        }
}

inline Light spot_light(const glm::dvec3& position, const glm::vec3& direction, double angle,
                        float intensity = 1.0f) {
    Light light;
    light.kind = Light::Kind::spot;
    light.position = position;
    light.direction = glm::normalize(direction);
    light.intensity = glm::vec3(intensity);
    light.outer_angle = static_cast<float>(angle);
    light.inner_angle = light.outer_angle;  // a hard edge
    return light;
}

inline Light point_light(const glm::dvec3& position, float intensity = 1.0f) {
    Light light;
    light.kind = Light::Kind::point;
    light.position = position;
    light.intensity = glm::vec3(intensity);
    return light;
}

inline Light directional_light(const glm::vec3& direction, float lux = 1.0f) {
    Light light;
    light.kind = Light::Kind::directional;
    light.direction = glm::normalize(direction);
    light.intensity = glm::vec3(lux);
    return light;
}

inline Camera camera_at(const glm::dvec3& position, const glm::dvec3& target,
                        float vertical_fov = 0.8f) {
    const glm::dvec3 forward = glm::normalize(target - position);
    const glm::dvec3 helper = std::abs(forward.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 right = glm::normalize(glm::cross(forward, helper));
    Camera camera;
    camera.position = position;
    camera.forward = glm::vec3(forward);
    camera.right = glm::vec3(right);
    camera.up = glm::vec3(glm::cross(right, forward));
    camera.vertical_fov = vertical_fov;
    return camera;
}

// World units are pixels: x to the right, y up from the bottom row, looked at along -z from z.
inline Camera pixel_camera(int width, int height, double z = 64.0) {
    Camera camera;
    camera.kind = Camera::Kind::orthographic;
    camera.position = glm::dvec3(0.5 * width, 0.5 * height, z);
    camera.half_height = 0.5f * static_cast<float>(height);
    return camera;
}

}  // namespace clgi::test
