// Potentially visible sets of receivers [Kautz04, section 3.2]: the triangles that each sees in the
// frames of an animation, as lists of singles for BlockerBuffers.
//
//   1. Clear a buffer of visible_words(triangle_count) * stride words.
//   2. For every frame: MaskPasses::receivers, blockers and visible, which adds to the buffer.
//   3. visible_sets of the words. BlockerBuffers gets the lists, and no clusters (ranges {0, 0}).
//
// In those frames the masks are the same, bit for bit, with EdgePlanes::exact. In others they miss
// what comes into view only there. For sets that depend on time, clear the buffer before each
// frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <clgi/advanced/export.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace clgi {

struct VisibleSets {
    std::vector<std::uint32_t> near_lists;  // [receivers + 1] where each begins in `near`
    std::vector<std::uint32_t> near;        // triangles, ascending, each once a receiver
};

// Words of bits for each receiver.
inline std::size_t visible_words(std::uint32_t triangle_count) {
    return (std::size_t{triangle_count} + 31) / 32;
}

// seen: [visible_words][stride] as MaskPasses::visible writes them, read back. rings: lists that
// are united with what is seen, such as BlockerLevels::near_lists and near; none where both are
// empty.
// Throws Error for arrays of other sizes and lists that name triangles that do not exist.
CLGI_API VisibleSets visible_sets(const std::vector<std::uint32_t>& seen, std::uint32_t receivers,
                                  std::uint32_t stride, std::uint32_t triangle_count,
                                  const VisibleSets& rings = {});

}  // namespace clgi
