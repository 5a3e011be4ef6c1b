// Which texels of an atlas are looked up first, and which blocks of texels are flat.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <array>
#include <clgi/advanced/atlas_blocks.hpp>
#include <clgi/advanced/patches.hpp>
#include <clgi/error.hpp>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <set>

#include "atlas_checks.hpp"
#include "math_modes.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

struct Place {
    int page, column, row;
};

Place place_of(const AtlasLayout& atlas, std::uint32_t i) {
    const auto size = static_cast<std::uint32_t>(atlas.size);
    const std::uint32_t texel = atlas.texels[i].texel;
    return {static_cast<int>(texel / size / size), static_cast<int>(texel % size),
            static_cast<int>(texel / size % size)};
}

// Every texel is in one block, or first in the list, and nowhere else.
void expect_complete(const AtlasLayout& atlas, const AtlasBlocks& found) {
    std::vector<int> times(atlas.texels.size());
    for (const AtlasBlock& block : found.blocks)
        for (int k = 0; k < BLOCK_TEXELS; ++k) ++times.at(block.row[k / 4] + k % 4);
    const std::set<std::uint32_t> listed(found.list.begin(), found.list.end());
    EXPECT_EQ(listed.size(), found.list.size());
    for (std::uint32_t k = 0; k < found.list.size(); ++k) {
        EXPECT_EQ(times[found.list[k]], k < found.unblocked ? 0 : 1);
        if (k < found.unblocked) ++times[found.list[k]];
    }
    for (const int n : times) EXPECT_EQ(n, 1);
}

// A block's texels are of one chart, 4 by 4, and its corners are that chart's, at 0, 3 or 4 texels.
void expect_corners(const AtlasLayout& atlas, const AtlasBlocks& found, int step) {
    std::set<std::uint32_t> used;
    for (const AtlasBlock& block : found.blocks) {
        const AtlasTexel& first = atlas.texels[block.row[0]];
        const Place from = place_of(atlas, block.row[0]);
        EXPECT_EQ((from.column - atlas.charts[first.chart].column) % 4, 0);
        EXPECT_EQ((from.row - atlas.charts[first.chart].row) % 4, 0);
        EXPECT_EQ(block.flat, 0u);
        for (int k = 0; k < BLOCK_TEXELS; ++k) {
            const std::uint32_t i = block.row[k / 4] + k % 4;
            const Place at = place_of(atlas, i);
            EXPECT_EQ(atlas.texels[i].chart, first.chart);
            EXPECT_EQ(at.page, from.page);
            EXPECT_EQ(at.column - from.column, k % 4);
            EXPECT_EQ(at.row - from.row, k / 4);
        }
        ASSERT_EQ(block.corners, step == 2 ? 9u : 4u);
        const std::uint32_t each = step == 2 ? 3 : 2;
        int right = 0, below = 0;
        for (std::uint32_t k = 0; k < block.corners; ++k) {
            const std::uint32_t i = found.list.at(block.corner[k]);
            used.insert(block.corner[k]);
            const Place at = place_of(atlas, i);
            EXPECT_EQ(atlas.texels[i].chart, first.chart);
            EXPECT_EQ(at.page, from.page);
            const int x = at.column - from.column, y = at.row - from.row;
            right = std::max(right, x);
            below = std::max(below, y);
            EXPECT_TRUE(k % each == each - 1 || x == static_cast<int>(k % each) * 2) << x;
            EXPECT_TRUE(k / each == each - 1 || y == static_cast<int>(k / each) * 2) << y;
        }
        for (const int farthest : {right, below}) EXPECT_TRUE(farthest == 3 || farthest == 4);
    }
    // Nothing is looked up first without need.
    for (std::uint32_t k = found.unblocked; k < found.list.size(); ++k)
        EXPECT_EQ(used.count(k), 1u);
}

// Charts that are turned, cut and curved.
Scene statue() {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, 1);
    test::add_triangle(scene, {0, 2, 0}, {2, 2.5, 0.5}, {0.3, 4, 1});
    test::add_floor(scene, 2.0, -1.5);
    return scene;
}

TEST(AtlasBlocks, HoldEveryTexelOnce) {
    const Scene scene = statue();
    const Patches patches = make_patches(scene);
    for (const int step : {2, 4})
        for (const int size : {16, 50, 96})
            for (const int pages : {1, 3}) {
                AtlasOptions options = test::made_charts(size, 2, pages);
                if (pages > 1) options.texels_per_metre = 0.13 * size;
                const AtlasLayout atlas = make_atlas(scene, patches.triangle_patch, options);
                const AtlasBlocks found = make_blocks(atlas, step);
                expect_complete(atlas, found);
                expect_corners(atlas, found, step);
                if (size > 90) {
                    EXPECT_GT(16 * found.blocks.size(), atlas.texels.size() / 2);
                    EXPECT_LT(found.list.size(), atlas.texels.size() * (step == 2 ? 7 : 5) / 10);
                }
            }
}

