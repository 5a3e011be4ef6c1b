// SPDX-License-Identifier: MIT
#include <algorithm>
#include <clgi/advanced/atlas_blocks.hpp>
#include <clgi/error.hpp>
#include <tuple>

namespace clgi {
namespace {

constexpr int side = 4;  // texels, of a block

struct Place {
    int page, column, row;
};

// Texels by their places.
class Pages {
public:
    explicit Pages(const AtlasLayout& atlas) : atlas_(atlas), size_(atlas.size) {
        const auto width = static_cast<std::size_t>(size_);
        if (atlas.pages <= 0 || atlas.size <= 0) return;
        listed_.assign(static_cast<std::size_t>(atlas.pages) * width * width, ATLAS_NONE);
        for (std::uint32_t i = 0; i < atlas.texels.size(); ++i)
            if (placed(i)) listed_[atlas.texels[i].texel] = i;
    }

    // Whether a texel is on a page and in a chart: a layout that a program made need not say so.
    bool placed(std::uint32_t i) const {
        const AtlasTexel& texel = atlas_.texels[i];
        return texel.texel < listed_.size() && texel.chart < atlas_.charts.size();
    }

    Place place(std::uint32_t i) const {
        const std::uint32_t texel = atlas_.texels[i].texel;
        const auto size = static_cast<std::uint32_t>(size_);
        return {static_cast<int>(texel / size / size), static_cast<int>(texel % size),
                static_cast<int>(texel / size % size)};
    }

    // Index of the texel there, or ATLAS_NONE if it is not listed for the chart.
    std::uint32_t at(const Place& p, std::uint32_t chart) const {
        if (p.column < 0 || p.row < 0 || p.column >= size_ || p.row >= size_) return ATLAS_NONE;
        const std::size_t line =
            static_cast<std::size_t>(p.page) * static_cast<std::size_t>(size_) +
            static_cast<std::size_t>(p.row);
        const std::uint32_t i =
            listed_[line * static_cast<std::size_t>(size_) + static_cast<std::size_t>(p.column)];
        return i == ATLAS_NONE || atlas_.texels[i].chart != chart ? ATLAS_NONE : i;
    }

    bool full(const Place& from, int width, int height, std::uint32_t chart) const {
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                if (at({from.page, from.column + x, from.row + y}, chart) == ATLAS_NONE)
                    return false;
        return true;
    }

    // Whether each of a block's rows is a run of the list.
    bool runs(const Place& from, std::uint32_t chart) const {
        for (int y = 0; y < side; ++y)
            for (int x = 1; x < side; ++x)
                if (at({from.page, from.column + x, from.row + y}, chart) !=
                    at({from.page, from.column, from.row + y}, chart) + static_cast<unsigned>(x))
                    return false;
        return true;
    }

private:
    const AtlasLayout& atlas_;
    int size_;
    std::vector<std::uint32_t> listed_;
};

// Offsets of corners along an axis; the last is the farthest.
std::vector<int> corners_of(int step, int farthest) {
    return step == 2 ? std::vector<int>{0, 2, farthest} : std::vector<int>{0, farthest};
}

// The block whose first texel lies there, with texels in place of places in the list. No corners:
// none.
AtlasBlock block_at(const Pages& pages, const Place& from, std::uint32_t chart, int step) {
    AtlasBlock out{};
    if (!pages.full(from, side, side, chart) || !pages.runs(from, chart)) return out;
    for (int y = 0; y < side; ++y)
        out.row[y] = pages.at({from.page, from.column, from.row + y}, chart);
    int right = side - 1, below = side - 1;
    for (const auto& [width, height] : {std::pair{5, 5}, {5, 4}, {4, 5}}) {
        if (!pages.full(from, width, height, chart)) continue;
        right = width - 1;
        below = height - 1;
        break;
    }
    for (const int y : corners_of(step, below))
        for (const int x : corners_of(step, right))
            out.corner[out.corners++] = pages.at({from.page, from.column + x, from.row + y}, chart);
    return out;
}

}  // namespace

AtlasBlocks make_blocks(const AtlasLayout& atlas, int step) {
    if (step != 2 && step != 4)
        throw Error("atlas: step of blocks is " + std::to_string(step) + ", 2 or 4 needed");
    const Pages pages(atlas);
    AtlasBlocks out;
    const auto texels = static_cast<std::uint32_t>(atlas.texels.size());
    std::vector<bool> blocked(texels), corner(texels);
    for (std::uint32_t i = 0; i < texels; ++i) {
        if (!pages.placed(i)) continue;
        const Place from = pages.place(i);
        const AtlasChart& chart = atlas.charts[atlas.texels[i].chart];
        if ((from.column - chart.column) % side != 0 || (from.row - chart.row) % side != 0)
            continue;
        const AtlasBlock block = block_at(pages, from, atlas.texels[i].chart, step);
        if (block.corners == 0) continue;
        for (std::uint32_t k = 0; k < BLOCK_TEXELS; ++k) blocked[block.row[k / 4] + k % 4] = true;
        for (std::uint32_t k = 0; k < block.corners; ++k) corner[block.corner[k]] = true;
        out.blocks.push_back(block);
    }
    for (std::uint32_t i = 0; i < texels; ++i)
        if (!blocked[i] || corner[i]) out.list.push_back(i);
    // Texels of a chart's square with 4 x 4 corners follow each other: a packet is near in space.
    const int tile = 4 * step;
    const auto key = [&](std::uint32_t i) {
        if (!pages.placed(i)) return std::make_tuple(false, ATLAS_NONE, 0, 0, 0, 0);
        const Place p = pages.place(i);
        const std::uint32_t chart = atlas.texels[i].chart;
        const AtlasChart& box = atlas.charts[chart];
        return std::make_tuple(static_cast<bool>(blocked[i]), chart, (p.row - box.row) / tile,
                               (p.column - box.column) / tile, p.row, p.column);
    };
    std::stable_sort(out.list.begin(), out.list.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> place(texels, ATLAS_NONE);
    for (std::uint32_t k = 0; k < out.list.size(); ++k) {
        place[out.list[k]] = k;
        out.unblocked += !blocked[out.list[k]];
    }
    for (AtlasBlock& block : out.blocks)
        for (std::uint32_t k = 0; k < block.corners; ++k) block.corner[k] = place[block.corner[k]];
    return out;
}

}  // namespace clgi
