// SPDX-License-Identifier: MIT
#include "view/controls.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace clgi::view {
namespace {

constexpr double turn = 0.006;  // radians a pixel of the mouse

glm::vec3 rotated(const glm::vec3& way, double angle, const glm::vec3& axis) {
    return glm::vec3(glm::rotate(glm::dmat4(1.0), angle, glm::dvec3(axis)) *
                     glm::dvec4(glm::dvec3(way), 0.0));
}

// Suns and spots turn about the camera's axes; point lights move beside the screen.
void drag_light(const Camera& camera, Light& light, float right, float down, int height) {
    if (light.kind == Light::Kind::point) {
        const double depth =
            std::abs(glm::dot(light.position - camera.position, glm::dvec3(camera.forward)));
        const double metres = camera.kind == Camera::Kind::orthographic
                                  ? 2.0 * camera.half_height / height
                                  : 2.0 * depth * std::tan(0.5 * camera.vertical_fov) / height;
        light.position += metres * (double{right} * glm::dvec3(camera.right) -
                                    double{down} * glm::dvec3(camera.up));
        return;
    }
    light.direction = rotated(light.direction, turn * right, camera.up);
    light.direction = glm::normalize(rotated(light.direction, turn * down, camera.right));
}

void choose_method(int key, Shown& shown) {
    if (key < GLFW_KEY_0 || key > GLFW_KEY_6) return;
    shown.method.reset();
    if (key > GLFW_KEY_0) shown.method = static_cast<Method>(key - GLFW_KEY_1);
    shown.by_hand.reset();
    ++shown.set;
}

// W, A, S, D, Q, E: metres a second, a share of the distance.
glm::dvec3 steps(const Window& window) {
    const auto along = [&](int plus, int minus) {
        return double(window.holds(plus)) - double(window.holds(minus));
    };
    return {along(GLFW_KEY_D, GLFW_KEY_A), along(GLFW_KEY_E, GLFW_KEY_Q),
            along(GLFW_KEY_W, GLFW_KEY_S)};
}

bool move_camera(Window& window, const Bounds& box, Viewpoint& viewpoint) {
    const ImGuiIO& io = ImGui::GetIO();
    bool moved = false;
    if (!io.WantCaptureMouse) {
        const double x = turn * io.MouseDelta.x, y = turn * io.MouseDelta.y;
        const bool drags = x != 0.0 || y != 0.0;
        if (io.MouseDown[0] && drags) orbit(viewpoint, x, y);
        if (io.MouseDown[1] && drags) look(viewpoint, -x, y);
        if (io.MouseWheel != 0.0f)
            approach(viewpoint, std::pow(0.9, io.MouseWheel),
                     0.5 * glm::length(box.high - box.low));
        moved = (drags && (io.MouseDown[0] || io.MouseDown[1])) || io.MouseWheel != 0.0f;
    }
    const glm::dvec3 by = io.WantCaptureKeyboard ? glm::dvec3(0.0) : steps(window);
    if (by == glm::dvec3(0.0)) return moved;
    const double distance = glm::length(viewpoint.target - viewpoint.eye);
    walk(viewpoint, 0.5 * distance * double{std::min(io.DeltaTime, 0.1f)} * by);
    return true;
}

}  // namespace

void follow_input(Window& window, const Subject& subject, const Drawn& drawn, Shown& shown,
                  Controls& controls) {
    const ImGuiIO& io = ImGui::GetIO();
    if (!io.WantCaptureKeyboard)
        for (const int key : window.pressed()) {
            choose_method(key, shown);
            if (key == GLFW_KEY_P) controls.save = true;
            if (key == GLFW_KEY_H) controls.panel = !controls.panel;
            if (key == GLFW_KEY_SPACE) controls.playing = !controls.playing;
            if (key == GLFW_KEY_ESCAPE) window.close();
        }
    const float right = io.MouseDelta.x, down = io.MouseDelta.y;
    const bool drags = !io.WantCaptureMouse && io.MouseDown[0] && (right != 0.0f || down != 0.0f);
    if (io.KeyCtrl || io.KeyShift) {
        if (drags && io.KeyCtrl && controls.light < drawn.lights.size()) {
            Light& light = shown.lights.try_emplace(controls.light, drawn.lights[controls.light])
                               .first->second;
            drag_light(drawn.camera, light, right, down, window.height());
            ++shown.lit;
        } else if (drags && io.KeyShift && subject.scene.environment) {
            shown.turn = std::remainder(shown.turn + 0.5 * double{right}, 360.0);
            ++shown.lit;
        }
        return;
    }
    Viewpoint viewpoint =
        shown.viewpoint ? *shown.viewpoint : viewpoint_of(drawn.camera, controls.box);
    if (!move_camera(window, controls.box, viewpoint)) return;
    shown.viewpoint = viewpoint;
    ++shown.moved;
}

}  // namespace clgi::view
