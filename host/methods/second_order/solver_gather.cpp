// The passes that look at every VPL: cut into dispatches that can be cancelled in between, and
// shared with other devices.
// SPDX-License-Identifier: MIT
#include <array>
#include <clgi/advanced/planes.hpp>
#include <clgi/error.hpp>

#include "core/kit/ranges.hpp"
#include "core/opencl/error_text.hpp"
#include "methods/second_order/solver_state.hpp"
#include "shading/lights/replicate.hpp"

namespace clgi {

std::vector<double> SecondOrderSolver::State::speeds() const {
    std::vector<double> out{pairs_per_second(queue.getInfo<CL_QUEUE_DEVICE>())};
    for (const Helper& helper : helpers)
        out.push_back(pairs_per_second(helper.queue.getInfo<CL_QUEUE_DEVICE>()));
    return out;
}

void SecondOrderSolver::State::place_negative(const View& view) {
    const std::uint32_t replicate = options.emitters.replicate;
    // Behind by less than the spacing of floats across the scene is not behind.
    const NegativeParams params{static_cast<std::uint32_t>(emitters.set().vpl_count),
                                static_cast<std::uint32_t>(options.negative_vpls),
                                buffers.stride,
                                16.0f * 5.96e-8f * (2.0f * scene.frame().detail),
                                options.footprint,
                                replicate_shift(replicate, ShiftUse::image, 0),
                                replicate_shift(replicate, ShiftUse::image, 1),
                                0};
    // One lane works on a sample here, and its loop is shorter.
    const double pairs = 4.0 * params.vpl_count;
    for (const Share& share : deal(params.negative_count, pairs, {speeds().front()})) {
        record("lights.negative", share.range.count, [&](const WaitList& wait) {
            return light_passes.negative(queue, params, share.range, view, buffers.seen.planes,
                                         buffers.lights, buffers.negative, wait);
        });
        if (!share.range.whole) record.report(0.4);
    }
}

void SecondOrderSolver::State::gather(const GatherJob& job) {
    if (record.cancelled()) return;
    const GatherParams params{job.stride, static_cast<std::uint32_t>(emitters.set().vpl_count),
                              static_cast<std::uint32_t>(options.negative_vpls), 0};
    if (!helpers.empty()) return gather_together(job, params);
    const double pairs = static_cast<double>(params.vpl_count) + params.negative_count;
    for (const Share& share : deal(job.most, pairs, speeds())) {
        record(job.name, share.range.count, [&](const WaitList& wait) {
            return image.gather(queue, params, share.range, job.count, job.points, buffers.lights,
                                buffers.negative, job.irradiance, wait);
        });
        const double done = static_cast<double>(share.range.first + share.range.count) / job.most;
        if (!share.range.whole) record.report(job.from + (job.to - job.from) * done);
    }
}

// Helpers read what this queue has made and write into buffers of their own; what they found is
// copied from there. So no buffer is ever written by two devices at a time.
void SecondOrderSolver::State::gather_together(const GatherJob& job, const GatherParams& params) {
    const WaitList ready = record.waits();
    const auto flush = [](const cl::CommandQueue& flushed) {
        try {
            flushed.flush();  // others wait for it: OpenCL wants it flushed
        } catch (const cl::Error& error) {
            throw DeviceError("image.gather: a queue cannot be flushed: " +
                              error_text(error.err()));
        }
    };
    flush(queue);
    // Its own share first: whatever comes after the helpers' waits for them.
    const double pairs = static_cast<double>(params.vpl_count) + params.negative_count;
    std::vector<Share> lent;
    for (const Share& share : deal(job.most, pairs, speeds())) {
        if (share.worker > 0) {
            lent.push_back(share);
            continue;
        }
        record(job.name, share.range.count, [&](const WaitList& wait) {
            return image.gather(queue, params, share.range, job.count, job.points, buffers.lights,
                                buffers.negative, job.irradiance, wait);
        });
    }
    for (const Share& share : lent) {
        const Helper& helper = helpers[share.worker - 1];
        record.beside(job.name, share.range.count,
                      helper.image.gather(helper.queue, params, share.range, job.count, job.points,
                                          buffers.lights, buffers.negative,
                                          buffers.helpers[share.worker - 1], ready));
    }
    for (const Helper& helper : helpers) flush(helper.queue);
    for (const Share& share : lent) {
        record("image.collect", share.range.count, [&](const WaitList& wait) {
            const std::size_t pitch =
                irradiance_bytes(options.build.storage, job.stride) / IRRADIANCE_PLANES;
            const std::size_t value = pitch / job.stride;
            const std::array<std::size_t, 3> from{share.range.first * value, 0, 0};
            const std::array<std::size_t, 3> region{share.range.count * value, IRRADIANCE_PLANES,
                                                    1};
            cl::Event event;
            try {
                queue.enqueueCopyBufferRect(buffers.helpers[share.worker - 1], job.irradiance, from,
                                            from, region, pitch, 0, pitch, 0, &wait, &event);
            } catch (const cl::Error& error) {
                throw DeviceError("image.collect: " + error_text(error.err()));
            }
            return event;
        });
    }
    record.report(job.to);
}

}  // namespace clgi
