// What drawn scenes are put together from.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <cstdint>
#include <optional>

namespace clgi::generated {

// The same numbers on every machine. [Steele14: SplitMix]
class Draws {
public:
    explicit Draws(std::uint64_t seed) : state_(seed * 0x9e3779b97f4a7c15u + 1) {}
    double between(double low, double high);
    int whole(int low, int high);  // both included
    glm::vec3 colour();            // reflectance of a wall or of a thing

private:
    std::uint64_t state_;
};

struct Hole {
    int wall = 0;                     // 0, 1: low and high x; 2, 3: low and high z
    double low = 0.0, high = 1.0;     // along the wall
    double sill = 1.0, lintel = 2.0;  // heights
};

// From the corner `low` on, floor at low.y.
struct Chamber {
    glm::dvec3 low = glm::dvec3(0.0), size = glm::dvec3(4.0, 2.7, 5.0);
    double wall = 0.2;  // thickness
    bool roof = true;
};

Chamber draw_chamber(Draws& draws);
Hole draw_window(Draws& draws, const Chamber& chamber);

// Walls, floor and roof, each of its own colour; faces outward on both sides of the walls.
void add_chamber(Scene& scene, Draws& draws, const Chamber& chamber,
                 const std::optional<Hole>& hole = std::nullopt);
// Blocks, cushions and rods on the floor, in the half that is away from the camera.
void add_furniture(Scene& scene, Draws& draws, const Chamber& chamber, float roughness = 1.0f);
// A square below the roof that emits downward; cd/m^2.
void add_lamp(Scene& scene, const Chamber& chamber, const glm::dvec2& share, double side,
              float radiance);
// In the corner of low x and z; looks across the chamber, at furniture.
void add_view(Scene& scene, Draws& draws, const Chamber& chamber);
// Around a place that stays free, `free` metres to either side; relief: metres, 0 is a plane.
void add_ground(Scene& scene, Draws& draws, const Chamber& chamber, double extent, double relief);

}  // namespace clgi::generated
