// Which texels of an atlas are looked up first, and stand for the texels between them.
//
// [Schaerfig16, section 6.2] proposes to fill texels of low resolution first, and all of them only
// where light is discontinuous. Here blocks of 4 x 4 texels ask their corners who is seen
// (AtlasPasses::see_listed, AtlasPasses::see_blocks).
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/shared/atlas.h>
#include <clgi/advanced/atlas_layout.hpp>
#include <clgi/advanced/export.hpp>
#include <cstdint>
#include <vector>

namespace clgi {

// Corners of a block are texels of its chart: its own first ones, and those of the next blocks
// beyond its last ones where there are such, so that neighbours share them.
struct AtlasBlocks {
    std::vector<std::uint32_t> list;  // texels that are looked up first: those in no block, then
                                      // corners that lie in blocks
    std::uint32_t unblocked = 0;      // how many of the list are in no block
    std::vector<AtlasBlock> blocks;   // none is flat yet
};

// Blocks begin at multiples of 4 texels from the first column and row of a chart's box. step:
// texels between corners, 4, or 2 with corners in the middle too. Deterministic. Throws Error for
// another step.
CLGI_API AtlasBlocks make_blocks(const AtlasLayout& atlas, int step);

}  // namespace clgi
