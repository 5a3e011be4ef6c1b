// What stays true whatever the light: how much of each VPL's light arrives at the others, and which
// texels see it. Both are looked up in one drawing of the scene around each VPL.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

using namespace light_atlas;

namespace {

constexpr int balance_steps = 6;  // half-steps of both kinds; the factors differ by 1e-3 then
constexpr std::uint32_t vpls_a_report = 128, unseen_batches_a_report = 16;

}  // namespace

// The scene as a batch of VPLs sees it.
void LightAtlasSolver::State::hemicubes(std::uint32_t first, std::uint32_t count, Pixels kind) {
    const auto side = static_cast<std::uint32_t>(options.hemicube_size);
    const CubeParams params{count, 5,           side,  0, 0, b.sites.stride,
                            lift,  0.5f * lift, first, 0, 0, 0};
    record("gbuffer.cubes", count, [&](const WaitList& wait) {
        return gbuffer.cubes(queue, params, b.sites.planes, b.sites.chosen, b.views, wait);
    });
    const ViewSpan span{0, 5 * count, side, side, std::size_t{3} * count * side * side};
    record("gbuffer.raster_views", span.count, [&](const WaitList& wait) {
        return gbuffer.raster_views(queue, span, b.views, scene, b.pixels, kind, wait);
    });
}

// Rows of the transport of a batch, and its reach.
void LightAtlasSolver::State::transport(std::uint32_t first, std::uint32_t count) {
    const TransportParams params{first,
                                 count,
                                 b.kept ? 1u : 0u,
                                 b.sites.site_count,
                                 b.sites.stride,
                                 b.sites.sample_stride,
                                 static_cast<std::uint32_t>(options.hemicube_size),
                                 row_scale,
                                 0,
                                 0,
                                 0,
                                 lift};
    const std::size_t pairs = std::size_t{count} * b.sites.site_count * b.sites.per_site;
    if (!occludes(options.occlusion)) {
        record("vpl.transport_open", pairs, [&](const WaitList& wait) {
            return vpl.transport_open(queue, params, b.sites, b.rows, wait);
        });
        record("vpl.reach_open", count, [&](const WaitList& wait) {
            return vpl.reach_open(queue, params, scene, b.sites, wait);
        });
        return;
    }
    hemicubes(first, count, Pixels::depth);
    record("vpl.transport", pairs, [&](const WaitList& wait) {
        return vpl.transport(queue, params, b.sites, b.views, b.pixels, b.rows, wait);
    });
    record("vpl.reach", count, [&](const WaitList& wait) {
        return vpl.reach(queue, params, b.sites, b.views, b.pixels, wait);
    });
}

// Transport of all VPLs, or, where it is not kept, what they reach and their factors alone. Goes on
// where it was cancelled.
void LightAtlasSolver::State::measure() {
    const std::uint32_t n = b.sites.site_count;
    const std::uint32_t every =
        occludes(options.occlusion) ? vpls_a_report : unseen_batches_a_report * b.batch;
    while (measured_vpls < n && !record.cancelled()) {
        const std::uint32_t first = measured_vpls, count = std::min(b.batch, n - first);
        transport(first, count);
        if (b.seen_kept) see(first, count);
        if (!b.kept) balance_shooters(first, count);
        measured_vpls += count;
        // Who stops after the last batch stops after the factors: they are part of the state then.
        if (first % every == 0 && measured_vpls < n)
            record.report(0.02 + (b.seen_kept ? 0.78 : 0.33) * measured_vpls / n);
    }
    if (b.kept) balance();
    measured = !record.cancelled();
}

ShootParams LightAtlasSolver::State::shoot_params(std::uint32_t first, std::uint32_t count) const {
    return {
        first,     count,    b.kept ? 1u : 0u, b.sites.site_count, b.sites.stride, 1.0f / row_scale,
        SHOOT_ALL, threshold};
}

// Begins with 1, the factors of shooters and receivers alike.
void LightAtlasSolver::State::balance() {
    const std::uint32_t n = b.sites.site_count;
    const std::vector<float> ones(2 * std::size_t{b.sites.stride}, 1.0f);
    record.write(b.sites.balance, ones.data(), ones.size() * sizeof(float));
    for (int step = 0; step < balance_steps; ++step) {
        record("vpl.balance_receivers", n, [&](const WaitList& wait) {
            return vpl.balance_receivers(queue, shoot_params(0, n), b.sites, b.rows, wait);
        });
        balance_shooters(0, n);
    }
}

void LightAtlasSolver::State::balance_shooters(std::uint32_t first, std::uint32_t count) {
    record("vpl.balance_shooters", count, [&](const WaitList& wait) {
        return vpl.balance_shooters(queue, shoot_params(first, count), b.sites, b.rows, wait);
    });
}

}  // namespace clgi
