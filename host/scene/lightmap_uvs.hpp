// Which UV set of a scene is a lightmap.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <string>
#include <vector>

#include "scene/uv_texels.hpp"

namespace clgi {

struct LightmapUvs {
    int uv_set = -1;                    // the first that serves; -1: none does
    UvTexels found;                     // of that set
    std::string faults;                 // why the sets before it, or all, do not serve
    bool meant = false;                 // whether one of those has triangles with an area
    std::vector<std::string> warnings;  // one line each
};

// Tries the sets in their order. A set serves when its triangles lie in the unit square and cover
// texels, at most one in a hundred of them twice; fewer are a warning. size: texels, side of the
// square. Throws Error for numbers out of range.
CLGI_API LightmapUvs lightmap_uvs(const Scene& scene, int size, const std::vector<int>& sets);

}  // namespace clgi
