// The Cornell box, by the measurements that the Cornell University Program of Computer Graphics
// published: room, blocks and camera in millimetres, reflectances as linear Rec.709.
// SPDX-License-Identifier: MIT
#include <clgi/procedural.hpp>
#include <cmath>

#include "scene/surfaces.hpp"

namespace clgi {
namespace {

using generated::add_quad;
using Quad = std::array<glm::dvec3, 4>;

constexpr double ceiling_height = 548.8;  // mm
constexpr glm::vec3 white(0.725f, 0.71f, 0.68f);
constexpr glm::vec3 red(0.63f, 0.065f, 0.05f);
constexpr glm::vec3 green(0.14f, 0.45f, 0.091f);

constexpr Quad floor_corners = {
    glm::dvec3(552.8, 0, 0), {0, 0, 0}, {0, 0, 559.2}, {549.6, 0, 559.2}};
constexpr Quad ceiling_corners = {
    glm::dvec3(556, 548.8, 0), {556, 548.8, 559.2}, {0, 548.8, 559.2}, {0, 548.8, 0}};
constexpr Quad lamp_corners = {
    glm::dvec3(343, 548.8, 227), {343, 548.8, 332}, {213, 548.8, 332}, {213, 548.8, 227}};
constexpr Quad back_corners = {
    glm::dvec3(549.6, 0, 559.2), {0, 0, 559.2}, {0, 548.8, 559.2}, {556, 548.8, 559.2}};
constexpr Quad right_corners = {
    glm::dvec3(0, 0, 559.2), {0, 0, 0}, {0, 548.8, 0}, {0, 548.8, 559.2}};
constexpr Quad left_corners = {
    glm::dvec3(552.8, 0, 0), {549.6, 0, 559.2}, {556, 548.8, 559.2}, {556, 548.8, 0}};
constexpr Quad short_top = {
    glm::dvec3(130, 165, 65), {82, 165, 225}, {240, 165, 272}, {290, 165, 114}};
constexpr Quad tall_top = {
    glm::dvec3(423, 330, 247), {265, 330, 296}, {314, 330, 456}, {472, 330, 406}};

Quad in_metres(Quad corners) {
    for (glm::dvec3& corner : corners) corner *= 0.001;
    return corners;
}

// The lamp sits in a hole of the ceiling, so that no two faces share a plane and a place.
void add_ceiling_around_lamp(Scene& scene, std::uint32_t material) {
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t next = (i + 1) % 4;
        add_quad(scene,
                 in_metres({ceiling_corners[i], ceiling_corners[next], lamp_corners[next],
                            lamp_corners[i]}),
                 material);
    }
}

// The published blocks have no bottom: they stand on the floor.
void add_block(Scene& scene, const Quad& top, std::uint32_t material) {
    add_quad(scene, in_metres(top), material);
    for (std::size_t i = 0; i < 4; ++i) {
        const glm::dvec3 here = top[i], next = top[(i + 1) % 4];
        const glm::dvec3 below(here.x, 0.0, here.z), next_below(next.x, 0.0, next.z);
        add_quad(scene, in_metres({here, below, next_below, next}), material);
    }
}

void add_lamp(Scene& scene, const CornellOptions& options) {
    const glm::dvec3 under_ceiling(0.278, 0.54, 0.2796);
    if (options.light == LightSource::spot) {
        scene.lights.push_back(generated::spot("spot", under_ceiling, {0.278, 0.0, 0.2796},
                                               options.intensity, options.cone_angle));
    } else if (options.light == LightSource::point) {
        scene.lights.push_back(generated::point("point", under_ceiling, options.intensity));
    } else {
        const auto lamp = generated::add_material(scene, "lamp", glm::vec3(0.78f));
        scene.materials[lamp].emission = options.radiance;
        add_quad(scene, in_metres(lamp_corners), lamp);
        generated::end_part(scene, "lamp");
    }
}

}  // namespace

Scene cornell(const CornellOptions& options) {
    generated::check_color("cornell", "radiance", options.radiance, 1e20);
    generated::check_color("cornell", "intensity", options.intensity, 1e20);
    generated::check_range("cornell", "cone_angle", options.cone_angle, 1e-3, 1.57);

    Scene scene;
    scene.name = "cornell";
    const auto plain = generated::add_material(scene, "white", white);
    const auto left = generated::add_material(scene, "red", red);
    const auto right = generated::add_material(scene, "green", green);

    add_quad(scene, in_metres(floor_corners), plain);
    add_quad(scene, in_metres(back_corners), plain);
    add_quad(scene, in_metres(left_corners), left);
    add_quad(scene, in_metres(right_corners), right);
    if (options.light == LightSource::area) {
        add_ceiling_around_lamp(scene, plain);
    } else {
        add_quad(scene, in_metres(ceiling_corners), plain);
    }
    generated::end_part(scene, "room");
    add_block(scene, short_top, plain);
    generated::end_part(scene, "short block");
    add_block(scene, tall_top, plain);
    generated::end_part(scene, "tall block");
    add_lamp(scene, options);

    // The published camera: focal length 35 mm behind a film 25 mm high.
    const auto fov = static_cast<float>(2.0 * std::atan(12.5 / 35.0));
    scene.cameras.push_back(
        generated::look_at("camera", {0.278, 0.273, -0.8}, {0.278, 0.273, 0.0}, fov));
    return scene;
}

}  // namespace clgi
