// What shines: lamps without extent, and emissive triangles drawn by what they may bring.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <optional>
#include <vector>

#include "reference/geometry.hpp"
#include "reference/light_tree.hpp"
#include "reference/random.hpp"

namespace clgi::reference {

// Light that would arrive at a point if nothing were in between.
struct Arrival {
    glm::vec3 from;        // where it starts
    glm::vec3 direction;   // unit, towards the light
    glm::vec3 irradiance;  // lux at normal incidence; what has extent: radiance / density
    float density = 0.0f;  // of having drawn this direction, per steradian; 0: a lamp
};

// A point in a direction from another, beyond the scene, whose radius is 1.
inline glm::vec3 beyond(const glm::vec3& point, const glm::vec3& direction) {
    return point + (2.0f + glm::length(point)) * direction;
}

class Lights {
public:
    Lights(const Scene& scene, const Geometry& geometry);

    std::size_t lamp_count() const { return lamps_.size(); }
    // Nothing where the lamp does not shine. point in local units.
    std::optional<Arrival> from_lamp(std::size_t lamp, const glm::vec3& point) const;

    bool has_surfaces() const { return !areas_.empty(); }
    // A point of the emissive surfaces, seen from the side that shines.
    std::optional<Arrival> from_surface(const glm::vec3& point, Random& random) const;
    // Density per steradian with which from_surface() would have drawn this hit.
    float density(const Hit& hit, const glm::vec3& point) const;

private:
    const Geometry& geometry_;
    std::vector<Light> lamps_;
    std::vector<glm::vec3> lamp_positions_;  // local
    std::vector<std::uint32_t> areas_;       // triangle of each emissive one
    std::vector<std::uint32_t> emissive_;    // number of each triangle of the scene in these; none
    LightTree tree_;                         // of these
};

}  // namespace clgi::reference
