// Empty texels that interpolation at the edge of a chart reads.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/adjacency.hpp>
#include <cstring>
#include <vector>

#include "methods/light_atlas/placement.hpp"

namespace clgi {
namespace {

// Which texels of the pages are listed. There is a frame of one texel around every page, which
// counts as listed: nothing beyond a page is empty.
class Listed {
public:
    explicit Listed(const AtlasLayout& layout)
        : size_(static_cast<std::size_t>(layout.size)), side_(size_ + 2) {
        flags_.assign(static_cast<std::size_t>(layout.pages) * side_ * side_, 1);
        for (std::size_t row = 0; row < static_cast<std::size_t>(layout.pages) * size_; ++row)
            std::memset(&flags_[place(row / size_, 0, row % size_)], 0, size_);
        for (const AtlasTexel& texel : layout.texels) flags_[place_of(texel.texel)] = 1;
    }

    bool operator()(std::size_t page, std::uint32_t column, std::uint32_t row) const {
        return flags_[place(page, column, row)] != 0;
    }

    // With the eight texels around it.
    bool surrounded(std::uint32_t texel) const {
        const std::uint8_t* const left = &flags_[place_of(texel)] - 1;
        return three(left - side_) && three(left) && three(left + side_);
    }

private:
    static bool three(const std::uint8_t* flags) { return flags[0] & flags[1] & flags[2]; }

    std::size_t place(std::size_t page, std::size_t column, std::size_t row) const {
        return (page * side_ + row + 1) * side_ + column + 1;
    }

    std::size_t place_of(std::uint32_t texel) const {
        return place(texel / size_ / size_, texel % size_, texel / size_ % size_);
    }

    std::size_t size_, side_;
    std::vector<std::uint8_t> flags_;
};

}  // namespace

void list_dilated(int padding, AtlasLayout& layout) {
    const auto size = static_cast<std::uint32_t>(layout.size);
    const auto reach = static_cast<std::uint32_t>(padding);
    // [pages * size * size] index of the listed texel that is nearest to an empty one.
    std::vector<std::uint32_t> source(
        std::size_t{size} * size * static_cast<std::size_t>(layout.pages), no_index);
    const Listed listed(layout);
    const auto distance = [&](std::uint32_t column, std::uint32_t row, std::uint32_t from) {
        const std::uint32_t other = layout.texels[from].texel;
        const std::int64_t x = std::int64_t{column} - other % size,
                           y = std::int64_t{row} - other / size % size;
        return x * x + y * y;
    };
    for (std::uint32_t i = 0; i < layout.texels.size(); ++i) {
        const std::uint32_t texel = layout.texels[i].texel;
        if (listed.surrounded(texel)) continue;  // most lie within their chart
        const std::uint32_t row = texel / size % size, column = texel % size;
        const std::uint32_t page = texel / size / size;
        for (std::uint32_t y = row - std::min(row, reach); y <= std::min(row + reach, size - 1);
             ++y)
            for (std::uint32_t x = column - std::min(column, reach);
                 x <= std::min(column + reach, size - 1); ++x) {
                if (listed(page, x, y)) continue;
                std::uint32_t& nearest = source[(std::size_t{page} * size + y) * size + x];
                if (nearest == no_index || distance(x, y, i) < distance(x, y, nearest)) nearest = i;
            }
    }
    for (std::size_t texel = 0; texel < source.size(); ++texel)
        if (source[texel] != no_index)
            layout.dilated.push_back({static_cast<std::uint32_t>(texel), source[texel]});
}

}  // namespace clgi
