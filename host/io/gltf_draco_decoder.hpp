// A Draco stream, decoded within bounds that hold before anything is allocated.
// SPDX-License-Identifier: MIT
#pragma once

#include <draco/mesh/mesh.h>

#include <memory>

#include "io/gltf_codecs.hpp"
#include "io/gltf_image.hpp"

namespace clgi::io::gltf {

// What the primitive says of its mesh.
struct DracoCounts {
    std::size_t points;
    std::size_t corners;  // of its indices
    bool strip;           // they are those of a strip, so there are at most as many triangles
};

// Throws InputError for a stream that is damaged, that has other counts, that has more than `most`
// triangles, or whose size is beyond the budget.
std::unique_ptr<draco::Mesh> decode_draco(Bytes stream, const DracoCounts& counts, std::size_t most,
                                          UnpackBudget& budget);

}  // namespace clgi::io::gltf
