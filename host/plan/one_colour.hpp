// Textures that might as well be a number.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>

namespace clgi {

// Whether all texels have the same red, green and blue; alpha may differ.
inline bool one_colour(const Texture& texture) {
    for (std::size_t k = 4; k < texture.rgba.size(); k += 4)
        for (std::size_t c = 0; c < 3; ++c)
            if (texture.rgba[k + c] != texture.rgba[c]) return false;
    return true;
}

}  // namespace clgi
