// Luminance of linear Rec.709, for hosts.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

namespace clgi {

inline constexpr double luminance_weights[3] = {0.2126, 0.7152, 0.0722};

template <typename T>
T luminance(const glm::vec<3, T>& rgb) {
    return glm::dot(
        rgb, glm::vec<3, T>(luminance_weights[0], luminance_weights[1], luminance_weights[2]));
}

}  // namespace clgi
