// A baked light atlas as a picture, laid out like the ground truth of reference_atlas.hpp.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/io/image.hpp>
#include <string>
#include <vector>

namespace clgi::lab {

// R, G, B in lux and A: 1 where the centre of a texel is covered, else 0. Pages lie below each
// other. irradiance: by AtlasLayout::texels. dilate: also texels that are covered in part, and
// empty ones that interpolation reads, with A = 0; else these are 0.
io::Image baked_image(const AtlasLayout& atlas, const std::vector<glm::vec3>& irradiance,
                      const std::string& effects, bool dilate);

}  // namespace clgi::lab
