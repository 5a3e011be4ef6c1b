// What stands still in a scene, as a scene of its own: what a bake may stand on while the rest
// moves.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <clgi/scene.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

struct StaticScene {
    Scene scene;  // without animation and without parts, in the whole scene's frame on the device
    std::vector<std::uint32_t> triangles;  // [triangles of scene] which one of the whole it is
    bool moving_emission = false;          // a triangle that is not in it has a material that emits
};

// Whether a clip moves a vertex of a triangle.
CLGI_API bool moves(const Scene& scene);

// The triangles of which no vertex follows what a clip moves. Lights, materials and the environment
// are all there, so that light on the device has the same unit in both: lights are those of the
// scene's arrays, and surfaces that move and emit are missing.
CLGI_API StaticScene static_scene(const Scene& scene);

}  // namespace clgi
