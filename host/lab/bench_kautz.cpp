// SPDX-License-Identifier: MIT
#include "lab/bench_kautz.hpp"

#include <algorithm>
#include <clgi/device.hpp>
#include <clgi/error.hpp>
#include <numeric>
#include "lab/scenes/deforming.hpp"

#include "lab/kautz_run.hpp"
#include "lab/timing.hpp"

namespace clgi::lab {
namespace {

constexpr int kautz_rounds = 3;
constexpr int kautz_warm_up = 5;

Programs programs_of(const KautzSetup& setup) {
    return Programs(setup.queue.getInfo<CL_QUEUE_CONTEXT>(),
                    setup.queue.getInfo<CL_QUEUE_DEVICE>());
}

void report_done(const KautzSetup& setup, double done) {
    if (setup.progress && !setup.progress(done)) throw Error("bench: cancelled");
}

// Frames spread over the clip, in rounds: f(round, seconds).
template <typename F>
void play(int frames, double duration, F&& f) {
    for (int round = 0; round < kautz_rounds; ++round)
        for (int k = 0; k < frames; ++k)
            f(round, duration * (k + static_cast<double>(round) / kautz_rounds) / frames);
}

KautzShares shares_of(const KautzSetup& setup, KautzRun& run) {
    std::vector<double> whole;
    KautzShares out;
    for (int k = 0; k < kautz_warm_up; ++k) run.steps(0.0);
    play(setup.repeats, run.duration(), [&](int, double seconds) {
        const KautzRun::Steps steps = run.steps(seconds);
        double of[4] = {0.0, 0.0, steps.pose_ms, 0.0};
        for (const PassTime& pass : pass_times(steps.passes)) {
            const int which =
                pass.name == "transfer.mask"                                            ? 0
                : pass.name == "transfer.integrate"                                     ? 1
                : pass.name == "transfer.receivers" || pass.name == "transfer.blockers" ? 2
                                                                                        : 3;
            of[which] += pass.milliseconds;
        }
        whole.push_back(std::accumulate(of, of + 4, 0.0));
        for (int i = 0; i < 4; ++i) out.shares[i] += of[i];
    });
    const double all = std::accumulate(out.shares, out.shares + 4, 0.0);
    for (double& share : out.shares) share /= all;
    out.frame_ms = spread(whole).median;
    return out;
}

KautzGloss gloss_of(const KautzSetup& setup, const Programs& programs, const KautzScene& hand,
                    const KautzSettings& settings) {
    HandOptions options;
    options.roughness = 0.5f;
    Scene scene = hand_like(options);
    scene.moving_bounds = hand.scene.moving_bounds;
    KautzRun run(setup, programs, scene, hand.coarse, settings);
    const glm::dvec3 eye = scene.cameras.at(0).position;
    std::vector<double> mask, diffuse, gloss;
    for (int k = 0; k < kautz_warm_up; ++k) run.steps(0.0, eye);
    play(setup.repeats, run.duration(), [&](int, double seconds) {
        for (const PassTime& pass : pass_times(run.steps(seconds, eye).passes)) {
            if (pass.name == "transfer.mask") mask.push_back(pass.milliseconds);
            if (pass.name == "transfer.integrate") diffuse.push_back(pass.milliseconds);
            if (pass.name == "transfer.integrate_gloss") gloss.push_back(pass.milliseconds);
        }
    });
    KautzGloss out;
    out.mask_ms = spread(mask).median;
    out.integrate_ms = spread(diffuse).median;
    out.gloss_ms = spread(gloss).median;
    const double plain = out.mask_ms + out.integrate_ms;
    out.instead = (out.mask_ms + out.gloss_ms) / plain;
    out.besides = (plain + out.gloss_ms) / plain;
    return out;
}

}  // namespace

KautzRow kautz_row(const KautzSetup& setup, const Programs& programs, const KautzScene& scene,
                   const KautzSettings& settings, const TransferTruth* truth) {
    KautzRun run(setup, programs, scene.scene, scene.coarse, settings);
    KautzRow row;
    row.scene = scene.name;
    row.settings = settings;
    row.vertices = scene.scene.positions.size();
    row.triangles = scene.scene.triangles.size();
    row.coarse = run.coarse();
    row.listed = run.solver().triangles_per_receiver();
    const double fps = settings.sets ? scene.fps_sets : scene.fps;
    if (fps > 0.0) {
        row.paper_fps = fps;
        row.paper_listed = settings.sets ? scene.triangles_sets : scene.triangles;
    }
    row.paper_error = scene.error;

    for (int k = 0; k < kautz_warm_up; ++k) run.frame(0.0);
    const int frames = settings.coarse > 0.0 ? setup.repeats : std::max(setup.repeats / 10, 1);
    std::vector<double> times[kautz_rounds];
    play(frames, run.duration(),
         [&](int round, double seconds) { times[round].push_back(run.frame(seconds)); });
    double all = 0.0;
    for (const std::vector<double>& round : times) {
        row.fps = std::max(row.fps, 1e3 / spread(round).median);
        all += std::accumulate(round.begin(), round.end(), 0.0);
    }
    row.mean_fps = 1e3 * kautz_rounds * frames / all;
    if (row.paper_fps) row.ratio = row.fps / *row.paper_fps;
    if (!truth) return row;

    TransferErrors errors;
    for (std::size_t frame = 0; frame < truth->seconds.size(); ++frame) {
        run.frame(truth->seconds[frame]);
        errors.add(run.vectors(truth->vertices), truth->vectors[frame], settings.masks.bands);
    }
    row.error = errors.error();
    row.noise = truth->noise;
    return row;
}

KautzTable1 bench_kautz1(const KautzSetup& setup, const std::vector<KautzScene>& scenes) {
    const Programs programs = programs_of(setup);
    KautzTable1 out;
    out.device = describe(setup.queue.getInfo<CL_QUEUE_DEVICE>());
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        const std::vector<KautzSettings> all = kautz_settings(scenes[i]);
        std::optional<TransferTruth> truth;
        TruthOptions options;
        options.vertices = setup.vertices;
        if (setup.vertices > 0) truth = transfer_truth(scenes[i].scene, options);
        for (std::size_t k = 0; k < all.size(); ++k) {
            const double part = static_cast<double>(k + 1) / static_cast<double>(all.size() + 1);
            report_done(setup,
                        (static_cast<double>(i) + part) / static_cast<double>(scenes.size()));
            out.rows.push_back(
                kautz_row(setup, programs, scenes[i], all[k], truth ? &*truth : nullptr));
        }
    }
    return out;
}

KautzTable2 bench_kautz2(const KautzSetup& setup, const std::vector<KautzScene>& scenes) {
    const Programs programs = programs_of(setup);
    KautzTable2 out;
    out.device = describe(setup.queue.getInfo<CL_QUEUE_DEVICE>());
    for (const KautzScene& scene : scenes) {
        report_done(setup,
                    static_cast<double>(out.rows.size()) / static_cast<double>(scenes.size()));
        const KautzSettings settings = kautz_settings(scene).front();
        KautzRun run(setup, programs, scene.scene, scene.coarse, settings);
        KautzShares row = shares_of(setup, run);
        row.scene = scene.name;
        std::copy(std::begin(scene.shares), std::end(scene.shares), row.paper_shares);
        out.rows.push_back(row);
        if (scene.name == "hand") out.gloss = gloss_of(setup, programs, scene, settings);
    }
    return out;
}

}  // namespace clgi::lab
