// The views of an emitter: its shadow maps, as they lie in the local frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/gbuffer.h>
#include <clgi/advanced/emitters.hpp>
#include <vector>

namespace clgi::shadow_views {

// Any unit vector across n.
glm::vec3 across(const glm::vec3& n);

// Of the shifts of all points.
std::uint32_t seed_of(const EmitterOptions& options);

View window(const glm::vec3& eye, const glm::vec3& right, const glm::vec3& up,
            const glm::vec3& forward, float extent_x, float extent_y, float near, int width,
            int height);

// The map of every EmitterOptions::sample lies differently within its texels.
void shift_texels(View& view, const EmitterOptions& options);

// Of point lights and wide spots.
std::vector<View> cube(const glm::vec3& eye, float near, const EmitterOptions& options);

// The face along the normal and the outer halves of the four around it.
std::vector<View> hemicube(const glm::vec3& eye, const glm::vec3& normal, float near, int size);

// What a directional light sees of a box: a rectangle across its axis.
struct Outline {
    glm::vec3 right, up;
    glm::vec2 low, high;  // along right and up, from the origin
};

// Turned as one side of the box, or as `right` says, whichever is smallest. around: by how much it
// is larger than the box.
Outline outline(const LocalBox& box, float around, const glm::vec3& axis, const glm::vec3& right);

}  // namespace clgi::shadow_views
