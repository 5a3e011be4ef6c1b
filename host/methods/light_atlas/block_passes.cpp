// The passes that look up some texels first, and the others where that is needed.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/atlas.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

// What see_listed and see_blocks have in common.
void need_batch(const PassKernel& pass, const BlockParams& params, const cl::Buffer& views,
                const cl::Buffer& depth, const BlockBuffers& b, const cl::Buffer& seen) {
    const std::size_t shooters = params.shooter_count;
    need_stride(pass, "listed_stride", params.listed_stride, params.listed_count);
    for (const std::uint32_t stride : {params.listed_stride, params.stride})
        need_countable(pass.name, "texels", GBUFFER_GEOMETRIC + 3, stride);
    need(pass, "views", views, 5 * shooters * sizeof(View));
    need(pass, "depth", depth, 3 * word * shooters * params.size * params.size);
    need(pass, "listed_seen", b.seen, seen_rows(shooters) * params.listed_stride);
    need(pass, "seen", seen, (params.first_row + seen_rows(shooters)) * params.stride);
}

std::size_t geometric_bytes(std::uint32_t stride) {
    return (GBUFFER_GEOMETRIC + 3) * word * stride;
}

}  // namespace

cl::Event AtlasPasses::flat(const cl::CommandQueue& queue, const BlockParams& params,
                            const cl::Buffer& texels, const BlockBuffers& b,
                            const WaitList& wait) const {
    for (const std::uint32_t stride : {params.listed_stride, params.stride})
        need_countable(flat_.name, "texels", GBUFFER_GEOMETRIC + 3, stride);
    need(flat_, "texels", texels, geometric_bytes(params.stride));
    need(flat_, "listed", b.planes, geometric_bytes(params.listed_stride));
    need(flat_, "blocks", b.blocks, params.block_count * sizeof(AtlasBlock));
    return launch(flat_, queue, params.block_count, wait, params, texels, b.planes, b.blocks);
}

cl::Event AtlasPasses::see_listed(const cl::CommandQueue& queue, const BlockParams& params,
                                  const cl::Buffer& views, const cl::Buffer& depth,
                                  const BlockBuffers& b, const cl::Buffer& seen,
                                  const WaitList& wait) const {
    need_batch(see_listed_, params, views, depth, b, seen);
    if (params.unblocked > params.listed_count)
        throw Error(see_listed_.name + ": unblocked is " + std::to_string(params.unblocked) +
                    ", at most " + std::to_string(params.listed_count) + " needed");
    need(see_listed_, "listed", b.planes, geometric_bytes(params.listed_stride));
    need(see_listed_, "places", b.places, params.unblocked * word);
    return launch(see_listed_, queue, packets(see_listed_, params.listed_count), wait, params,
                  views, depth, b.planes, b.places, b.seen, seen);
}

cl::Event AtlasPasses::see_blocks(const cl::CommandQueue& queue, const BlockParams& params,
                                  const cl::Buffer& views, const cl::Buffer& depth,
                                  const cl::Buffer& texels, const BlockBuffers& b,
                                  const cl::Buffer& seen, const WaitList& wait) const {
    need_batch(see_blocks_, params, views, depth, b, seen);
    need(see_blocks_, "texels", texels, geometric_bytes(params.stride));
    need(see_blocks_, "blocks", b.blocks, params.block_count * sizeof(AtlasBlock));
    const std::size_t parts = packets(see_blocks_, BLOCK_TEXELS);
    return launch(see_blocks_, queue, parts * params.block_count, wait, params, views, depth,
                  texels, b.blocks, b.seen, seen);
}

}  // namespace clgi
