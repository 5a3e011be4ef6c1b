// Luminance of pictures.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <vector>

#include "scene/luminance.hpp"

namespace clgi::lab {

// Of every pixel. Channels are found by name: files keep them in an order of their own.
inline std::vector<double> luminance_of(const io::Image& picture) {
    const auto plane = [&](const char* name) { return picture.find(name)->values.data(); };
    return luminances(
        {plane("R"), plane("G"), plane("B")},
        static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
}

}  // namespace clgi::lab
