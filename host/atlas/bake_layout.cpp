// SPDX-License-Identifier: MIT
#include <clgi/adjacency.hpp>
#include <clgi/bake_layout.hpp>
#include <future>

#include "atlas/placement.hpp"
#include "vpl/patches.hpp"

namespace clgi {

BakeLayout make_bake_layout(const Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas) {
    const PatchOptions patch_options;
    check_patches(scene, patch_options);
    const Adjacency mesh = adjacency(scene);
    BakeLayout out;
    out.patches = make_patches(scene, mesh, patch_options);
    std::future<AtlasLayout> texels = std::async(std::launch::async, [&] {
        return make_atlas(scene, out.patches.triangle_patch, &mesh, atlas);
    });
    out.vpls = place_vpls(scene, out.patches, vpls);
    out.atlas = texels.get();
    return out;
}

}  // namespace clgi