// A floor over the whole page: blocks share corners, but for those at the far edges.
TEST(AtlasBlocks, ShareTheirCorners) {
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    for (const glm::vec2 uv : {glm::vec2(0, 1), {1, 1}, {1, 0}, {0, 0}})
        scene.uvs.emplace_back(0, 0, uv.x, uv.y);
    AtlasOptions options;
    options.uvs = AtlasUvs::set_1;
    for (const auto& [size, blocks, corners, unblocked] : {std::array{16, 16, 25, 0},
                                                           {17, 16, 25, 33},
                                                           {18, 16, 25, 68},
                                                           {4, 1, 4, 0},
                                                           {3, 0, 0, 9}}) {
        options.size = size;
        const AtlasLayout atlas = make_atlas(scene, {}, options);
        const AtlasBlocks found = make_blocks(atlas, 4);
        EXPECT_EQ(found.blocks.size(), static_cast<std::size_t>(blocks));
        EXPECT_EQ(found.unblocked, static_cast<std::uint32_t>(unblocked)) << size;
        std::set<std::uint32_t> used;
        for (const AtlasBlock& block : found.blocks)
            for (std::uint32_t k = 0; k < block.corners; ++k)
                used.insert(found.list.at(block.corner[k]));
        EXPECT_EQ(used.size(), static_cast<std::size_t>(corners)) << size;
        expect_complete(atlas, found);
    }
}

// A list in any other order has rows with gaps; such texels are in no block.
TEST(AtlasBlocks, AreOfTexelsWithoutGaps) {
    const Scene scene = statue();
    AtlasLayout atlas =
        make_atlas(scene, make_patches(scene).triangle_patch, test::made_charts(64));
    std::reverse(atlas.texels.begin(), atlas.texels.end());
    const AtlasBlocks found = make_blocks(atlas, 4);
    EXPECT_TRUE(found.blocks.empty());
    EXPECT_EQ(found.unblocked, atlas.texels.size());
    expect_complete(atlas, found);
}

// A layout that a program made may have texels alone.
TEST(AtlasBlocks, NeedPagesAndCharts) {
    const Scene scene = statue();
    const AtlasLayout whole =
        make_atlas(scene, make_patches(scene).triangle_patch, test::made_charts(64));
    AtlasLayout charts = whole, pages = whole, size = whole;
    charts.charts.clear();
    pages.pages = 0;
    size.size = 0;
    for (const AtlasLayout& atlas : {charts, pages, size}) {
        const AtlasBlocks found = make_blocks(atlas, 4);
        EXPECT_TRUE(found.blocks.empty());
        expect_complete(atlas, found);
    }
}

TEST(AtlasBlocks, AreTwoOrFourTexelsWide) {
    const Scene scene = statue();
    const AtlasLayout atlas =
        make_atlas(scene, make_patches(scene).triangle_patch, test::made_charts(32));
    for (const int step : {-4, 0, 1, 3, 8}) EXPECT_THROW(make_blocks(atlas, step), Error);
}

// ---- flat ------------------------------------------------------------------------------------

// 4 x 4 texels on a tilted plane, with gaps between their rows, and four corners.
struct Sheet {
    std::vector<test::SurfacePlace> points, corners;
    AtlasBlock block{};
    glm::vec3 normal, along, across;
    explicit Sheet(std::uint32_t seed) {
        test::Random random(seed);
        normal = test::direction(random);
        along = glm::normalize(glm::cross(normal, test::direction(random))) * 0.11f;
        across = glm::cross(normal, along) * 1.3f;
        const glm::vec3 origin = test::direction(random);
        const test::SurfacePlace other{glm::vec3(9, 8, 7), normal, -normal};
        points.assign(3, other);
        for (int y = 0; y < 4; ++y) {
            block.row[y] = static_cast<cl_uint>(points.size());
            for (int x = 0; x < 4; ++x) points.push_back(at(origin, x, y));
            points.push_back(other);
        }
        corners.assign(2, other);
        for (int k = 0; k < 4; ++k) {
            block.corner[k] = static_cast<cl_uint>(corners.size());
            corners.push_back(at(origin, k % 2 * 4, k / 2 * 4));
        }
        block.corners = 4;  // the fifth is none: it is of another plane
    }
    // The shading normal has no part in it.
    test::SurfacePlace at(const glm::vec3& origin, int x, int y) const {
        return {origin + static_cast<float>(x) * along + static_cast<float>(y) * across, -normal,
                normal};
    }
    float diagonal() const { return 3.0f * glm::length(along + across); }
    // The k-th of its 16 texels, then of its corners.
    test::SurfacePlace& of(std::uint32_t k) {
        return k < BLOCK_TEXELS ? points[block.row[k / 4] + k % 4]
                                : corners[block.corner[k - BLOCK_TEXELS]];
    }
};
constexpr std::uint32_t sheet_points = BLOCK_TEXELS + 4;

