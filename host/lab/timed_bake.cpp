// SPDX-License-Identifier: MIT
#include "lab/timed_bake.hpp"

#include <clgi/advanced/bake_layout.hpp>

#include "lab/timing.hpp"

namespace clgi::lab {

std::optional<TimedBake> timed_bake(const BakeJob& job, const Progress& progress) {
    TimedBake out;
    const auto start = Clock::now();
    const BakeLayout layout = make_bake_layout(job.scene, job.vpls, job.atlas);
    out.layout_seconds = 1e-3 * milliseconds(Clock::now() - start);
    LightAtlasSolver solver(job.programs, job.queue, job.on_device, layout.vpls, layout.atlas,
                            job.options);
    if (!solver.run(progress)) return std::nullopt;
    out.seconds = 1e-3 * milliseconds(Clock::now() - start);
    out.irradiance = solver.irradiance();
    out.status = solver.status();
    return out;
}

}  // namespace clgi::lab
