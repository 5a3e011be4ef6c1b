// A sky in two parts: small bright ones such as the sun, lamps and gaps between clouds, and the
// rest. Pixels of a hemicube see the rest well; the bright ones need shadows of their own.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/device_scene.hpp>

namespace clgi {

struct SkyParts {
    Environment soft;    // as bright as 16 times the mean luminance at most
    Environment bright;  // what is beyond that, of the same colour
    BrightSky found;
};

// Together they are the environment, to the rounding of floats. Share 0, no picture in `bright` and
// nothing missing in `soft` where half a percent of the light or less is beyond.
SkyParts sky_parts(const Environment& environment);

}  // namespace clgi
