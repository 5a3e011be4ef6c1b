// SPDX-License-Identifier: MIT
#include "lab/bench_dachsbacher.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <clgi/reference.hpp>

#include "lab/dachsbacher_run.hpp"
#include "lab/reference_picture.hpp"
#include "lab/relative_error.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr int dachsbacher_rounds = 3;
constexpr int dachsbacher_warm_up = 3;
constexpr int error_width = 320, error_height = 240;

Programs programs_of(const DachsbacherSetup& setup) {
    return Programs(setup.queue.getInfo<CL_QUEUE_CONTEXT>(),
                    setup.queue.getInfo<CL_QUEUE_DEVICE>());
}

// Frames over the way of the light, in rounds that do not repeat each other: f(round, frame).
template <typename F>
void play(const DachsbacherSetup& setup, DachsbacherRun& run, double begin, double part, F&& f) {
    for (int k = 0; k < dachsbacher_warm_up; ++k) run.frame(0.0);
    for (int round = 0; round < dachsbacher_rounds; ++round)
        for (int k = 0; k < setup.repeats; ++k) {
            const double share =
                (k + static_cast<double>(round) / dachsbacher_rounds) / setup.repeats;
            f(round, run.frame(share));
            const double done = (round + (k + 1.0) / setup.repeats) / dachsbacher_rounds;
            if (setup.progress && !setup.progress(begin + part * done))
                throw Error("bench: cancelled");
        }
}

// Of a picture with the light where the scene has it, against the path tracer.
double error_of(const DachsbacherSetup& setup, const DachsbacherScene& scene, DachsbacherRun& run,
                bool direct) {
    reference::Options options;
    options.width = error_width;
    options.height = error_height;
    options.samples = setup.samples;
    const std::string effects = direct ? "all" : "indirect";
    options.effects = reference::parse_effects(effects);
    const reference::PathTracer tracer(scene.scene);
    const reference::Picture truth = tracer.render(scene.scene.cameras.at(0), options, [&](double) {
        return !setup.progress || setup.progress(0.0);
    });
    if (truth.cancelled) throw Error("bench: cancelled");
    return relative_error(run.picture(error_width, error_height, direct),
                          reference_image(truth, effects));
}

DachsbacherRow1 row1(const DachsbacherSetup& setup, const Programs& programs,
                     const DachsbacherScene& scene, double begin, double part) {
    DachsbacherRun run(setup, programs, scene);
    const AntiradianceSolver& solver = run.solver();
    DachsbacherRow1 row;
    row.scene = scene.name;
    row.paper = scene.paper;
    row.bins = solver.options().bins;
    row.triangles = scene.scene.triangles.size();
    row.elements = solver.elements().count();
    row.leaves = solver.elements().leaves;
    row.pairs = solver.link_pairs();
    row.links = solver.link_count();

    std::vector<double> frames[dachsbacher_rounds], lights[dachsbacher_rounds];
    play(setup, run, begin, part, [&](int round, const DachsbacherRun::Frame& frame) {
        frames[round].push_back(frame.light_ms + frame.picture_ms);
        lights[round].push_back(frame.light_ms);
    });
    for (int round = 0; round < dachsbacher_rounds; ++round) {
        row.fps = std::max(row.fps, 1e3 / spread(frames[round]).median);
        row.light_fps = std::max(row.light_fps, 1e3 / spread(lights[round]).median);
    }
    row.ratio = row.fps / scene.paper.fps;

    run.frame(0.0);
    const AntiradianceStatus status = solver.status();
    if (status.non_finite > 0)
        throw Error("bench: " + scene.name + " has " + std::to_string(status.non_finite) +
                    " leaves with light that is not finite");
    if (status.given_up) throw Error("bench: the light of " + scene.name + " diverged");
    row.steps = static_cast<int>(status.residuals.size());
    row.residual = status.residuals.empty() ? 0.0 : status.residuals.back();
    if (setup.samples > 0) {
        row.error = error_of(setup, scene, run, true);
        row.indirect_error = error_of(setup, scene, run, false);
    }
    return row;
}

DachsbacherRow2 row2(const DachsbacherSetup& setup, const Programs& programs,
                     const DachsbacherScene& scene, double begin, double part) {
    constexpr double megabyte = 1 << 20;
    DachsbacherRun run(setup, programs, scene);
    DachsbacherRow2 row;
    row.scene = scene.name;
    row.paper = scene.paper;
    row.linking_s = run.solver().linking_seconds();
    row.tables_mb = static_cast<double>(run.solver().table_bytes()) / megabyte;
    row.links_mb = static_cast<double>(run.solver().link_bytes()) / megabyte;

    enum Part { local, global, push_pull, other, parts };
    std::vector<double> times[parts];
    play(setup, run, begin, part, [&](int, const DachsbacherRun::Frame& frame) {
        double sums[parts] = {};
        for (const PassTime& pass : pass_times(frame.passes)) {
            const Part of =
                pass.name == "antiradiance.local" || pass.name == "antiradiance.gloss" ? local
                : pass.name == "antiradiance.global"                                   ? global
                : pass.name == "antiradiance.pull" || pass.name == "antiradiance.push" ? push_pull
                                                                                       : other;
            sums[of] += pass.milliseconds;
        }
        for (int i = 0; i < parts; ++i) times[i].push_back(sums[i]);
    });
    row.local_ms = spread(times[local]).median;
    row.global_ms = spread(times[global]).median;
    row.push_pull_ms = spread(times[push_pull]).median;
    row.other_ms = spread(times[other]).median;
    return row;
}

template <typename Table, typename Row>
Table bench(const DachsbacherSetup& setup, const std::vector<DachsbacherScene>& scenes,
            Row&& row_of) {
    const Programs programs = programs_of(setup);
    Table out;
    out.device = describe(setup.queue.getInfo<CL_QUEUE_DEVICE>());
    const double part = 1.0 / static_cast<double>(std::max<std::size_t>(scenes.size(), 1));
    for (std::size_t i = 0; i < scenes.size(); ++i)
        out.rows.push_back(row_of(setup, programs, scenes[i], part * static_cast<double>(i), part));
    return out;
}

}  // namespace

DachsbacherTable1 bench_dachsbacher1(const DachsbacherSetup& setup,
                                     const std::vector<DachsbacherScene>& scenes) {
    return bench<DachsbacherTable1>(setup, scenes, row1);
}

DachsbacherTable2 bench_dachsbacher2(const DachsbacherSetup& setup,
                                     const std::vector<DachsbacherScene>& scenes) {
    return bench<DachsbacherTable2>(setup, scenes, row2);
}

}  // namespace clgi::lab
