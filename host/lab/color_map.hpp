// Numbers as colours whose distances match what the eye sees. Both maps are drawn in OKLab
// (Ottosson 2020), where equal steps look equal.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>

namespace clgi::lab {

using Color = std::array<std::uint8_t, 3>;  // sRGB

// For signed values, -1 blue, 0 nearly white, +1 red: two straight lines, down in lightness and
// up in chroma, alike in both hues. Values outside are clamped.
Color diverging_color(double value);

// For sizes, 0 dark violet through blue and green to 1 light yellow: a helix of one chroma, so
// that lightness and hue rise evenly. Values outside are clamped.
Color sequential_color(double value);

// On neither map: pixels that do not count, and pixels with a NaN or an infinity.
constexpr Color uncounted_color = {160, 160, 160};
constexpr Color nonfinite_color = {255, 0, 255};

}  // namespace clgi::lab
