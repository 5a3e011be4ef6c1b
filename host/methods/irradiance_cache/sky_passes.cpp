// What directions of the sky correct: the passes of sky_lights.cpp.
// SPDX-License-Identifier: MIT
#include <clgi/advanced/planes.hpp>
#include <clgi/passes/cache.hpp>

#include "core/opencl/launch.hpp"
#include "core/opencl/planes.hpp"
#include "core/opencl/program.hpp"
#include "core/opencl/word.hpp"

namespace clgi {
namespace {

void need_sum(const PassKernel& pass, float scale, float total) {
    if (!(scale > 0.0f) || !(total > 0.0f))
        throw Error(pass.name + ": scale is " + std::to_string(scale) + " and total " +
                    std::to_string(total) + ", above 0 needed");
}

// Returns how many blocks there are.
std::size_t need_pixels(const PassKernel& pass, const CacheCorrectParams& params,
                        const cl::Buffer& sums, const cl::Buffer& shares) {
    need_sum(pass, params.scale, params.total);
    need_stride(pass, "stride", params.stride, std::size_t{params.width} * params.height);
    const std::size_t count = std::size_t{cache_blocks(params.width)} * cache_blocks(params.height);
    need(pass, "sums", sums, 5 * word * params.stride);
    need(pass, "shares", shares, word * count);
    return count;
}

}  // namespace

cl::Event CachePasses::gauge(const cl::CommandQueue& queue, const CacheCorrectParams& params,
                             const GBuffer& points, const cl::Buffer& found, const cl::Buffer& sums,
                             const cl::Buffer& shares, const WaitList& wait) const {
    const std::size_t blocks = need_pixels(gauge_, params, sums, shares);
    need(gauge_, "points", points.planes, point_bytes(gauge_.storage, params.stride));
    need(gauge_, "found", found, 3 * word * params.stride);
    return launch(gauge_, queue, blocks, wait, params, points.planes, found, sums, shares);
}

cl::Event CachePasses::settle(const cl::CommandQueue& queue, const CacheSettleParams& params,
                              const CacheBuffers& b, const cl::Buffer& sums,
                              const cl::Buffer& settled, const WaitList& wait) const {
    need_sum(settle_, params.scale, params.total);
    need_stride(settle_, "stride", params.stride, params.count);
    for (const auto& [name, planes] : {std::pair("next", b.next),
                                       {"base", b.base},
                                       {"bright", b.bright},
                                       {"shown", b.shown},
                                       {"settled", settled}})
        need(settle_, name, planes, 3 * word * params.stride);
    need(settle_, "sums", sums, 4 * word * params.stride);
    return launch(settle_, queue, packets(settle_, params.count), wait, params, b.next, b.base,
                  b.bright, b.shown, sums, settled);
}

cl::Event CachePasses::correct(const cl::CommandQueue& queue, const CacheCorrectParams& params,
                               const cl::Buffer& sums, const cl::Buffer& shares,
                               const cl::Buffer& irradiance, const WaitList& wait) const {
    need_pixels(correct_, params, sums, shares);
    need(correct_, "irradiance", irradiance, irradiance_bytes(correct_.storage, params.stride));
    return launch(correct_, queue, std::size_t{params.width} * params.height, wait, params, sums,
                  shares, irradiance);
}

}  // namespace clgi
