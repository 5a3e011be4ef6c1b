// What stands in the office. Every piece has its front towards +Z and its foot at y = 0.
// SPDX-License-Identifier: MIT
#pragma once

#include "lab/scenes/solids.hpp"

namespace clgi::generated {

struct OfficeMaterials {
    std::uint32_t plaster, accent, floor, ceiling, outside;
    std::uint32_t wood, pale_wood, metal, black, white, fabric, leather, rug, leaf, clay, paper;
    std::vector<std::uint32_t> books;
};

void add_desk(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_monitor(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_desk_lamp(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_mug(Scene& scene, const Placement& at, std::uint32_t material);
void add_office_chair(Scene& scene, const Placement& at, const OfficeMaterials& materials);
// With books on its boards.
void add_bookcase(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_armchair(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_plant(Scene& scene, const Placement& at, const OfficeMaterials& materials);
// Hangs from a ceiling, at whose height it is placed.
void add_pendant(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_floor_lamp(Scene& scene, const Placement& at, const OfficeMaterials& materials);
void add_waste_bin(Scene& scene, const Placement& at, const OfficeMaterials& materials);
// On a wall at z = 0, around its middle.
void add_picture(Scene& scene, const Placement& at, const glm::dvec2& half_size,
                 std::uint32_t frame, std::uint32_t canvas);

}  // namespace clgi::generated
