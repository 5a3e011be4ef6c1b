// What a Scene promises, and the questions that need only its arrays.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/error.hpp>
#include <clgi/scene.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "scene/environment.hpp"
#include "scene/validate.hpp"

namespace clgi {

namespace {

constexpr double farthest = 1e18;        // metres; the square of a distance is still a float
constexpr float unit_tolerance = 1e-3f;  // of a length; quantised normals are that far off
constexpr float right_angle = std::numbers::pi_v<float> / 2.0f;

[[noreturn]] void fail(const std::string& what) { throw InputError("scene: " + what); }

template <typename Vector>
bool is_unit(const Vector& v) {
    return std::abs(glm::length(v) - 1.0f) <= unit_tolerance;  // false for NaN
}

bool is_place(const glm::dvec3& p) { return glm::length(p) <= farthest; }

bool is_within(float value, float low, float high) { return value >= low && value <= high; }

void check_length(const char* array, std::size_t length, std::size_t vertices, bool optional) {
    if (length == vertices || (optional && length == 0)) return;
    fail("there are " + std::to_string(length) + " " + array + ", but " + std::to_string(vertices) +
         " positions");
}

void check_vertices(const Scene& scene) {
    const std::size_t vertices = scene.positions.size();
    check_length("normals", scene.normals.size(), vertices, false);
    check_length("uvs", scene.uvs.size(), vertices, true);
    check_length("colors", scene.colors.size(), vertices, true);
    for (std::size_t i = 0; i < vertices; ++i) {
        if (!is_place(scene.positions[i])) {
            fail(entry("position", i) + " is not finite or beyond 1e18 m");
        }
        if (!is_unit(scene.normals[i])) {
            fail(entry("normal", i) + " has length " +
                 std::to_string(glm::length(scene.normals[i])));
        }
    }
    for (std::size_t i = 0; i < scene.uvs.size(); ++i) {
        if (!is_finite(scene.uvs[i])) fail(entry("uv", i) + " is not finite");
    }
    for (std::size_t i = 0; i < scene.colors.size(); ++i) {
        for (int c = 0; c < 4; ++c) {
            if (!is_within(scene.colors[i][c], 0.0f, 1.0f)) {
                fail(entry("color", i) + " has a channel outside 0..1");
            }
        }
    }
}

void check_triangles(const Scene& scene) {
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const SceneTriangle& triangle = scene.triangles[i];
        for (const std::uint32_t vertex : triangle.vertex) {
            if (vertex >= scene.positions.size()) {
                fail(entry("triangle", i) + " names vertex " + std::to_string(vertex) +
                     ", there are " + std::to_string(scene.positions.size()));
            }
        }
        if (triangle.material >= scene.materials.size()) {
            fail(entry("triangle", i) + " names material " + std::to_string(triangle.material) +
                 ", there are " + std::to_string(scene.materials.size()));
        }
    }
    for (std::size_t i = 0; i < scene.parts.size(); ++i) {
        const Part& part = scene.parts[i];
        const std::size_t end = std::size_t{part.first_triangle} + part.triangle_count;
        if (end > scene.triangles.size()) {
            fail(entry("part", i) + " ends at triangle " + std::to_string(end) + ", there are " +
                 std::to_string(scene.triangles.size()));
        }
    }
}

void check_textures(const Scene& scene) {
    for (std::size_t i = 0; i < scene.textures.size(); ++i) {
        const Texture& texture = scene.textures[i];
        if (texture.width <= 0 || texture.height <= 0) {
            fail(entry("texture", i) + " is of " + std::to_string(texture.width) + "x" +
                 std::to_string(texture.height) + " texels");
        }
        const std::size_t bytes =
            static_cast<std::size_t>(texture.width) * static_cast<std::size_t>(texture.height) * 4;
        if (texture.rgba.size() != bytes) {
            fail(entry("texture", i) + " has " + std::to_string(texture.rgba.size()) +
                 " bytes, needs " + std::to_string(bytes));
        }
    }
}

void check_slot(const Scene& scene, const TextureSlot& slot, const std::string& name) {
    if (slot.texture < -1 || slot.texture >= static_cast<int>(scene.textures.size())) {
        fail(name + " names texture " + std::to_string(slot.texture) + ", there are " +
             std::to_string(scene.textures.size()));
    }
    if (slot.texture < 0) return;
    if (slot.uv_set != 0 && slot.uv_set != 1) {
        fail(name + " reads uv set " + std::to_string(slot.uv_set) + ", there are 0 and 1");
    }
    for (int column = 0; column < 3; ++column) {
        if (!is_finite(slot.transform[column])) fail(name + " has a uv transform not finite");
    }
    if (scene.uvs.empty() && !scene.positions.empty()) {
        fail(name + " is textured, but there are no uvs");
    }
}

void check_materials(const Scene& scene) {
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        const std::string name = entry("material", i);
        for (int c = 0; c < 4; ++c) {
            if (!is_within(material.base_color[c], 0.0f, 1.0f)) {
                fail(name + " has a base color outside 0..1");
            }
        }
        for (int c = 0; c < 3; ++c) {
            if (!(material.emission[c] >= 0.0f) || !std::isfinite(material.emission[c])) {
                fail(name + " has an emission that is negative or not finite");
            }
        }
        if (!is_within(material.metallic, 0.0f, 1.0f)) fail(name + " is metallic outside 0..1");
        if (!is_within(material.roughness, 0.0f, 1.0f)) fail(name + " is rough outside 0..1");
        if (!is_within(material.specular, 0.0f, 1.0f)) fail(name + " is specular outside 0..1");
        if (material.ior != 0.0f && !is_within(material.ior, 1.0f, 1e6f))
            fail(name + " has an index of refraction outside 1..1e6 that is not 0");
        if (!(material.alpha_cutoff >= 0.0f) || !std::isfinite(material.alpha_cutoff)) {
            fail(name + " has an alpha cutoff that is negative or not finite");
        }
        check_slot(scene, material.base_texture, name);
        check_slot(scene, material.emission_texture, name);
        check_slot(scene, material.metallic_roughness_texture, name);
        check_slot(scene, material.normal_texture, name);
        for (int c = 0; c < 2; ++c) {
            if (!is_within(material.metallic_roughness_factor[c], 0.0f, 1.0f))
                fail(name + " has a metallic-roughness factor outside 0..1");
        }
        if (!is_within(material.normal_scale, -100.0f, 100.0f))
            fail(name + " has a normal scale outside -100..100");
    }
}

