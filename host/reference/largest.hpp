// Where a check found the error.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/reference.hpp>
#include <cstddef>
#include <vector>

#include "reference/traced_pixel.hpp"

namespace clgi::reference {

// The pixels of a picture that wide with most of the squared error, at most `most`, by falling
// share. A pixel that was drawn several times is one, with all its samples.
std::vector<CheckedPixel> largest_of(const std::vector<Traced>& pixels, std::size_t width,
                                     std::size_t most);

}  // namespace clgi::reference
