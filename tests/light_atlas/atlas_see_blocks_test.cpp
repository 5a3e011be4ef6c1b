// Corners of blocks are looked up first: what their texels get, against the same decision made from
// what every texel sees; and what is too small to be found so.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>
#include <clgi/advanced/atlas_blocks.hpp>
#include <clgi/advanced/patches.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "atlas_checks.hpp"
#include "math_modes.hpp"
#include "vpl_tools.hpp"

namespace clgi {
namespace {

constexpr cl_uchar untouched = 0xa5;

// Texels of a layout as they lie in a scene on the device.
std::vector<test::SurfacePlace> places_of(const Scene& scene, const AtlasLayout& atlas,
                                          const DeviceScene& on_device) {
    std::vector<test::SurfacePlace> out;
    for (const AtlasTexel& texel : atlas.texels) {
        const auto corner = [&](int k) { return geometry::corner(scene, texel.triangle, k); };
        const glm::dvec3 normal =
            glm::normalize(glm::cross(corner(1) - corner(0), corner(2) - corner(0)));
        out.push_back({on_device.frame().to_local(test::place_of(scene, texel)), -normal, normal});
    }
    return out;
}

// A lit scene, its texels, and VPLs that see some of them.
struct World {
    Scene scene;
    DeviceScene on_device;
    AtlasLayout atlas;
    std::vector<test::SurfacePlace> texels;
    std::vector<test::SitePlace> sites;
    std::uint32_t size = 64;  // pixels of hemicubes