// Blocks of sheets, one after the other in the same buffers.
std::vector<cl_uint> flat(const std::vector<Sheet>& sheets, Math math) {
    std::vector<test::SurfacePlace> points, corners;
    std::vector<AtlasBlock> blocks;
    for (const Sheet& sheet : sheets) {
        AtlasBlock block = sheet.block;
        for (cl_uint& row : block.row) row += static_cast<cl_uint>(points.size());
        for (cl_uint& corner : block.corner) corner += static_cast<cl_uint>(corners.size());
        block.flat = 7;
        block.pad_ = 5;
        points.insert(points.end(), sheet.points.begin(), sheet.points.end());
        corners.insert(corners.end(), sheet.corners.begin(), sheet.corners.end());
        blocks.push_back(block);
    }
    const std::uint32_t stride = test::padded(points.size()), listed = test::padded(corners.size());
    const auto count = static_cast<cl_uint>(blocks.size());
    blocks.push_back(blocks.front());  // one that is not asked for
    BlockBuffers buffers;
    buffers.planes = test::upload_points(corners, listed, GBUFFER_GEOMETRIC + 3);
    buffers.blocks = test::upload(blocks);
    test::atlas_passes(math).flat(test::device().queue, {0, 0, stride, 0, 0, listed, 0, count},
                                  test::upload_points(points, stride, GBUFFER_GEOMETRIC + 3),
                                  buffers);
    const auto found = test::download<AtlasBlock>(buffers.blocks, blocks.size());
    EXPECT_EQ(found.back().flat, 7u);
    std::vector<cl_uint> out;
    for (std::size_t k = 0; k < count; ++k) {
        EXPECT_EQ(std::memcmp(&found[k], &blocks[k], offsetof(AtlasBlock, flat)), 0);
        EXPECT_EQ(found[k].pad_, 5u);
        out.push_back(found[k].flat);
    }
    return out;
}

CLGI_IN_BOTH_MATHS(AtlasFlat);

TEST_P(AtlasFlat, IsABlockInOnePlane) {
    std::vector<Sheet> sheets;
    for (std::uint32_t k = 0; k < 50; ++k) sheets.emplace_back(k);
    for (const cl_uint found : flat(sheets, GetParam())) EXPECT_EQ(found, 1u);
}

// A texel or a corner that is moved, or turned, by a little less or more than is allowed. The first
// texel is what the others are compared with.
TEST_P(AtlasFlat, IsNoBlockWithATexelOutOfLine) {
    for (const float part : {0.97f, 1.03f})
        for (const bool turned : {false, true}) {
            std::vector<Sheet> sheets;
            for (std::uint32_t k = 1; k < sheet_points; ++k)
                for (const float way : {-1.0f, 1.0f}) {
                    Sheet sheet(k);
                    const float angle = std::acos(0.98f) * part * way;
                    if (turned)
                        sheet.of(k).geometric = std::cos(angle) * sheet.normal +
                                                std::sin(angle) * glm::normalize(sheet.along);
                    else
                        sheet.of(k).position +=
                            sheet.diagonal() / 32.0f * part * way * sheet.normal;
                    sheets.push_back(sheet);
                }
            for (const cl_uint found : flat(sheets, GetParam()))
                EXPECT_EQ(found, part < 1.0f ? 1u : 0u) << turned;
        }
}

TEST(AtlasFlatBlock, HasNumbersOnly) {
    for (const std::uint32_t k : {0u, 1u, 15u, 16u, 19u}) {
        Sheet sheet(3);
        sheet.of(k).geometric *= std::numeric_limits<float>::quiet_NaN();
        EXPECT_EQ(flat({sheet}, Math::strict)[0], 0u) << k;
    }
}

TEST(AtlasFlatBlock, WhereThereAreNoneWritesNothing) {
    BlockBuffers buffers;
    buffers.planes = test::upload(std::vector<float>(9 * 32));
    buffers.blocks = test::upload(std::vector<AtlasBlock>(1));
    test::atlas_passes().flat(test::device().queue, {0, 0, 32, 0, 0, 32, 0, 0}, buffers.planes,
                              buffers);
    EXPECT_EQ(test::download<AtlasBlock>(buffers.blocks, 1)[0].flat, 0u);
}

}  // namespace
}  // namespace clgi
