// Scenes of the kinds that pictures are asked of, drawn from a seed: rooms with furniture, lamps
// and windows, courtyards, terrains, many rooms, very bright beside very dim.
//
// Two seeds differ in sizes, colours, furniture, places of lamps and windows, and the view. Every
// scene has a camera; those that the sky lights have no light of their own. Walls have a thickness.
// Lengths in metres. An option out of range throws Error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <string>
#include <vector>

namespace clgi {

struct DrawnOptions {
    std::uint32_t seed = 0;
    double extent = 0.0;  // half the side of the ground around, [0,1e5]; 0: as the kind has it
};

struct DrawnKind {
    std::string name;
    std::string what;  // a few words
    bool sky;          // needs an environment
    Scene (*draw)(const DrawnOptions& options);
};

// room, window, slit, courtyard, pit, terrain, many-rooms, dim-room, dim-plain, hidden-wall, hole and
// gloss.
const std::vector<DrawnKind>& drawn_kinds();
// Throws Error for a name that is none of them.
Scene drawn(const std::string& kind, const DrawnOptions& options = {});

}  // namespace clgi
