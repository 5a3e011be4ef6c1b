// All that the host lays out for a light atlas: patches, VPLs on them, texels.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/export.hpp>
#include <clgi/advanced/patches.hpp>
#include <clgi/advanced/vpl_layout.hpp>
#include <clgi/scene.hpp>

namespace clgi {

struct BakeLayout {
    Patches patches;
    VplLayout vpls;
    AtlasLayout atlas;
};

// The same as make_patches, place_vpls and make_atlas one after the other, and faster: VPLs and
// texels depend on the patches alone, so two threads lay them out at once, and which triangles are
// neighbours is found once for all. Throws what these throw, the first of them first.
CLGI_API BakeLayout make_bake_layout(const Scene& scene, const VplOptions& vpls = {},
                                     const AtlasOptions& atlas = {});

}  // namespace clgi
