// Light that VPLs send each other, bounce by bounce or the strongest alone. [Schaerfig16, section
// 3]
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>

#include "methods/light_atlas/solver_state.hpp"

namespace clgi {

using namespace light_atlas;

namespace {

constexpr std::uint32_t chunk = 32;  // shots between two looks at what is left
constexpr std::uint32_t most_bounces = 10000;

}  // namespace

void LightAtlasSolver::State::light_points(const GBuffer& points, std::uint32_t count,
                                           const cl::Buffer& irradiance, bool add) {
    const auto number = static_cast<std::uint32_t>(emitters.set().emitters.size());
    const DirectParams params{points.stride, count, number, 1.0f, 1, add ? 1u : 0u, 0, 0};
    record("lights.direct", count, [&](const WaitList& wait) {
        return lights.direct(queue, params, emitters.buffers(), points.planes, irradiance,
                             b.non_finite, wait);
    });
}

// Shadow-mapped direct light of every kind at the VPLs. [section 3.2]
void LightAtlasSolver::State::receive_direct() {
    emitters.draw(record, gbuffer, b.lists);
    light_points(b.samples, b.sites.sample_count, b.sample_irradiance, false);
    record("vpl.receive", b.sites.site_count, [&](const WaitList& wait) {
        return vpl.receive(queue, b.sites, b.sample_irradiance, wait);
    });
}

// Light of a batch of shooters arrives. Rows that are not kept are made, and balanced by their
// shooter alone: what it sends and loses is exact, what arrives where is not.
void LightAtlasSolver::State::shoot(std::uint32_t first, std::uint32_t count) {
    const ShootParams params = shoot_params(first, count);
    if (!b.kept) {
        transport(first, count);
        balance_shooters(first, count);
    }
    record("vpl.shoot", std::size_t{count} * b.sites.site_count, [&](const WaitList& wait) {
        return vpl.shoot(queue, params, b.sites, b.rows, b.non_finite, wait);
    });
    shots += count;
}

// All VPLs shoot what they have.
void LightAtlasSolver::State::bounce() {
    const std::uint32_t n = b.sites.site_count;
    record("vpl.emit", n, [&](const WaitList& wait) {
        return vpl.emit(queue, shoot_params(0, n), b.sites, b.strongest, wait);
    });
    // Sums of as many VPLs whatever the form, so that light has the same bits.
    const std::uint32_t batch = b.kept                        ? n
                                : occludes(options.occlusion) ? std::uint32_t{SEEN_VPLS}
                                                              : b.batch;
    for (std::uint32_t first = 0; first < n && !record.cancelled(); first += batch) {
        shoot(first, std::min(batch, n - first));
        if (!b.kept) record.report(0.4);
    }
}

float LightAtlasSolver::State::strongest_power() {
    record("parallel.arg_max", b.sites.site_count, [&](const WaitList& wait) {
        return parallel.arg_max(queue, b.sites.site_count, b.sites.power, b.strongest,
                                b.arg_max_scratch, wait);
    });
    const std::uint32_t bits = record.read_word(b.strongest);
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return value;
}

void LightAtlasSolver::State::bounce_to_threshold() {
    for (std::uint32_t k = 0; k < most_bounces && !record.cancelled(); ++k) {
        bounce();
        record.report(b.seen_kept ? 0.82 : 0.4);
        if (!(strongest_power() > threshold)) return;
    }
}

// The strongest VPL shoots, again and again; the device chooses it. [section 3.3]
void LightAtlasSolver::State::shoot_strongest() {
    const std::uint32_t n = b.sites.site_count;
    ShootParams params = shoot_params(n, 1);
    params.mode = SHOOT_STRONGEST;
    // Powers are known after the first shot, which is of nobody then.
    record.fill(b.sites.power, 0);
    for (std::uint32_t k = 0; k < most_bounces * 8 && !record.cancelled(); ++k) {
        for (std::uint32_t i = 0; i < chunk; ++i) {
            record("parallel.arg_max", n, [&](const WaitList& wait) {
                return parallel.arg_max(queue, n, b.sites.power, b.strongest, b.arg_max_scratch,
                                        wait);
            });
            record("vpl.emit", 1, [&](const WaitList& wait) {
                return vpl.emit(queue, params, b.sites, b.strongest, wait);
            });
            shoot(n, 1);
        }
        record.report(b.seen_kept ? 0.82 : 0.4);
        if (!(strongest_power() > threshold)) return;
    }
}

// Light goes from VPL to VPL. [section 3.3]
void LightAtlasSolver::State::exchange() {
    if (options.bounces > 0)
        for (std::uint32_t k = 1; k < options.bounces && !record.cancelled(); ++k) bounce();
    else if (options.one_at_a_time)
        shoot_strongest();
    else
        bounce_to_threshold();
}

}  // namespace clgi
