// Ground truth for light atlases: irradiance where a scene's lightmap has texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <clgi/reference.hpp>
#include <string>
#include <vector>

namespace clgi::report {

struct AtlasPlaces {
    int size = 0;                          // texels, side of the atlas
    int uv_set = 0;                        // that was taken
    std::vector<std::uint32_t> texels;     // row * size + column, rising
    std::vector<reference::Place> places;  // of each texel's centre
    std::vector<std::string> warnings;     // one line each
};

// Where texels of the atlas lie. uv_set: 0, 1, or -1 for the first of 1 and 0 that serves. A set
// serves when its triangles lie in the unit square and cover texels, at most one in a hundred of
// them twice; fewer are a warning. Throws InputError when none serves.
AtlasPlaces atlas_places(const Scene& scene, int size, int uv_set);

// R, G, B in lux, A (1 where a texel was lit, else 0) and error.Y, with quantity, unit, effects,
// samples, relative error and UV set as attributes.
io::Image atlas_image(const AtlasPlaces& atlas, const reference::Irradiance& irradiance,
                      const std::string& effects);

}  // namespace clgi::report
