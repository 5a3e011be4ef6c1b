// SPDX-License-Identifier: MIT
#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/bake_layout.hpp>
#include <future>
#include <system_error>

#include "methods/light_atlas/patches.hpp"
#include "methods/light_atlas/placement.hpp"
#include "methods/light_atlas/vpl_count.hpp"

namespace clgi {
namespace {

// In a thread of its own, or at get() if there is none to be had.
template <typename Work>
std::future<AtlasLayout> beside(const Work& work) {
    try {
        return std::async(std::launch::async, work);
    } catch (const std::system_error&) {
        return std::async(std::launch::deferred, work);
    }
}

}  // namespace

BakeLayout make_bake_layout(const Scene& scene, const VplOptions& vpls, const AtlasOptions& atlas) {
    const PatchOptions patch_options;
    check_patches(scene, patch_options);
    const Adjacency mesh = adjacency(scene);
    BakeLayout out;
    out.patches = make_patches(scene, mesh, patch_options);
    vpl_count(scene, out.patches, vpls);  // a wrong option does not wait for the texels
    std::future<AtlasLayout> texels =
        beside([&] { return make_atlas(scene, out.patches.triangle_patch, &mesh, atlas); });
    out.vpls = place_vpls(scene, out.patches, vpls);
    out.atlas = texels.get();
    return out;
}

}  // namespace clgi
