// Empty texels that interpolation at the edge of a chart reads.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "atlas/placement.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

}  // namespace

void list_dilated(int padding, AtlasLayout& layout) {
    const int size = layout.size;
    const auto side = static_cast<std::size_t>(size);
    // [pages * size * size] index of the texel that is listed there, or of the nearest.
    std::vector<std::uint32_t> source(side * side * static_cast<std::size_t>(layout.pages), none);
    std::vector<bool> listed(source.size());
    for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
        source[layout.texels[i].texel] = i;
        listed[layout.texels[i].texel] = true;
    }
    const auto row_of = [&](std::size_t texel) { return static_cast<int>(texel / side % side); };
    const auto column_of = [&](std::size_t texel) { return static_cast<int>(texel % side); };
    const auto distance = [&](std::size_t texel, std::uint32_t from) {
        const std::size_t other = layout.texels[from].texel;
        const int x = column_of(texel) - column_of(other), y = row_of(texel) - row_of(other);
        return x * x + y * y;
    };
    // visit(texel) for those of its page around texel i.
    const auto around = [&](std::uint32_t i, int reach, auto&& visit) {
        const std::size_t texel = layout.texels[i].texel, page = texel / (side * side);
        const int column = column_of(texel), row = row_of(texel);
        for (int y = std::max(row - reach, 0); y <= std::min(row + reach, size - 1); ++y)
            for (int x = std::max(column - reach, 0); x <= std::min(column + reach, size - 1); ++x)
                visit((page * side + static_cast<std::size_t>(y)) * side +
                      static_cast<std::size_t>(x));
    };
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
        bool at_edge = false;
        around(i, 1, [&](std::size_t texel) { at_edge = at_edge || !listed[texel]; });
        if (!at_edge) continue;
        around(i, padding, [&](std::size_t texel) {
            if (listed[texel]) return;
            if (source[texel] == none)
                found.push_back(static_cast<std::uint32_t>(texel));
            else if (distance(texel, source[texel]) <= distance(texel, i))
                return;
            source[texel] = i;
        });
    }
    std::sort(found.begin(), found.end());
    layout.dilated.reserve(found.size());
    for (const std::uint32_t texel : found) layout.dilated.push_back({texel, source[texel]});
}

}  // namespace clgi
