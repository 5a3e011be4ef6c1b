// A sweep of the light atlas: bakes with both fillings, against the path tracer at the same texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/light_atlas.hpp>

#include "lab/sweep.hpp"

namespace clgi::lab {

struct AtlasSweep {
    AtlasOptions layout;
    // An atlas to compare with, laid out like the scene's; empty: the path tracer's is made.
    std::filesystem::path reference;
};

inline constexpr const char* atlas_gather = "atlas gather";
inline constexpr const char* atlas_project = "atlas project";

// Methods atlas_gather and atlas_project; one truth, "full": all indirect light. Texels count whose
// centre is covered. Throws what its parts throw, InputError for a reference of another layout, and
// Error when cancelled.
Sweep sweep_atlas(const SweepSetup& setup, const AtlasSweep& atlas);

// The settings that such a sweep tries, by series. Settings that vary one knob alone are in the
// order of that knob, from the least accurate one on.
struct AtlasSettings : SweepSetting {
    VplOptions vpls;
    LightAtlasOptions bake;
};
std::vector<AtlasSettings> atlas_settings(bool quick, const BuildOptions& build = {});

}  // namespace clgi::lab
