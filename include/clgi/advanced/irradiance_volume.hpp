// An irradiance volume: points of a grid in space, at each of which a bake finds what arrives from
// twelve directions. It lights what moves through the light of an atlas.             [Greger98]
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/volume.h>
#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

// A place in space that light is baked at, and the way that it faces.
struct BakePoint {
    glm::dvec3 position = glm::dvec3(0.0);  // metres
    glm::vec3 normal = glm::vec3(0.0f);     // unit
};

// Where points lie in the light of a bake behind so many texels: at the beginning of a packet.
constexpr std::uint32_t first_bake_point(std::size_t texels) {
    constexpr std::size_t packet = 16;
    return static_cast<std::uint32_t>((texels + packet - 1) / packet * packet);
}

// Points lie in the middle of equal cubes. Outside of them the nearest ones count.
struct IrradianceVolume {
    glm::dvec3 first = glm::dvec3(0.0);  // metres, the point with the least coordinates
    double spacing = 1.0;                // metres between points, > 0
    glm::ivec3 count = glm::ivec3(1);    // along x, y and z, each at least 1
};

// As many points as `most` allows, which is at least 1, in cubes that cover the box. Throws Error
// for a box that is not finite or whose corners are not in order.
CLGI_API IrradianceVolume make_irradiance_volume(const Bounds& box, int most);

// VOLUME_DIRECTIONS for each point of the grid, x fastest, then y, then z.
CLGI_API std::vector<BakePoint> points_of(const IrradianceVolume& volume);

}  // namespace clgi
