// Empty texels that interpolation at the edge of a chart reads.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "atlas/placement.hpp"

namespace clgi {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

}  // namespace

void list_dilated(int padding, AtlasLayout& layout) {
    const auto size = static_cast<std::uint32_t>(layout.size);
    const auto reach = static_cast<std::uint32_t>(padding);
    // [pages * size * size] index of the texel that is listed there, or of the nearest.
    std::vector<std::uint32_t> source(
        std::size_t{size} * size * static_cast<std::size_t>(layout.pages), none);
    std::vector<bool> listed(source.size());
    for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
        source[layout.texels[i].texel] = i;
        listed[layout.texels[i].texel] = true;
    }
    const auto distance = [&](std::uint32_t column, std::uint32_t row, std::uint32_t from) {
        const std::uint32_t other = layout.texels[from].texel;
        const std::int64_t x = std::int64_t{column} - other % size,
                           y = std::int64_t{row} - other / size % size;
        return x * x + y * y;
    };
    std::vector<std::uint32_t> found;
    for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
        const std::uint32_t texel = layout.texels[i].texel;
        const std::uint32_t row = texel / size % size, column = texel % size;
        const std::uint32_t page = texel - row * size - column;  // its first texel
        const auto is_empty = [&](std::uint32_t x, std::uint32_t y) {
            return x < size && y < size && !listed[page + y * size + x];
        };
        // Most lie within their chart; one beyond 0 wraps to what is no column or row.
        bool at_edge = false;
        for (std::uint32_t k = 0; k < 9 && !at_edge; ++k)
            at_edge = is_empty(column + k % 3 - 1, row + k / 3 - 1);
        if (!at_edge) continue;
        for (std::uint32_t y = row - std::min(row, reach); y <= std::min(row + reach, size - 1);
             ++y)
            for (std::uint32_t x = column - std::min(column, reach);
                 x <= std::min(column + reach, size - 1); ++x) {
                if (!is_empty(x, y)) continue;
                std::uint32_t& nearest = source[page + y * size + x];
                if (nearest == none)
                    found.push_back(page + y * size + x);
                else if (distance(x, y, nearest) <= distance(x, y, i))
                    continue;
                nearest = i;
            }
    }
    std::sort(found.begin(), found.end());
    layout.dilated.reserve(found.size());
    for (const std::uint32_t texel : found) layout.dilated.push_back({texel, source[texel]});
}

}  // namespace clgi
