// Luminance of pictures.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/io/image.hpp>
#include <string>
#include <vector>

#include "scene/luminance.hpp"

namespace clgi::report {

// Of every pixel. Channels are found by name: files keep them in an order of their own.
inline std::vector<double> luminance_of(const io::Image& picture) {
    std::vector<double> out(static_cast<std::size_t>(picture.width) *
                            static_cast<std::size_t>(picture.height));
    for (std::size_t c = 0; c < 3; ++c) {
        const std::vector<float>& values = picture.find(std::string(1, "RGB"[c]))->values;
        for (std::size_t i = 0; i < out.size(); ++i)
            out[i] += luminance_weights[c] * double{values[i]};
    }
    return out;
}

}  // namespace clgi::report
