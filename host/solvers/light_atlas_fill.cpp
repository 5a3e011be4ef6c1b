// What the VPLs received, sent on to the texels. [Schaerfig16, section 4]
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "solvers/light_atlas_state.hpp"

namespace clgi {

using namespace light_atlas;

namespace {

constexpr std::uint32_t gathered_at_once = 256;  // VPLs, where what texels see is kept

}  // namespace

FillParams LightAtlasSolver::State::fill_params(std::uint32_t first, std::uint32_t count) const {
    const std::uint32_t flags =
        (b.seen_kept ? FILL_KEPT : 0) | (differences ? 0 : FILL_FORM_FACTORS);
    return {first, count, b.sites.stride, b.sites.sample_stride, b.texel_count, b.texel_stride, 0,
            flags};
}

// least: change of a VPL's power that is sent, exposed lumen; below 0: all send.
void LightAtlasSolver::State::send(float least) {
    const std::uint32_t n = b.sites.site_count;
    record("vpl.send", n, [&](const WaitList& wait) {
        return vpl.send(queue, b.sites, b.sample_irradiance, least, wait);
    });
    record("parallel.list", n, [&](const WaitList& wait) {
        return parallel.list(queue, n, b.sites.sends, b.sites.list, b.sites.listed, b.list_scratch,
                             wait);
    });
}

void LightAtlasSolver::State::gather(std::uint32_t first, std::uint32_t count) {
    record("atlas.gather", std::size_t{count} * b.texel_count, [&](const WaitList& wait) {
        return atlas.gather(queue, fill_params(first, count), b.sites, b.texels.planes, b.seen,
                            b.gathered, b.filled, wait);
    });
}

void LightAtlasSolver::State::fill() {
    const std::uint32_t n = b.sites.site_count;
    const FillParams all = fill_params(0, n);
    if (!near_known)
        record("atlas.nearest", b.texel_count, [&](const WaitList& wait) {
            return atlas.nearest(queue, all, b.sites, b.texels.planes, b.reach, wait);
        });
    near_known = !record.cancelled();
    const std::uint32_t most = b.seen_kept ? gathered_at_once : b.batch;
    while (filled_vpls < n && !record.cancelled()) {
        const std::uint32_t first = filled_vpls, count = std::min(most, n - first);
        if (!b.seen_kept) hemicubes(first, count, filling_pixels(options));
        if (options.filling == Filling::project) {
            project(first, count);
        } else {
            if (!b.seen_kept) see(first, count);
            gather(first, count);
        }
        filled_vpls += count;
        if (b.seen_kept)
            record.report(0.84 + 0.15 * filled_vpls / n);
        else if (first % 64 == 0)
            record.report(0.45 + 0.54 * filled_vpls / n);
    }
    record("atlas.complete", b.texel_count, [&](const WaitList& wait) {
        return atlas.complete(queue, all, b.reach, b.filled, b.gathered, b.irradiance, b.non_finite,
                              wait);
    });
    if (options.direct) light_points(b.texels, b.texel_count, b.irradiance, true);
}

}  // namespace clgi
