// An irradiance volume: points of a grid in space, at each of which a bake finds what arrives from
// twelve directions. It lights what moves through the light of an atlas.             [Greger98]
//
// Each point knows how far the walls around it are, so that it does not light what lies beyond
// them.                                                             [Majercik19]
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
    glm::dvec3 first = glm::dvec3(0.0);  // metres, middle of the cube with the least coordinates
    double spacing = 1.0;                // metres between middles of cubes, > 0
    glm::ivec3 count = glm::ivec3(1);    // cubes along x, y and z, each at least 1
    std::uint32_t open_count = 0;        // points that have light

    // [cubes], x fastest, then y, then z. xyz: the cube's point, spacings from `first`. w: its
    // number among those that have light; below 0: it lies in solid matter and has none.
    std::vector<glm::vec4> places;

    // [open_count][VOLUME_TEXELS] mean distance of surfaces and mean of its square, in spacings and
    // their squares; distances beyond VOLUME_RANGE are VOLUME_RANGE.
    std::vector<glm::vec2> distances;
};

// A grid of cubes that covers the box, with at most `most` points outside of solid matter, 1 to
// 2^20: the finest one of at most `most` cubes, or a finer one, of at most eight times as many, if
// points lie in solid matter. They do if at least half of what they see of `walls` are backs of
// surfaces that are not double-sided. One that finds a way out within half a cube is moved there.
// Masked and blended surfaces hide nothing. Throws Error for a box that is not finite or whose
// corners are not in order, and for `most` out of range.
CLGI_API IrradianceVolume make_irradiance_volume(const Bounds& box, int most,
                                                 const Scene& walls = {});

// VOLUME_DIRECTIONS for each point that has light.
CLGI_API std::vector<BakePoint> points_of(const IrradianceVolume& volume);

}  // namespace clgi
