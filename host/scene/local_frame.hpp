// The frame that a scene's geometry and light are brought into on the device.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>

namespace clgi {

// The box around two.
Bounds united(const Bounds& box, const std::optional<Bounds>& other);

// Around the middle of a box, or around the focus; exposure 1. A focus that holds the box is none.
SceneFrame local_frame(const Bounds& box, const std::optional<Focus>& focus = std::nullopt);

// The frame's box, and what rounds: vertices within it have shadows of all lights.
Bounds reached(const SceneFrame& frame);

// The power of two that brings the brightest source near 1 in local units.
double common_exposure(const Scene& scene, const SceneFrame& frame);

// Of the scene's radius: a smaller focus has shadow maps of its own for directional lights.
constexpr double small_focus = 0.7;

}  // namespace clgi
