// Patches of a mesh whose neighbours are known already.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/adjacency.hpp>
#include <clgi/advanced/patches.hpp>

namespace clgi {

// Throws what make_patches throws for options and materials.
void check_patches(const Scene& scene, const PatchOptions& options);

// mesh: adjacency(scene). Nothing is checked.
Patches make_patches(const Scene& scene, const Adjacency& mesh, const PatchOptions& options);

}  // namespace clgi