    std::uint32_t stride() const { return test::padded(texels.size()); }
    cl::Buffer planes() const {
        return test::upload_points(texels, stride(), GBUFFER_GEOMETRIC + 3);
    }
    void add_site(const glm::dvec3& position, const glm::dvec3& normal) {
        const glm::vec3 p = on_device.frame().to_local(position), n(glm::normalize(normal));
        sites.push_back({p, n, 1e-3f, glm::vec3(1.0f), {{p, n, n}}});
    }
};

struct Batch {
    std::uint32_t first, count, first_row;
    std::size_t rows() const { return first_row + seen_rows(count) + 1; }
};

// A tilted room with a tilted block in it, in charts of their own, and bars before the floor and a
// wall that are narrower than a texel; VPLs anywhere on them.
World furnished() {
    Scene scene = test::plain_scene();
    test::add_box(scene, {-1, -1, -1}, {1, 1, 1}, -1);
    test::add_box(scene, {-0.35, -0.5, -0.3}, {0.45, 0.3, 0.4}, 1);
    for (const double z : {-0.83, -0.52, -0.21, 0.14, 0.47, 0.79}) {
        test::add_box(scene, {-0.9, -0.97, z}, {0.9, -0.95, z + 0.07}, 1);
        test::add_box(scene, {-0.97, -0.9, z}, {-0.95, 0.9, z + 0.07}, 1);
    }
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 0.7, glm::dvec3(1, 2, -0.5));
    for (glm::dvec3& p : scene.positions) p = glm::dvec3(turn * glm::dvec4(p, 1.0));
    for (glm::vec3& n : scene.normals) n = glm::vec3(turn * glm::dvec4(n, 0.0));
    World out{scene,
              test::on_device(scene),
              make_atlas(scene, make_patches(scene).triangle_patch, test::made_charts(96)),
              {},
              {}};
    out.texels = places_of(scene, out.atlas, out.on_device);
    test::Random random(77);
    for (int k = 0; k < 13; ++k) {
        const std::size_t t =
            static_cast<std::size_t>(random(0, 0.999) * double(out.texels.size()));
        out.sites.push_back({out.texels[t].position,
                             out.texels[t].geometric,
                             1e-3f,
                             glm::vec3(1.0f),
                             {out.texels[t]}});
    }
    return out;
}

struct Seen {
    std::vector<cl_uchar> texels, listed;
};

std::vector<cl_uchar> see_all(const World& in, const Batch& batch, const AtlasPasses& passes) {
    const test::Sites sites(in.sites);
    const std::size_t bytes = batch.rows() * in.stride();
    const cl::Buffer seen = test::upload(std::vector<cl_uchar>(bytes, untouched));
    test::see(test::hemicubes(sites, &in.on_device, {batch.first, batch.count, in.size, 2e-5f}),
              static_cast<std::uint32_t>(in.texels.size()), in.planes(), seen, batch.first_row,
              passes);
    return test::download<cl_uchar>(seen, bytes);
}

Seen see_blocks(const World& in, const Batch& batch, const AtlasBlocks& blocks,
                const AtlasPasses& passes) {
    const test::Sites sites(in.sites);
    const test::Hemicubes cubes =
        test::hemicubes(sites, &in.on_device, {batch.first, batch.count, in.size, 2e-5f});
    std::vector<test::SurfacePlace> listed;
    for (const std::uint32_t texel : blocks.list) listed.push_back(in.texels[texel]);
    const std::uint32_t listed_stride = test::padded(listed.size());
    const std::size_t bytes = batch.rows() * in.stride();
    const std::size_t listed_bytes = (seen_rows(batch.count) + 1) * listed_stride;
    BlockBuffers buffers;
    buffers.planes = test::upload_points(listed, listed_stride, GBUFFER_GEOMETRIC + 3);
    std::vector<cl_uint> alone(blocks.list.begin(), blocks.list.begin() + blocks.unblocked);
    // What lies behind the places, were it read, would write beside the texels.
    alone.resize(alone.size() + 16, static_cast<cl_uint>(in.texels.size()));
    buffers.places = test::upload(alone);
    buffers.seen = test::upload(std::vector<cl_uchar>(listed_bytes, untouched));
    buffers.blocks = test::upload(blocks.blocks);
    const cl::Buffer seen = test::upload(std::vector<cl_uchar>(bytes, untouched));
    const BlockParams params{batch.count,
                             in.size,
                             in.stride(),
                             batch.first_row,
                             static_cast<cl_uint>(listed.size()),
                             listed_stride,
                             blocks.unblocked,
                             static_cast<cl_uint>(blocks.blocks.size())};
    passes.see_listed(test::device().queue, params, cubes.views, cubes.depth, buffers, seen);
    passes.see_blocks(test::device().queue, params, cubes.views, cubes.depth, in.planes(), buffers,
                      seen);
    return {test::download<cl_uchar>(seen, bytes),
            test::download<cl_uchar>(buffers.seen, listed_bytes)};
}

struct Decided {
    std::vector<cl_uchar> texels;
    int taken = 0, looked_up = 0;  // pairs of a block and a VPL
    int other = 0;                 // bits that are not what the texel sees
    int uneven = 0;                // that would be, but for a block that is not flat
};

// From what all texels see. `full` holds that of all rows.
Decided decide(const World& in, const Batch& batch, const AtlasBlocks& blocks,
               const std::vector<cl_uchar>& full) {
    Decided out;
    out.texels.assign(full.size(), untouched);
    for (std::size_t row = batch.first_row; row < batch.first_row + seen_rows(batch.count); ++row) {
        const std::size_t line = row * in.stride();
        for (std::uint32_t k = 0; k < blocks.unblocked; ++k)
            out.texels[line + blocks.list[k]] = full[line + blocks.list[k]];
        for (const AtlasBlock& block : blocks.blocks)
            for (std::uint32_t k = 0; k < BLOCK_TEXELS; ++k) {
                const std::uint32_t texel = block.row[k / 4] + k % 4;
                unsigned byte = 0;
                for (unsigned bit = 0; bit < SEEN_VPLS; ++bit) {
                    std::uint32_t see = 0;
                    for (std::uint32_t c = 0; c < block.corners; ++c)
                        see += full[line + blocks.list[block.corner[c]]] >> bit & 1u;
                    const unsigned own = full[line + texel] >> bit & 1u;
                    const bool alike = see == 0 || see == block.corners;
                    const bool agree = block.flat && alike;
                    const unsigned found = agree ? see > 0 : own;
                    byte |= found << bit;
                    out.other += found != own;
                    out.uneven += alike && !agree && own != (see > 0);
                    if (k == 0) ++(agree ? out.taken : out.looked_up);
                }
                out.texels[line + texel] = static_cast<cl_uchar>(byte);
            }
    }
    return out;
}

void expect_decision(const World& in, const Batch& batch, const AtlasBlocks& blocks,
                     const AtlasPasses& passes, Math math = Math::strict) {
    const auto full = see_all(in, batch, test::atlas_passes(math));
    const Decided wanted = decide(in, batch, blocks, full);
    const Seen found = see_blocks(in, batch, blocks, passes);
    EXPECT_GT(wanted.taken, 50);
    EXPECT_GT(wanted.looked_up, 50);
    if (batch.count > 8) {
        EXPECT_GT(wanted.other, 0);
        EXPECT_GT(wanted.uneven, 0);
    }
    // Padding too: only texels are written.
    for (std::size_t k = 0; k < found.texels.size(); ++k)
        ASSERT_EQ(found.texels[k], wanted.texels[k])
            << "row " << k / in.stride() << ", texel " << k % in.stride();
    const std::uint32_t stride = test::padded(blocks.list.size());
    for (std::size_t k = 0; k < found.listed.size(); ++k) {
        if (k / stride == seen_rows(batch.count)) {
            ASSERT_EQ(found.listed[k], untouched);
        } else if (k % stride < blocks.list.size()) {
            ASSERT_EQ(found.listed[k],
                      full[(batch.first_row + k / stride) * in.stride() + blocks.list[k % stride]]);
        }
    }
}

// Every other block is flat. The last packet of texels in no block has some of the next kind too.
AtlasBlocks some_flat(const World& in, int step) {
    AtlasBlocks out = make_blocks(in.atlas, step);
    EXPECT_GT(out.blocks.size(), 50u);
    EXPECT_GT(out.unblocked, 50u);
    for (std::size_t k = 0; k < out.blocks.size(); ++k) out.blocks[k].flat = k % 2;
    for (std::uint32_t at = out.unblocked; at-- > 0 && out.unblocked % 4 != 3;) {
        const auto each_corner = [&](const auto& work) {
            for (AtlasBlock& block : out.blocks)
                for (std::uint32_t c = 0; c < block.corners; ++c) work(block.corner[c]);
        };
        bool needed = false;
        each_corner([&](std::uint32_t corner) { needed |= corner == at; });
        if (needed) continue;
        out.list.erase(out.list.begin() + at);
        --out.unblocked;
        each_corner([&](std::uint32_t& corner) { corner -= corner > at; });
    }
    EXPECT_EQ(out.unblocked % 4, 3u);
    return out;
}

CLGI_IN_BOTH_MATHS(SeeBlocks);

TEST_P(SeeBlocks, TakeWhatTheirCornersAgreeAbout) {
    const World in = furnished();
    for (const int step : {2, 4}) {
        const AtlasBlocks blocks = some_flat(in, step);
        for (const Batch batch : {Batch{0, 13, 0}, {0, 8, 2}, {4, 9, 1}, {3, 2, 1}})
            expect_decision(in, batch, blocks, test::atlas_passes(GetParam()), GetParam());
    }
}

TEST(SeeBlocks, AreTheSameForEveryWidthAndGroup) {
    const World in = furnished();
    for (const int step : {2, 4}) {
        const AtlasBlocks blocks = some_flat(in, step);
        for (const int width : test::widths()) {
            BuildOptions build;
            build.packet_width = width;
            build.local_size = width == 4 ? 1 : 0;
            expect_decision(in, {2, 11, 1}, blocks, AtlasPasses(test::programs(), build));
        }
    }
}

TEST(SeeBlocks, OfNoVplOrNoBlockWriteNothing) {
    const World in = furnished();
    const BlockParams none{0, in.size, in.stride(), 0, 1, 32, 1, 1};
    BlockBuffers buffers;
    buffers.planes = test::upload(std::vector<float>(9 * 32));
    buffers.places = test::upload(std::vector<cl_uint>{0});
    buffers.seen = test::upload(std::vector<cl_uchar>(32, untouched));
    buffers.blocks = test::upload(std::vector<AtlasBlock>(1));
    const std::vector<cl_uchar> before(in.stride(), untouched);
    const cl::Buffer seen = test::upload(before), views = test::empty<View>(5);
    const AtlasPasses& passes = test::atlas_passes();
    passes.see_listed(test::device().queue, none, views, seen, buffers, seen);
    passes.see_blocks(test::device().queue, none, views, seen, in.planes(), buffers, seen);
    EXPECT_EQ(test::download<cl_uchar>(seen, before.size()), before);
    EXPECT_EQ(test::download<cl_uchar>(buffers.seen, 32), std::vector<cl_uchar>(32, untouched));
}

// ---- what is found ---------------------------------------------------------------------------

constexpr int floor_texels = 32;

// A floor of 32 x 32 texels, a VPL 1 m above it, and close above the floor a plate that hides
// `width` x `width` texels from (first, first) on.
World with_plate(int first, int width) {
    const double texel = 2.0 / floor_texels, inset = 0.25 * texel;
    Scene scene = test::plain_scene();
    test::add_floor(scene, 1.0);
    for (const glm::vec2 uv : {glm::vec2(0, 1), {1, 1}, {1, 0}, {0, 0}})
        scene.uvs.emplace_back(0, 0, uv.x, uv.y);
    AtlasOptions options;
    options.size = floor_texels;
    options.uvs = AtlasUvs::set_1;
    const AtlasLayout atlas = make_atlas(scene, {}, options);
    Scene all = test::plain_scene();
    test::add_floor(all, 1.0);
    // The plate's place follows from that of its texels.
    const auto corner = [&](int at) {
        return test::place_of(scene,
                              atlas.texels[static_cast<std::size_t>(at) * (floor_texels + 1)]);
    };
    const glm::dvec3 a = corner(first), b = corner(first + width - 1);
    const glm::dvec3 margin(0.5 * texel - inset, 0.0, 0.5 * texel - inset);
    const glm::dvec3 low = glm::min(a, b) - margin, high = glm::max(a, b) + margin;
    test::add_box(all, {low.x, 0.004, low.z}, {high.x, 0.006, high.z}, 1);
    World out{all, test::on_device(all), atlas, {}, {}, 512};
    out.texels = places_of(scene, atlas, out.on_device);
    out.add_site({0.013, 1.0, 0.017}, {0, -1, 0});
    return out;
}

// Texels that get another bit by blocks than by themselves, and how many the plate hides.
std::pair<int, int> missed(const World& in, int step) {
    AtlasBlocks blocks = make_blocks(in.atlas, step);
    for (AtlasBlock& block : blocks.blocks) block.flat = 1;
    const Batch batch{0, 1, 0};
    const auto full = see_all(in, batch, test::atlas_passes());
    const auto found = see_blocks(in, batch, blocks, test::atlas_passes()).texels;
    std::pair<int, int> out{0, 0};
    for (std::size_t t = 0; t < in.texels.size(); ++t) {
        out.first += found[t] != full[t];
        out.second += full[t] == 0;
    }
    return out;
}

// What is as wide as the step hides a corner, wherever it is.
TEST(SeeBlocks, FindWhatIsAsWideAsTheirStep) {
    for (const int step : {2, 4})
        for (int first = 12; first < 16; ++first)
            for (const int width : {step, step + 1}) {
                const auto [other, hidden] = missed(with_plate(first, width), step);
                EXPECT_EQ(hidden, width * width) << first;
                EXPECT_EQ(other, 0) << first << ", width " << width << ", step " << step;
            }
}

// The limit: between the corners a plate casts no shadow at all.
TEST(SeeBlocks, MissWhatLiesBetweenTheirCorners) {
    for (const int width : {1, 2, 3}) {
        const World in = with_plate(13, width);
        EXPECT_EQ(missed(in, 4), std::pair(width * width, width * width));
        EXPECT_EQ(missed(in, 2), std::pair(width == 1 ? 1 : 0, width * width));
    }
}

}  // namespace
}  // namespace clgi