void check_cameras(const Scene& scene) {
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        const Camera& camera = scene.cameras[i];
        const std::string name = entry("camera", i);
        if (!is_place(camera.position)) fail(name + " has a position that is not finite");
        if (!is_unit(camera.right) || !is_unit(camera.up) || !is_unit(camera.forward)) {
            fail(name + " has an axis that is not unit");
        }
        const bool orthogonal = std::abs(glm::dot(camera.right, camera.up)) <= unit_tolerance &&
                                std::abs(glm::dot(camera.up, camera.forward)) <= unit_tolerance &&
                                std::abs(glm::dot(camera.forward, camera.right)) <= unit_tolerance;
        if (!orthogonal) fail(name + " has axes that are not orthogonal");
        if (glm::dot(glm::cross(camera.right, camera.up), camera.forward) > 0.0f) {
            fail(name + " has axes that are not right-handed");
        }
        if (camera.kind == Camera::Kind::perspective &&
            !(camera.vertical_fov > 0.0f && camera.vertical_fov < std::numbers::pi_v<float>)) {
            fail(name + " has a field of view outside 0..pi");
        }
        if (camera.kind == Camera::Kind::orthographic &&
            !(camera.half_height > 0.0f && std::isfinite(camera.half_height))) {
            fail(name + " has a half height that is not above 0");
        }
        if (!(camera.near >= 0.0f) || !std::isfinite(camera.near)) {
            fail(name + " has a near distance that is negative or not finite");
        }
        if (!std::isfinite(camera.offset.x) || !std::isfinite(camera.offset.y)) {
            fail(name + " has an offset that is not finite");
        }
        if (!(camera.footprint > 0.0f && camera.footprint <= 1.0f)) {
            fail(name + " has a footprint outside (0, 1]");
        }
    }
}

void check_bounds(const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis) {
        if (!(box.low[axis] <= box.high[axis]) || !is_place(box.low) || !is_place(box.high)) {
            fail("the moving bounds have low above high, or a corner beyond 1e18 m");
        }
    }
}

void check_focus(const Focus& focus) {
    if (!is_place(focus.centre) || !(focus.radius > 0.0) || !std::isfinite(focus.radius))
        fail("the focus has a centre beyond 1e18 m, or a radius that is not above 0 or not finite");
}

