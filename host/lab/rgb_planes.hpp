// The R, G and B planes of two pictures that are to be compared.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <clgi/io/image.hpp>
#include <utility>
#include <vector>

namespace clgi::lab {

using RgbPlanes = std::array<const std::vector<float>*, 3>;

// Throws InputError when the sizes differ, a picture is empty or lacks one of the three.
std::pair<RgbPlanes, RgbPlanes> rgb_planes(const io::Image& a, const io::Image& b);

}  // namespace clgi::lab
