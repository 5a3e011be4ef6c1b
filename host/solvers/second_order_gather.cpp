// The passes that look at every light: cut into dispatches that can be cancelled in between, and
// shared with other devices where there are some.
// SPDX-License-Identifier: MIT
#include <array>

#include "opencl/error_text.hpp"
#include "solvers/ranges.hpp"
#include "solvers/recorder.hpp"

namespace clgi {

std::vector<double> SecondOrderSolver::speeds() const {
    std::vector<double> out{pairs_per_second(queue_.getInfo<CL_QUEUE_DEVICE>())};
    for (const Helper& helper : helpers_)
        out.push_back(pairs_per_second(helper.queue.getInfo<CL_QUEUE_DEVICE>()));
    return out;
}

void SecondOrderSolver::place_negative(Recorder& record, const NegativeParams& params,
                                       const View& view) {
    // One lane works on a sample here, and its loop is shorter.
    const double pairs = 4.0 * params.light_count;
    for (const Share& share : deal(params.negative_count, pairs, {speeds().front()})) {
        record("lights.negative", share.range.count, [&](const WaitList& wait) {
            return light_passes_.negative(queue_, params, share.range, view, seen_.planes, lights_,
                                          negative_, wait);
        });
        if (!share.range.whole) record.report(0.4);
    }
}

void SecondOrderSolver::gather(Recorder& record, const GatherJob& job) {
    const GatherParams params{job.stride, static_cast<std::uint32_t>(set_.light_count),
                              static_cast<std::uint32_t>(options_.negative_lights), 0};
    const double pairs = static_cast<double>(params.light_count) + params.negative_count;
    const std::vector<Share> shares = deal(job.most, pairs, speeds());
    if (record.cancelled()) return;
    if (!helpers_.empty()) return gather_together(record, job, params, shares);
    for (const Share& share : shares) {
        record(job.name, share.range.count, [&](const WaitList& wait) {
            return image_.gather(queue_, params, share.range, job.count, job.points, lights_,
                                 negative_, job.irradiance, wait);
        });
        const double done = static_cast<double>(share.range.first + share.range.count) / job.most;
        if (!share.range.whole) record.report(job.from + (job.to - job.from) * done);
    }
}

// Helpers read what this queue has made and write into buffers of their own; what they found is
// copied from there. So no buffer is ever written by two devices at a time.
void SecondOrderSolver::gather_together(Recorder& record, const GatherJob& job,
                                        const GatherParams& params,
                                        const std::vector<Share>& shares) {
    const WaitList ready{record.last()};
    queue_.flush();  // others wait for it: OpenCL wants it flushed
    // Its own share first: whatever comes after the helpers' waits for them.
    std::vector<Share> lent;
    for (const Share& share : shares) {
        if (share.worker > 0) {
            lent.push_back(share);
            continue;
        }
        record(job.name, share.range.count, [&](const WaitList& wait) {
            return image_.gather(queue_, params, share.range, job.count, job.points, lights_,
                                 negative_, job.irradiance, wait);
        });
    }
    for (const Share& share : lent) {
        const Helper& helper = helpers_[share.worker - 1];
        record.beside(job.name, share.range.count,
                      helper.image.gather(helper.queue, params, share.range, job.count, job.points,
                                          lights_, negative_, helper.irradiance, ready));
    }
    for (const Helper& helper : helpers_) helper.queue.flush();
    for (const Share& share : lent) {
        record("image.collect", share.range.count, [&](const WaitList& wait) {
            const std::size_t pitch =
                irradiance_bytes(options_.build.storage, job.stride) / IRRADIANCE_PLANES;
            const std::size_t value = pitch / job.stride;
            const std::array<std::size_t, 3> from{share.range.first * value, 0, 0};
            const std::array<std::size_t, 3> region{share.range.count * value, IRRADIANCE_PLANES,
                                                    1};
            cl::Event event;
            try {
                queue_.enqueueCopyBufferRect(helpers_[share.worker - 1].irradiance, job.irradiance,
                                             from, from, region, pitch, 0, pitch, 0, &wait, &event);
            } catch (const cl::Error& error) {
                throw DeviceError("image.collect: " + error_text(error.err()));
            }
            return event;
        });
    }
    record.report(job.to);
}

}  // namespace clgi