void check_environment(const Environment& environment) {
    const std::string size =
        std::to_string(environment.width) + "x" + std::to_string(environment.height);
    const bool none = environment.width == 0 && environment.height == 0;
    if (!none && !(environment.width >= 1 && environment.width <= 65536 &&
                   environment.height >= 1 && environment.height <= 65536)) {
        fail("the environment is of " + size + " texels, 0x0 or 1x1 to 65536x65536 needed");
    }
    const std::size_t texels =
        static_cast<std::size_t>(environment.width) * static_cast<std::size_t>(environment.height);
    constexpr std::size_t most = (std::size_t{1} << 31) / 3;  // kernels count channels in ints
    if (texels > most) {
        fail("the environment is of " + size + " texels, at most " + std::to_string(most) +
             " needed");
    }
    if (environment.texels.size() != texels) {
        fail("the environment of " + size + " texels has " +
             std::to_string(environment.texels.size()));
    }
    if (!std::isfinite(environment.rotation)) fail("the environment's rotation is not finite");
    for (int c = 0; c < 3; ++c) {
        const float factor = environment.factor[c];
        if (!(factor >= 0.0f) || !std::isfinite(factor)) {
            fail("the environment has a factor that is negative or not finite");
        }
    }
    for (std::size_t i = 0; i < texels; ++i) {
        for (int c = 0; c < 3; ++c) {
            const float value = environment.texels[i][c];
            if (!(value >= 0.0f) || !std::isfinite(value * environment.factor[c])) {
                fail(entry("environment texel", i) + " is negative or not finite");
            }
        }
    }
    // A quarter of the largest float: directions that stand for it add up, and exposure is the next
    // power of two.
    const glm::dvec3 fluence = environment_fluence(environment);
    if (!(std::max({fluence.x, fluence.y, fluence.z}) <=
          0.25 * double{std::numeric_limits<float>::max()})) {
        fail("the environment is brighter than 8e37 lux over all directions");
    }
}

}  // namespace

void validate_light(const Light& light, std::size_t index) {
    const std::string name = entry("light", index);
    if (!is_place(light.position)) fail(name + " has a position that is not finite");
    for (int c = 0; c < 3; ++c) {
        if (!(light.intensity[c] >= 0.0f) || !std::isfinite(light.intensity[c])) {
            fail(name + " has an intensity that is negative or not finite");
        }
    }
    if (!(light.range >= 0.0f) || !std::isfinite(light.range)) {
        fail(name + " has a range that is negative or not finite");
    }
    if (light.kind == Light::Kind::point) return;
    if (!is_unit(light.direction)) fail(name + " has a direction that is not unit");
    if (light.kind != Light::Kind::spot) return;
    if (!(light.outer_angle > 0.0f && light.outer_angle <= right_angle + 1e-6f)) {
        fail(name + " has an outer cone angle outside 0..pi/2");
    }
    if (!is_within(light.inner_angle, 0.0f, light.outer_angle)) {
        fail(name + " has an inner cone angle outside 0..its outer one");
    }
}

void validate(const Scene& scene) {
    check_vertices(scene);
    check_triangles(scene);
    check_textures(scene);
    check_materials(scene);
    for (std::size_t i = 0; i < scene.lights.size(); ++i) validate_light(scene.lights[i], i);
    check_cameras(scene);
    if (scene.environment) check_environment(*scene.environment);
    if (scene.moving_bounds) check_bounds(*scene.moving_bounds);
    if (scene.focus) check_focus(*scene.focus);
    if (scene.animation) validate_animation(*scene.animation, scene);
}

Bounds bounds(const Scene& scene) {
    Bounds box;
    bool first = true;
    for (const SceneTriangle& triangle : scene.triangles) {
        for (const std::uint32_t vertex : triangle.vertex) {
            const glm::dvec3& p = scene.positions[vertex];
            box.low = first ? p : glm::min(box.low, p);
            box.high = first ? p : glm::max(box.high, p);
            first = false;
        }
    }
    return box;
}

bool has_emission(const Scene& scene) {
    for (const SceneTriangle& triangle : scene.triangles) {
        if (scene.materials[triangle.material].emission != glm::vec3(0.0f)) return true;
    }
    return false;
}

}  // namespace clgi
