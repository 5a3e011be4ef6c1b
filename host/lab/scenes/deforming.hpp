// Generated scenes that deform, with as many vertices and triangles as the models of [Kautz04,
// table 1]. Their shapes and motions are our own.
//
// Every scene has a camera, a directional light, an environment (a sky that is brighter above than
// below; save_glb does not keep it) and one clip that can be repeated. Surfaces are diffuse unless
// an option says otherwise. Vertices are shared by their triangles. The scene's arrays hold the
// rest pose, in which closed surfaces do not intersect themselves. Lengths in metres, times in
// seconds. An option out of range throws Error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <glm/glm.hpp>

namespace clgi {

// A square cloth that is held at its corners and shaken above a floor: 1,378 vertices and 2,560
// triangles. A small simulation with positions as unknowns gives the wrinkles; its states are
// morph targets, and weights on a cubic curve pass through them.
struct ClothOptions {
    glm::vec3 cloth = glm::vec3(0.70f, 0.16f, 0.12f);  // reflectances, each in [0,1]
    glm::vec3 floor = glm::vec3(0.62f, 0.60f, 0.56f);
    int states = 24;  // of the cloth in the clip of 3.2 s, 4 to 96
};
Scene cloth(const ClothOptions& options = {});

// Six chess pieces that slide, hop and bow on a board: 1,897 vertices and 3,704 triangles. The
// pieces are closed surfaces of revolution, moved by nodes.
struct ChessOptions {
    glm::vec3 white = glm::vec3(0.80f, 0.74f, 0.62f);  // reflectances, each in [0,1]
    glm::vec3 black = glm::vec3(0.16f, 0.10f, 0.08f);
};
Scene chess(const ChessOptions& options = {});

// A figure that boxes and kicks on a mat of 81 tiles: 2,978 vertices and 4,806 triangles. One
// closed surface around 16 joints, a belt around it, and a skin.
struct FightOptions {
    glm::vec3 skin = glm::vec3(0.72f, 0.50f, 0.38f);  // reflectances, each in [0,1]
    glm::vec3 trousers = glm::vec3(0.78f, 0.77f, 0.74f);
    glm::vec3 gloves = glm::vec3(0.62f, 0.08f, 0.07f);
};
Scene fight_like(const FightOptions& options = {});

// A hand that closes to a fist above a table of 96 tiles: 8,636 vertices and 15,854 triangles. One
// closed surface around five fingers of three joints each, five nails, and a skin.
struct HandOptions {
    glm::vec3 skin = glm::vec3(0.74f, 0.52f, 0.41f);  // reflectance, in [0,1]
    float roughness = 1.0f;                           // of the hand, [0.05,1]; below 1 it has gloss
};
Scene hand_like(const HandOptions& options = {});

}  // namespace clgi
