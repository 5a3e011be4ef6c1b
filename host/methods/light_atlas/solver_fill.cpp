// What the VPLs received, sent on to the texels. [Schaerfig16, section 4]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

using namespace light_atlas;

namespace {

constexpr std::uint32_t gathered_at_once = 256;  // VPLs, where what texels see is kept
constexpr float same_reach = 1e-5f;              // rounding of sums of form factors

std::uint32_t bits_of(float value) {
    std::uint32_t out;
    std::memcpy(&out, &value, sizeof out);
    return out;
}

}  // namespace

FillParams LightAtlasSolver::State::fill_params(std::uint32_t first, std::uint32_t count) const {
    const std::uint32_t flags =
        (b.seen_kept ? FILL_KEPT : 0) | (differences ? 0 : FILL_FORM_FACTORS);
    return {first,
            count,
            b.sites.stride,
            b.sites.sample_stride,
            b.receiver_count,
            b.texel_stride,
            0,
            flags,
            lift,
            0,
            0,
            0};
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
    if (!occludes(options.occlusion)) {
        record("atlas.gather_open", std::size_t{count} * b.receiver_count,
               [&](const WaitList& wait) {
                   return atlas.gather_open(queue, fill_params(first, count), b.sites,
                                            b.texels.planes, b.gathered, b.filled, wait);
               });
        return;
    }
    record("atlas.gather", std::size_t{count} * b.receiver_count, [&](const WaitList& wait) {
        return atlas.gather(queue, fill_params(first, count), b.sites, b.texels.planes, b.seen,
                            b.gathered, b.filled, wait);
    });
}

// The share of each texel's hemisphere that meets surfaces: that of the VPL nearest to it, or,
// where it is the same for all, as in a closed room without occlusion, that of any.
void LightAtlasSolver::State::find_reach() {
    if (!occludes(options.occlusion)) {
        const std::size_t n = b.sites.site_count;
        std::vector<float> reach(n);
        record.wait();
        queue.enqueueReadBuffer(b.sites.balance, CL_TRUE,
                                BALANCE_REACH * b.sites.stride * sizeof(float), n * sizeof(float),
                                reach.data());
        const auto [least, most] = std::minmax_element(reach.begin(), reach.end());
        if (*most - *least < same_reach) {
            record.fill(b.reach, bits_of(*most));
            return;
        }
    }
    FillParams texels = fill_params(0, b.sites.site_count);
    texels.texel_count = b.texel_count;
    record("atlas.nearest", b.texel_count, [&](const WaitList& wait) {
        return atlas.nearest(queue, texels, b.sites, b.texels.planes, b.reach, wait);
    });
}

// What points in space face is measured nowhere near them: nothing is raised there.
void LightAtlasSolver::State::leave_points() {
    const std::vector<float> none(bake_points.size());
    record.write(b.reach, none.data(), none.size() * sizeof(float), b.first_point * sizeof(float));
}

void LightAtlasSolver::State::fill() {
    const std::uint32_t n = b.sites.site_count;
    if (!near_known) {
        find_reach();
        if (!bake_points.empty()) leave_points();
    }
    near_known = !record.cancelled();
    const bool drawn = occludes(options.occlusion) && !b.seen_kept;
    const std::uint32_t most = b.seen_kept ? gathered_at_once : b.batch;
    while (filled_vpls < n && !record.cancelled()) {
        const std::uint32_t first = filled_vpls, count = std::min(most, n - first);
        if (drawn) hemicubes(first, count, filling_pixels(options));
        if (options.filling == Filling::project) {
            project(first, count);
        } else {
            if (drawn) see(first, count);
            gather(first, count);
        }
        filled_vpls += count;
        if (b.seen_kept)
            record.report(0.84 + 0.15 * filled_vpls / n);
        else if (first % 64 == 0)
            record.report(0.45 + 0.54 * filled_vpls / n);
    }
    record("atlas.complete", b.receiver_count, [&](const WaitList& wait) {
        return atlas.complete(queue, fill_params(0, n), b.reach, b.filled, b.gathered, b.irradiance,
                              b.non_finite, wait);
    });
    if (options.direct) light_points(b.texels, b.texel_count, b.irradiance, true);
}

}  // namespace clgi
