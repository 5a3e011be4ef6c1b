// SPDX-License-Identifier: MIT
#include "report/timed_bake.hpp"

#include <chrono>

namespace clgi::report {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::optional<TimedBake> timed_bake(const BakeJob& job, const Progress& progress) {
    TimedBake out;
    const auto start = Clock::now();
    const Patches patches = make_patches(job.scene);
    const VplLayout vpls = place_vpls(job.scene, patches, job.vpls);
    const AtlasLayout atlas = make_atlas(job.scene, patches.triangle_patch, job.atlas);
    out.layout_seconds = seconds_since(start);
    LightAtlasSolver solver(job.programs, job.queue, job.on_device, vpls, atlas, job.options);
    if (!solver.run(progress)) return std::nullopt;
    out.seconds = seconds_since(start);
    out.irradiance = solver.irradiance();
    out.status = solver.status();
    return out;
}

}  // namespace clgi::report
