// Luminance of linear Rec.709, for hosts.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace clgi {

inline constexpr double luminance_weights[3] = {0.2126, 0.7152, 0.0722};

template <typename T>
T luminance(const glm::vec<3, T>& rgb) {
    return glm::dot(
        rgb, glm::vec<3, T>(luminance_weights[0], luminance_weights[1], luminance_weights[2]));
}

// Of every pixel, from planes of red, green and blue.
inline std::vector<double> luminances(const std::array<const float*, 3>& planes,
                                      std::size_t pixels) {
    std::vector<double> out(pixels);
    for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t i = 0; i < pixels; ++i)
            out[i] += luminance_weights[c] * double{planes[c][i]};
    return out;
}

}  // namespace clgi
