// Lights and cameras that a node carries.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

#include "scene/node_matrix.hpp"

namespace clgi {

// Puts a light where the node is. It stays where it was if the node has no place or direction.
inline void carry(const glm::dmat4& node, Light& light) {
    const NodePlace place(node);
    const bool directed = light.kind != Light::Kind::point;
    if (!place.is_usable(directed ? place.forward : glm::dvec3(1.0))) return;
    light.position = place.position;
    if (directed) light.direction = glm::vec3(place.forward);
}

inline void carry(const glm::dmat4& node, Camera& camera) {
    const NodePlace place(node);
    if (!place.is_usable(place.right)) return;
    camera.position = place.position;
    camera.right = glm::vec3(place.right);
    camera.up = glm::vec3(glm::cross(place.right, place.forward));
    camera.forward = glm::vec3(place.forward);
}

}  // namespace clgi
