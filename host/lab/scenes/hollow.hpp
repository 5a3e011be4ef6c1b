// Rooms: a closed shell around an inside, with openings through walls of a thickness.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/scene.hpp>
#include <functional>
#include <vector>

namespace clgi::generated {

enum Wall { low_x, high_x, low_y, high_y, low_z, high_z, wall_count };

// The inside is the box between the first and the last cuts of each axis. All walls are cut at all
// of them, so no edge ends in the middle of another one.
struct Hollow {
    std::array<std::vector<double>, 3> cuts;            // rising, metres
    std::array<std::uint32_t, wall_count> materials{};  // inside
    // With openings: metres of wall between the inside and the outer faces.
    double thickness = 0.0;
    std::uint32_t outside = 0;
    // Which cells of a wall are open, by their middle; not those along its edges. None: there is no
    // outer side, and the shell faces inward alone.
    std::function<bool(Wall, const glm::dvec3&)> open;
};

// Both sides and the faces within the openings are one closed surface around the walls.
void add_hollow(Scene& scene, const Hollow& room);

// count + 1 equal steps from low to high.
std::vector<double> even_cuts(double low, double high, int count);

}  // namespace clgi::generated
