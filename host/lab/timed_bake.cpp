// SPDX-License-Identifier: MIT
#include "lab/timed_bake.hpp"

#include <chrono>
#include <clgi/advanced/bake_layout.hpp>

namespace clgi::lab {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::optional<TimedBake> timed_bake(const BakeJob& job, const Progress& progress) {
    TimedBake out;
    const auto start = Clock::now();
    const BakeLayout layout = make_bake_layout(job.scene, job.vpls, job.atlas);
    out.layout_seconds = seconds_since(start);
    LightAtlasSolver solver(job.programs, job.queue, job.on_device, layout.vpls, layout.atlas,
                            job.options);
    if (!solver.run(progress)) return std::nullopt;
    out.seconds = seconds_since(start);
    out.irradiance = solver.irradiance();
    out.status = solver.status();
    return out;
}

}  // namespace clgi::lab
