// A few directional lights that stand for an environment.                        [Debevec05]
//
// The picture is cut in two where its luminance times solid angle is halved, across its longer
// side in angle; of the parts the strongest is cut next, until there are as many as wanted. Each
// part becomes one light with all of its light, where its light has its centre.
//
// Unlike paper any number of parts, not a power of two: the strongest is cut, not every one. Texels
//              are split first where the picture is coarse.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/scene.hpp>
#include <vector>

#include "scene/sky_cells.hpp"

namespace clgi {

// At most `count` lights, fewer where the picture has fewer texels that shine; together as bright
// as the environment, to the rounding of doubles. The same environment gives the same lights.
std::vector<SkyLight> median_cut(const Environment& environment, int count);

}  // namespace clgi
