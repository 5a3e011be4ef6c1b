// Which texels VPLs see: every texel in full, or corners of blocks first.
// [Schaerfig16, section 6.2]
// SPDX-License-Identifier: MIT
#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

using namespace light_atlas;

void LightAtlasSolver::State::upload_blocks(const AtlasBlocks& made,
                                            const std::vector<SurfaceSample>& texels) {
    std::vector<SurfaceSample> listed;
    for (const std::uint32_t texel : made.list) listed.push_back(texels[texel]);
    record.write(b.listed_texels, listed.data(), listed.size() * sizeof(SurfaceSample));
    record.write(b.blocks.places, made.list.data(), made.unblocked * sizeof(std::uint32_t));
    record.write(b.blocks.blocks, made.blocks.data(), made.blocks.size() * sizeof(AtlasBlock));
    // Rows end in lanes of no texel, which these passes leave alone and others read.
    record.fill(b.seen, 0);
}

BlockParams LightAtlasSolver::State::block_params(std::uint32_t first, std::uint32_t count) const {
    return {count,          static_cast<std::uint32_t>(options.hemicube_size),
            b.texel_stride, b.seen_kept ? first / SEEN_VPLS : 0,
            b.listed_count, b.listed_stride,
            b.unblocked,    b.block_count};
}

// Where the listed texels are, and which blocks are flat.
void LightAtlasSolver::State::place_blocks() {
    record("gbuffer.surface", b.listed_count, [&](const WaitList& wait) {
        return gbuffer.surface(queue, scene, {b.listed_count, b.listed_stride, 0, 0},
                               b.listed_texels, b.listed, {}, wait);
    });
    record("atlas.flat", b.block_count, [&](const WaitList& wait) {
        return atlas.flat(queue, block_params(0, 0), b.texels.planes, b.blocks, wait);
    });
}

// Which texels a batch sees, in the hemicubes that were drawn last.
void LightAtlasSolver::State::see(std::uint32_t first, std::uint32_t count) {
    if (b.block_count == 0) return see_all(first, count, 0);
    see_in_blocks(first, count);
    if (!bake_points.empty()) see_all(first, count, b.first_point);
}

// The same for texels from one on and all points, each in full.
void LightAtlasSolver::State::see_all(std::uint32_t first, std::uint32_t count,
                                      std::uint32_t first_texel) {
    const SeeParams params{count,
                           static_cast<std::uint32_t>(options.hemicube_size),
                           b.receiver_count,
                           b.texel_stride,
                           first_texel,
                           b.seen_kept ? first / SEEN_VPLS : 0,
                           0,
                           0};
    record("atlas.see", std::size_t{count} * (b.receiver_count - first_texel),
           [&](const WaitList& wait) {
               return atlas.see(queue, params, b.views, b.pixels, b.texels.planes, b.seen, wait);
           });
}

void LightAtlasSolver::State::see_in_blocks(std::uint32_t first, std::uint32_t count) {
    const BlockParams params = block_params(first, count);
    record("atlas.see_listed", std::size_t{count} * b.listed_count, [&](const WaitList& wait) {
        return atlas.see_listed(queue, params, b.views, b.pixels, b.blocks, b.seen, wait);
    });
    record("atlas.see_blocks", std::size_t{count} * b.block_count * BLOCK_TEXELS,
           [&](const WaitList& wait) {
               return atlas.see_blocks(queue, params, b.views, b.pixels, b.texels.planes, b.blocks,
                                       b.seen, wait);
           });
}

}  // namespace clgi
